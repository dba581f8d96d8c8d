#include "core/run/piece_quantities.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace scree::core {

namespace {

using V = std::array<double, 3>;

/// A name taken apart: "walls", "top", "force.z".
struct Parts {
  std::string kind, first, second, rest;
};

std::optional<uint64_t> id_of(const std::string& text) {
  uint64_t id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return id;
}

Parts taken_apart(const std::string& name) {
  Parts parts;
  std::size_t at = 0;
  const auto next = [&] {
    if (at > name.size()) return std::string();
    const std::size_t dot = std::min(name.find('.', at), name.size());
    const std::string part = name.substr(at, dot - at);
    at = dot + 1;
    return part;
  };
  parts.kind = next();
  parts.first = next();
  if (parts.kind == "contacts") parts.second = next();
  if (at < name.size()) parts.rest = name.substr(at);
  return parts;
}

/// "force.z" -> "force" and 2; the axis is -1 without one.
std::pair<std::string, int> axis_of(const std::string& text) {
  const std::size_t n = text.size();
  if (n > 2 && text[n - 2] == '.' && text[n - 1] >= 'x' && text[n - 1] <= 'z')
    return {text.substr(0, n - 2), text[n - 1] - 'x'};
  return {text, -1};
}

struct WallWord {
  const char *name, *unit;
  double (*read)(const Wall&, std::size_t axis);
};
const WallWord wall_words[] = {
    {"force", "N", [](const Wall& w, std::size_t c) { return w.force[c]; }},
    {"moment", "N m", [](const Wall& w, std::size_t c) { return w.moment[c]; }},
    {"position", "m", [](const Wall& w, std::size_t c) { return w.centre[c]; }},
    {"displacement", "m", [](const Wall& w, std::size_t c) { return w.centre[c] - w.first_centre[c]; }},
    {"velocity", "m/s", [](const Wall& w, std::size_t c) { return w.velocity[c]; }},
    {"spin", "rad/s", [](const Wall& w, std::size_t c) { return w.spin[c]; }},
};

struct BallWord {
  const char *name, *unit;
  bool vector, pass;  ///< pass: what is read is made by a pass over all balls
  double (*read)(const Engine&, Instant&, std::size_t row, std::size_t axis);
};
Column after(Column first, std::size_t c) { return static_cast<Column>(static_cast<std::size_t>(first) + c); }
const BallWord ball_words[] = {
    {"position", "m", true, false,
     [](const Engine& e, Instant&, std::size_t row, std::size_t c) { return e.balls[after(Column::x, c)][row]; }},
    {"velocity", "m/s", true, true,
     [](const Engine&, Instant& now, std::size_t row, std::size_t c) { return now.observation().velocity[c][row]; }},
    {"spin", "rad/s", true, true,
     [](const Engine&, Instant& now, std::size_t row, std::size_t c) {
       const auto& spin = now.observation().spin[c];
       return row < spin.size() ? spin[row] : 0.0;
     }},
    {"force", "N", true, true,
     [](const Engine&, Instant& now, std::size_t row, std::size_t c) { return now.observation().force[c][row]; }},
    {"radius", "m", false, false,
     [](const Engine& e, Instant&, std::size_t row, std::size_t) { return e.balls[Column::radius][row]; }},
    {"mass", "kg", false, false,
     [](const Engine& e, Instant&, std::size_t row, std::size_t) { return e.balls[Column::mass][row]; }},
};

struct ContactWord {
  const char *name, *unit;
  bool vector;
};
const ContactWord contact_words[] = {
    {"force", "N", true}, {"normal_force", "N", false}, {"shear_force", "N", false}, {"overlap", "m", false}};

/// A pair as the scene named it.
struct Pair {
  uint64_t low = 0, high = 0;
  std::string wall;  ///< "" between balls
  double sign = 1;   ///< -1 when the scene named the higher id first
};

double read_contact(const Pair& pair, const std::string& word, std::size_t axis, const Engine& engine, Instant& now) {
  const auto& all = now.contacts();
  double sum = 0;
  bool first = true;
  auto at = std::lower_bound(all.begin(), all.end(), std::pair(pair.low, pair.high),
                             [](const ActiveContact& a, const auto& key) { return std::pair(a.id1, a.id2) < key; });
  for (; at != all.end() && at->id1 == pair.low && at->id2 == pair.high; ++at) {
    if (!pair.wall.empty() && engine.walls[at->wall].name != pair.wall) continue;
    if (word == "force") sum += pair.sign * at->force[axis];
    if (word == "normal_force") sum += at->normal_force();
    if (word == "shear_force") sum += at->shear_force();
    if (word == "overlap") sum = first ? at->overlap : std::max(sum, at->overlap);
    first = false;
  }
  return sum;
}

void add_names(const std::string& start, const auto& words, std::vector<std::string>& names) {
  for (const auto& word : words) {
    if (word.vector)
      for (const char axis : {'x', 'y', 'z'}) names.push_back(start + word.name + "." + axis);
    else
      names.push_back(start + word.name);
  }
}

}  // namespace

