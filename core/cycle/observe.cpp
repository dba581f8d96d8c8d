#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/hash.hpp"
#include "core/cycle/engine.hpp"

namespace scree::core {

namespace {

struct BlockSums {
  double net = 0, contact = 0, most = 0, kinetic = 0, shadow = 0;
  RowWork work;
  uint64_t free = 0;
  double shadow_back = 0;
  // The half-step velocities lie half a step of acceleration to either side: of the coming step, and of the last one.
  void add_shadow(double inertia, double now, double acceleration, const Clock& clock) {
    const double half = 0.5 * clock.dt * acceleration, last = 0.5 * clock.dt_back * acceleration;
    shadow += 0.5 * inertia * (now - half) * (now + half);
    shadow_back += 0.5 * inertia * (now - last) * (now + last);
  }
};

Column after(Column first, std::size_t component) {
  return static_cast<Column>(static_cast<std::size_t>(first) + component);
}

bool fixed_in(const uint8_t* fixed, std::size_t row, std::size_t direction) {
  return fixed != nullptr && (fixed[row] >> direction & 1u) != 0;
}

}  // namespace

const Observation& Engine::observe() {
  forces();
  Slices& slices = contacts.slices();
  const std::size_t n = balls.size(), stride = slices.stride();
  const bool spin = balls.has(Column::wx);
  for (std::size_t c = 0; c < 3; ++c) {
    observation_.velocity[c].resize_for_overwrite(n);
    observation_.force[c].resize_for_overwrite(n);
    observation_.spin[c].resize_for_overwrite(spin ? n : 0);
  }
  const MotionInput input = motion_input();
  std::vector<BlockSums> sums(slices.blocks());
  team.each_block(slices.blocks(), [&](std::size_t block) {
    slices.fold(block);
    BlockSums& s = sums[block];
    RowForces f, unscaled;
    const std::size_t begin = block * block_rows, end = begin + slices.block_size(block);
    const uint8_t* fixed = balls.fixed();
    for (std::size_t first = begin; first < end; first += SCREE_ROWS) {
      const std::size_t count = std::min<std::size_t>(SCREE_ROWS, end - first);
      gather_forces(input, first, count, f, false, nullptr);
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t row = first + k;
        for (std::size_t c = 0; c < 3; ++c) observation_.force[c][row] = f.force[c][k];
        if (fixed != nullptr && (fixed[row] & 7u) == 7u) continue;
        double square = 0;
        for (std::size_t c = 0; c < 3; ++c)
          if (!fixed_in(fixed, row, c)) square += f.force[c][k] * f.force[c][k];
        const double net = std::sqrt(square);
        s.net += net;
        s.most = std::max(s.most, net);
        s.contact += slices.record(row)[stride == Slices::with_spin ? 6 : 3];
        ++s.free;
      }
      if (input.energy) unscaled = f;
      apply_scalers(input, first, count, f, nullptr);
      if (input.energy) add_work(input, first, count, unscaled, f, 0.5 * clock.dt_back, s.work);
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t row = first + k;
        const double mass = balls[Column::mass][row], radius = balls[Column::radius][row];
        const double inertia = 0.4 * mass * radius * radius;
        for (std::size_t c = 0; c < 3; ++c) {
          const double v = balls[after(Column::vx, c)][row];
          const double a = fixed_in(fixed, row, c) ? 0.0 : f.force[c][k] / mass;
          const double now = v + 0.5 * clock.dt_back * a;
          observation_.velocity[c][row] = now;
          s.kinetic += 0.5 * mass * now * now;
          s.add_shadow(mass, now, a, clock);
          if (!spin) continue;
          const double w = balls[after(Column::wx, c)][row];
          const double b = fixed_in(fixed, row, 3 + c) ? 0.0 : f.moment[c][k] / inertia;
          const double turning = w + 0.5 * clock.dt_back * b;
          observation_.spin[c][row] = turning;
          s.kinetic += 0.5 * inertia * turning * turning;
          s.add_shadow(inertia, turning, b, clock);
        }
      }
    }
  });
  BlockSums total;
  for (const BlockSums& s : sums) {
    total.net += s.net;
    total.contact += s.contact;
    total.most = std::max(total.most, s.most);
    total.kinetic += s.kinetic;
    total.shadow += s.shadow;
    total.shadow_back += s.shadow_back;
    total.free += s.free;
    total.work += s.work;
  }
  const double free = static_cast<double>(std::max<uint64_t>(1, total.free));
  const auto ratio = [&](double value) {
    if (total.contact > 0) return value / (total.contact / free);
    return value > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  };
  observation_.unbalanced = ratio(total.net / free);
  observation_.unbalanced_max = ratio(total.most);
  observation_.kinetic = total.kinetic;
  observation_.kinetic_shadow = total.shadow;
  observation_.kinetic_shadow_back = total.shadow_back;
  observation_.work_before = total.work;
  observation_.cycle = clock.cycle;
  return observation_;
}

