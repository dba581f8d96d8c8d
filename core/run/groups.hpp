#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace scree::core {

/// Groups of balls. A ball belongs to one leaf: its set (`sand`) or a sub-group of it (`sand.fine`). A name stands for
/// all leaves below it; `balls` stands for all.
class Groups {
 public:
  /// Index of a leaf, made if new.
  uint16_t leaf(const std::string& name);
  const std::vector<std::string>& leaves() const { return leaves_; }
  std::size_t size() const { return leaves_.size(); }
  /// For every leaf whether the name covers it; all false when it covers none.
  std::vector<uint8_t> cover(const std::string& name) const;
  bool knows(const std::string& name) const;
  void restore(std::vector<std::string> leaves) { leaves_ = std::move(leaves); }

 private:
  std::vector<std::string> leaves_;
};

}  // namespace scree::core
