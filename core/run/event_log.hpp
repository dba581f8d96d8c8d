#pragma once
#include "core/cycle/engine.hpp"
#include "core/run/output_files.hpp"

namespace scree::core {

/// `events.csv` of the output folder: one line per bond that broke, in order of time, then ids. The file begins with
/// the first one. [one thread]
class EventLog {
 public:
  /// After `cut_back` when a run goes on.
  explicit EventLog(OutputFiles& files);
  /// Takes what broke since the last call from the engine. A failed write is remembered by the files.
  void take(Engine& engine);

 private:
  OutputFiles* files_;
  bool begun_ = false;
};

}  // namespace scree::core