double Engine::largest_overlap() const {
  double most = 0;
  const double* at[3] = {balls[Column::x], balls[Column::y], balls[Column::z]};
  const double* radius = balls[Column::radius];
  for (const TouchList& list : contacts.lists())
    for (std::size_t row = 0; row + 1 < list.begin.size(); ++row)
      for (uint64_t slot = list.begin[row]; slot < list.begin[row + 1]; ++slot) {
        if (!list.active[slot]) continue;
        const uint32_t other = list.other[slot], image = target::image(list.where[slot]);
        double square = 0;
        for (int c = 0; c < 3; ++c) {
          const uint32_t code = (image >> (2 * c)) & 3u;
          const double shift = code == 0 ? 0.0 : code == 1 ? cell.length(c) : -cell.length(c);
          const double d = at[c][other] - at[c][row] + shift;
          square += d * d;
        }
        const double overlap = radius[row] + radius[other] - std::sqrt(square);
        most = std::max(most, overlap / std::min(radius[row], radius[other]));
      }
  return most;
}

uint64_t Engine::state_hash() const {
  const std::size_t n = balls.size();
  std::vector<uint32_t> order(n), rank(n);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return balls.id()[a] < balls.id()[b]; });
  for (std::size_t k = 0; k < n; ++k) rank[order[k]] = static_cast<uint32_t>(k);
  Hasher hash;
  const auto put = [&](double value) {
    value += 0.0;  // -0 and 0 are the same state
    hash.add(&value, sizeof value);
  };
  for (uint32_t row : order) {
    hash.add(&balls.id()[row], sizeof(uint64_t));
    for (Column c :
         {Column::x, Column::y, Column::z, Column::vx, Column::vy, Column::vz, Column::wx, Column::wy, Column::wz})
      if (balls.has(c)) put(balls[c][row]);
  }
  struct Active {
    uint64_t id1, id2;
    std::size_t list, slot;
  };
  std::vector<Active> active;
  for (std::size_t l = 0; l < contacts.lists().size(); ++l) {
    const TouchList& list = contacts.lists()[l];
    for (std::size_t row = 0; row + 1 < list.begin.size(); ++row)
      for (uint64_t slot = list.begin[row]; slot < list.begin[row + 1]; ++slot) {
        if (!list.active[slot]) continue;
        const uint64_t a = balls.id()[row], b = balls.id()[list.other[slot]];
        active.push_back({std::min(a, b), std::max(a, b), l, slot});
      }
  }
  const auto before = [](const Active& a, const Active& b) { return a.id1 != b.id1 ? a.id1 < b.id1 : a.id2 < b.id2; };
  std::sort(active.begin(), active.end(), before);
  for (const Active& one : active) {
    hash.add(&one.id1, 2 * sizeof(uint64_t));
    for (const auto& column : contacts.lists()[one.list].state) put(column[one.slot]);
  }
  std::vector<std::array<std::size_t, 4>> touching;  // id, wall, patch; list and slot packed behind
  for (std::size_t l = 0; l < contacts.wall_lists().size(); ++l) {
    const WallList& list = contacts.wall_lists()[l];
    for (std::size_t k = 0; k < list.slots.size(); ++k)
      touching.push_back({balls.id()[list.slots[k].row], list.wall, list.slots[k].patch, l << 32 | k});
  }
  std::sort(touching.begin(), touching.end());
  for (const auto& one : touching) {
    hash.add(one.data(), 3 * sizeof(std::size_t));
    const WallList& list = contacts.wall_lists()[one[3] >> 32];
    const std::size_t words = list.slots.empty() ? 0 : list.state.size() / list.slots.size();
    for (std::size_t w = 0; w < words; ++w) put(list.state[(one[3] & 0xffffffffu) * words + w]);
  }
  return hash.value();
}

}  // namespace scree::core
