#pragma once
#include <cstddef>

namespace scree::core::vet {

/// Counts what a plug-in takes from the heap, by putting counting functions into the tables through which it and the
/// C++ library call malloc, free, operator new and their like. For a process that ends soon: nothing is put back.
class AllocationWatch {
 public:
  /// `inside`: any address in the plug-in. Throws Skipped where the tables cannot be changed.
  explicit AllocationWatch(const void* inside);
  /// The calls made while `run` ran.
  template <class Run>
  std::size_t during(Run& run) {
    begin();
    run();
    return end();
  }

 private:
  static void begin();
  static std::size_t end();
};

}  // namespace scree::core::vet
