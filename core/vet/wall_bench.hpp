#pragma once
#include <scree/abi.h>
#include <scree/math.hpp>

#include <string>
#include <vector>

#include "core/base/log.hpp"
#include "core/vet/object.hpp"

namespace scree::core::vet {

/// One touch of one ball with a wall.
struct Touch {
  uint32_t ball = 0, patch = 0;
  Vec3 normal;
  double distance = 0;
};

/// Asks a wall as the kernel does, with guard words behind every array.
class WallBench {
 public:
  explicit WallBench(const scree_wall& table, std::size_t capacity = 1024);
  /// Makes ready for a call.
  void prepare(const void* wall, const std::vector<Vec3>& centres, double reach, std::size_t capacity);
  /// Makes the call. Returns what the wall says there is; `touches` are those that fit.
  uint32_t ask(const void* wall, const std::vector<Vec3>& centres, double reach, std::size_t capacity);
  std::vector<Touch> touches() const;
  /// The call alone, as prepared.
  void operator()() { count_ = table_.touch(wall_, n_, x_.data(), y_.data(), z_.data(), reach_.data(), &out_); }
  bool trespassed() const;

 private:
  const scree_wall& table_;
  const void* wall_ = nullptr;
  uint32_t n_ = 0, count_ = 0;
  std::vector<double> x_, y_, z_, reach_;
  std::vector<uint32_t> ball_, patch_;
  std::vector<double> nx_, ny_, nz_, distance_;
  scree_touches out_{};
};

inline std::string text_of(const Vec3& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }

/// Calls f(object, settings) for walls with accepted settings.
template <class F>
void for_walls(const Subject& subject, std::size_t count, F f) {
  const scree_object& table = subject.component->wall().object;
  for (const Settings& settings : accepted_settings(subject, count)) {
    Object object(table);
    object.set_all(settings);
    f(object.get(), settings);
  }
}

/// Points about the origin, where the walls of accepted_settings lie.
std::vector<Vec3> points(std::size_t count, uint64_t seed);

}  // namespace scree::core::vet
