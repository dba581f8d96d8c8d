#pragma once
#include <string>

#include "core/run/archive.hpp"

namespace scree::core {

/// The two checkpoints of an output folder: `checkpoint/latest.scree` and, from the save before, `previous.scree`.
/// [one thread]
struct CheckpointFiles {
  explicit CheckpointFiles(const std::string& output_folder);
  std::string folder, latest, previous;

  /// Makes the folder. Returns 0 or an errno.
  int prepare() const;
  /// Removes what a killed run left half written. Call only with the folder's lock held.
  void clean() const;
  /// Either file is there.
  bool any() const;
  /// Opens the latest. If it is damaged or missing the refusal says so and, where the previous one is sound, how to go
  /// on from that.
  ArchiveReader open_latest() const;
  ArchiveReader open_previous() const { return ArchiveReader(previous); }
};

}  // namespace scree::core
