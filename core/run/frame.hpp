#pragma once
#include <scree/abi.h>

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "core/run/fields.hpp"
#include "core/run/quantities.hpp"
#include "core/run/shown_box.hpp"

namespace scree::core {

/// What a frame holds beside cycle and time.
struct FrameContent {
  uint32_t wants = 0;  ///< SCREE_WANTS_... of the writer
  FieldChoice fields;
  std::vector<std::shared_ptr<Formula>> quantities;
};

/// A frame of time n as a writer sees it. Owns all that `abi` points to. Building it changes nothing of the run.
class Frame {
 public:
  /// Unbounded walls are cut to `box`.
  Frame(Simulation& simulation, Quantities& quantities, const FrameContent& content, uint32_t index,
        const ShownBox& box);
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;
  const scree_frame& abi() const { return frame_; }

 private:
  using Values = std::vector<double>;
  void add_balls(Simulation& simulation, Instant& now, const FieldChoice& fields);
  void add_contacts(Instant& now, const FieldChoice& fields);
  void add_walls(const Engine& engine, const ShownBox& box);
  void add_quantities(Quantities& quantities, const FrameContent& content);
  /// One array per component, kept as long as the frame.
  template <class Read>
  scree_array array(const char* name, const char* unit, uint32_t components, std::size_t count, Read read);

  struct Picture {
    std::vector<Values> corners;
    std::vector<scree_polygon> polygons;
  };

  scree_frame frame_{};
  std::deque<Values> values_;
  std::deque<std::vector<const double*>> components_;
  std::vector<uint64_t> ball_ids_, contact_ids_[2];
  std::vector<scree_array> ball_arrays_, contact_arrays_;
  std::deque<Picture> pictures_;
  std::vector<scree_wall_picture> walls_;
  std::vector<std::string> units_;
  std::vector<const char*> names_, unit_texts_;
  Values quantities_;
};

}  // namespace scree::core
