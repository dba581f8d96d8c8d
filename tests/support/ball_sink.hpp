#pragma once
// A host for generators: takes balls, refuses those that overlap, and hands out counter-based random numbers.
#include <scree/abi.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace support {

struct PlacedBall {
  scree_ball ball;
  std::string group;
};

class BallSink {
 public:
  explicit BallSink(uint64_t seed = 1) : seed_(seed) {
    random_ = {sizeof(scree_random), 0, this, &uniform, &normal};
    table_ = {sizeof(scree_sink), 0, this, &place, &try_place, &random_, nullptr, nullptr, nullptr, &warn};
  }
  BallSink(const BallSink&) = delete;
  BallSink& operator=(const BallSink&) = delete;

  const scree_sink* table() const { return &table_; }
  void cell(const double* low, const double* high, const uint8_t* periodic) {
    table_.cell_low = low, table_.cell_high = high, table_.periodic = periodic;
  }
  std::vector<PlacedBall> balls;
  std::size_t room = SIZE_MAX;  // the host refuses any ball beyond

 private:
  static int place(void* self, const scree_ball* ball) {
    auto& sink = *static_cast<BallSink*>(self);
    if (sink.balls.size() >= sink.room) return 0;
    sink.balls.push_back({*ball, (ball->given & SCREE_BALL_GROUP) != 0 ? ball->group : ""});
    return 1;
  }
  static int try_place(void* self, const scree_ball* ball) {
    const auto& p = ball->position;
    for (const PlacedBall& other : static_cast<BallSink*>(self)->balls) {
      const auto& q = other.ball.position;
      const double d = (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]);
      const double reach = ball->radius + other.ball.radius;
      if (d < reach * reach) return 0;
    }
    return place(self, ball);
  }
  /// SplitMix64 over the key: not the program's generator, and good enough to tell whether draws are keyed.
  static double uniform(void* self, uint64_t index, uint64_t draw) {
    uint64_t z = static_cast<BallSink*>(self)->seed_ * 0x9E3779B97F4A7C15u + index * 0xBF58476D1CE4E5B9u +
                 draw * 0x94D049BB133111EBu;
    for (int k = 0; k < 3; ++k) {
      z += 0x9E3779B97F4A7C15u;
      z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
      z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
      z ^= z >> 31;
    }
    return static_cast<double>(z >> 11) * 0x1p-53;
  }
  static double normal(void* self, uint64_t index, uint64_t draw) {
    const double u = uniform(self, index, 2 * draw + 1000000), v = uniform(self, index, 2 * draw + 1000001);
    return std::sqrt(-2 * std::log(1 - u)) * std::cos(6.283185307179586 * v);
  }
  static void warn(void*, const char*) {}

  uint64_t seed_;
  scree_random random_{};
  scree_sink table_{};
};

}  // namespace support
