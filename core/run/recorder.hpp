#pragma once
#include <memory>
#include <string>

#include "core/run/archive.hpp"
#include "core/run/frame.hpp"
#include "core/run/output_files.hpp"

namespace scree::core {

/// One entry of `record`: a writer, when it is due, and what it is shown. Frames are written at the first cycle of the
/// run, then at multiples of the interval counted from time or cycle 0, and at the end; never twice for one cycle, also
/// not after a resume. A writer that fails is left alone from then on, and the run goes on. [one thread]
class Recorder {
 public:
  /// Makes the writer and checks the fields; throws SceneErrors. `record` and the rest must outlive the recorder.
  Recorder(Simulation& simulation, Quantities& quantities, const Record& record, OutputFiles& files);
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Before the first frame; on a resume before `load`. Throws SceneErrors when the writer refuses.
  void open();
  /// Whether a frame is due at the present cycle.
  bool due() const;
  /// What a frame asks of the forces of its cycle.
  Needs needs() const;
  /// Writes the frame of the present cycle, unless it was written. The caller has run the forces.
  void write();
  /// Writes a last frame if the last one is older, and closes the writer.
  void finish();
  /// Closes the writer without a last frame, as when the run will be resumed.
  void close();

  const std::string& name() const { return record_.name; }
  uint64_t frames() const { return frames_; }
  /// Why the writer was left alone; "" while all is well.
  const std::string& error() const { return error_; }

  void save(ArchiveWriter& archive, const std::string& prefix) const;
  void load(const ArchiveReader& archive, const std::string& prefix);

 private:
  static constexpr uint64_t never = ~uint64_t{0};
  void fail(const std::string& what);
  void check_content() const;

  Simulation& simulation_;
  Quantities& quantities_;
  const Record& record_;
  OutputFiles& files_;
  const scree_writer& table_;
  std::shared_ptr<void> writer_;
  scree_files abi_;
  FrameContent content_;
  ShownBox box_;
  uint64_t frames_ = 0, last_cycle_ = never;
  uint64_t passed_ = 0;  ///< whole intervals of time gone by at the last frame
  bool open_ = false;
  std::string error_;
};

}  // namespace scree::core