std::optional<Published> find_wall_quantity(const std::string& name, Engine& engine) {
  const Parts parts = taken_apart(name);
  if (parts.kind != "walls" || parts.first.empty()) return std::nullopt;
  const auto wall = [&engine, sought = parts.first]() -> const Wall* {
    for (const Wall& one : engine.walls)
      if (one.name == sought) return &one;
    return nullptr;
  };
  if (parts.rest == "contacts") {
    return Published{"1", {}, [wall] {
                       const Wall* found = wall();
                       return found != nullptr ? static_cast<double>(found->contacts) : std::nan("");
                     }};
  }
  const auto [word, axis] = axis_of(parts.rest);
  for (const WallWord& one : wall_words)
    if (word == one.name && axis >= 0)
      return Published{one.unit, {}, [wall, &one, c = static_cast<std::size_t>(axis)] {
                         const Wall* found = wall();
                         return found != nullptr ? one.read(*found, c) : std::nan("");
                       }};
  return std::nullopt;
}

std::optional<Published> find_ball_quantity(const std::string& name, Engine& engine, Instant& now) {
  const Parts parts = taken_apart(name);
  const auto id = id_of(parts.first);
  if (parts.kind != "balls" || !id) return std::nullopt;
  const auto [word, axis] = axis_of(parts.rest);
  for (const BallWord& one : ball_words)
    if (word == one.name && one.vector == (axis >= 0))
      return Published{
          one.unit, {false, false, one.pass}, [&engine, &now, &one, id, c = static_cast<std::size_t>(axis)] {
            const uint32_t row = now.row_of(*id);
            return row != no_row ? one.read(engine, now, row, c) : std::nan("");
          }};
  return std::nullopt;
}

std::optional<Published> find_contact_quantity(const std::string& name, Engine& engine, Instant& now) {
  const Parts parts = taken_apart(name);
  const auto first = id_of(parts.first), second = id_of(parts.second);
  if (parts.kind != "contacts" || !first || parts.second.empty() || (second && *first == *second)) return std::nullopt;
  Pair pair{*first, 0, second ? "" : parts.second, 1};
  if (second) pair = {std::min(*first, *second), std::max(*first, *second), "", *first < *second ? 1.0 : -1.0};
  const auto [word, axis] = axis_of(parts.rest);
  for (const ContactWord& one : contact_words)
    if (word == one.name && one.vector == (axis >= 0))
      return Published{
          one.unit, {false, true, true}, [&engine, &now, pair, sought = word, c = static_cast<std::size_t>(axis)] {
            return read_contact(pair, sought, c, engine, now);
          }};
  return std::nullopt;
}

std::string wall_of_quantity(const std::string& name) {
  const Parts parts = taken_apart(name);
  if (parts.kind == "walls") return parts.first;
  return parts.kind == "contacts" && id_of(parts.first) && !id_of(parts.second) ? parts.second : "";
}

std::vector<uint64_t> balls_of_quantity(const std::string& name) {
  const Parts parts = taken_apart(name);
  std::vector<uint64_t> ids;
  if (parts.kind != "balls" && parts.kind != "contacts") return ids;
  for (const auto& id : {id_of(parts.first), id_of(parts.second)})
    if (id) ids.push_back(*id);
  return ids;
}

void add_wall_names(const std::string& wall, std::vector<std::string>& names) {
  for (const WallWord& word : wall_words)
    for (const char axis : {'x', 'y', 'z'}) names.push_back("walls." + wall + "." + word.name + "." + axis);
  names.push_back("walls." + wall + ".contacts");
}

void add_piece_names(const std::string& like, std::vector<std::string>& names) {
  const Parts parts = taken_apart(like);
  if (!id_of(parts.first)) return;
  if (parts.kind == "balls") add_names("balls." + parts.first + ".", ball_words, names);
  if (parts.kind == "contacts" && !parts.second.empty())
    add_names("contacts." + parts.first + "." + parts.second + ".", contact_words, names);
}

}  // namespace scree::core
