#include "core/vet/object.hpp"

#include <malloc.h>
#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/base/file.hpp"
#include "core/base/log.hpp"

namespace scree::core::vet {

namespace {

bool has(const scree_property& p, uint32_t flag) { return (p.flags & flag) != 0; }

/// A file for a setting that names one: the plainest table of balls, in memory. It lives as long as the process.
std::string sample_file() {
  static const std::string name = [] {
    const std::string text = "x,y,z,radius\n0,0,0,0.01\n0.05,0,0,0.02\n";
    const int fd = ::memfd_create("balls", MFD_CLOEXEC);
    if (fd < 0 || write_all(fd, text.data(), text.size()) != 0) throw Skipped("no file could be made for its settings");
    return "/proc/self/fd/" + std::to_string(fd);
  }();
  return name;
}

double number(const scree_property& p, Numbers& random) {
  const bool low = has(p, SCREE_HAS_LOW), high = has(p, SCREE_HAS_HIGH);
  if (p.type == SCREE_BOOLEAN) return random.chance(0.5) ? 1 : 0;
  if (p.type == SCREE_INTEGER) {
    const double first = low ? p.low : 0, last = std::min(high ? p.high : first + 8, first + 8);
    return std::floor(random.between(first, last + 1));
  }
  const std::string unit = p.unit;
  double value = unit == "m" ? random.spread(2e-3, 1e-2) : random.spread(0.1, 1);
  if (low && high) value = random.between(p.low, p.high);
  if (high) value = std::min(value, has(p, SCREE_HIGH_OPEN) ? p.high - 1e-3 * std::abs(p.high) : p.high);
  if (low) value = std::max(value, has(p, SCREE_LOW_OPEN) ? p.low + 1e-3 * std::max(std::abs(p.low), 1e-3) : p.low);
  return value;
}

void add_corners(Given& given, Numbers& random) {
  const Vec3 low = random.vector(0.05), high = low + Vec3{0.1, 0.1, 0.1};
  given.numbers = {low.x, low.y, low.z, high.x, high.y, high.z};
}

std::vector<std::string> words_of(const char* choices) {
  std::vector<std::string> words(1);
  for (const char* c = choices; *c != 0; ++c)
    if (*c == ' ')
      words.emplace_back();
    else
      words.back() += *c;
  return words;
}

Given random_value(const scree_property& p, uint32_t index, Numbers& random) {
  Given g;
  g.property = index;
  g.type = p.type;
  g.rows = g.columns = 1;
  switch (p.type) {
    case SCREE_VECTOR: {
      const Vec3 v = random.vector(std::string(p.unit) == "m" ? 0.1 : 1);
      g.numbers = {v.x, v.y, v.z};
      g.columns = 3;
      break;
    }
    case SCREE_NUMBERS:
      g.rows = p.words != 0 ? p.words : 1 + static_cast<uint32_t>(random.below(2));
      for (uint32_t k = 0; k < g.rows; ++k) g.numbers.push_back(number(p, random));
      std::sort(g.numbers.begin(), g.numbers.end());
      break;
    case SCREE_VECTORS:
      g.columns = 3;
      g.rows = p.words != 0 ? p.words / 3 : 2;
      if (g.rows == 2) add_corners(g, random);
      for (uint32_t k = 0; g.rows != 2 && k < 3 * g.rows; ++k) g.numbers.push_back(random.between(-0.1, 0.1));
      break;
    case SCREE_TABLE:
      g.columns = p.words;
      for (uint32_t c = 0; c < p.column_count; ++c) {
        std::vector<double> cells;
        for (uint32_t w = 0; w < p.columns[c].words; ++w) cells.push_back(number(p.columns[c], random));
        std::sort(cells.begin(), cells.end());
        // A share of one row is the whole.
        if (cells.size() == 1 && std::string(p.columns[c].unit) == "1" && random.chance(0.7)) cells[0] = 1;
        g.numbers.insert(g.numbers.end(), cells.begin(), cells.end());
      }
      break;
    case SCREE_TEXT:
    case SCREE_TEXTS:
      g.rows = g.columns = 0;
      if (p.choices != nullptr) {
        const std::vector<std::string> words = words_of(p.choices);
        g.texts.push_back(words[random.below(words.size())]);
      } else {
        g.texts.push_back(has(p, SCREE_FILE) ? sample_file() : "a");
      }
      break;
    default:
      g.numbers.push_back(number(p, random));
  }
  return g;
}

scree_value value_of(const Given& g, std::vector<const char*>& pointers) {
  for (const std::string& text : g.texts) pointers.push_back(text.c_str());
  return {sizeof(scree_value),
          g.type,
          g.numbers.empty() ? nullptr : g.numbers.data(),
          g.rows,
          g.columns,
          pointers.empty() ? nullptr : pointers.data(),
          static_cast<uint32_t>(pointers.size()),
          0};
}

}  // namespace

std::string text_of(const scree_object& table, const Settings& settings) {
  std::string out;
  for (const Given& g : settings) {
    out += fmt::format("{}{}=", out.empty() ? "" : " ", table.properties[g.property].name);
    for (const double& value : g.numbers) out += fmt::format("{}{:.6g}", &value == g.numbers.data() ? "" : ",", value);
    for (const std::string& text : g.texts) out += text;
  }
  return out.empty() ? "no settings" : out;
}

Object::Object(const scree_object& table) : table_(table), self_(table.create()) {
  if (self_ == nullptr) throw Failed("'create' gives no object", "a default-constructed struct must not throw");
}
Object::~Object() { table_.destroy(self_); }

std::string Object::set(const Given& given) {
  std::vector<const char*> pointers;
  const scree_value value = value_of(given, pointers);
  Refused refused;
  if (table_.set(self_, given.property, &value, &refused.table) == 0) return "";
  return refused.why[0] != 0 ? refused.why : "refused without a reason";
}

std::string Object::check() {
  Refused refused;
  if (table_.check == nullptr || table_.check(self_, &refused.table) == 0) return "";
  return refused.why[0] != 0 ? refused.why : "refused without a reason";
}

void Object::set_all(const Settings& settings) {
  std::string why;
  for (const Given& given : settings)
    if (why.empty()) why = set(given);
  if (why.empty()) why = check();
  if (!why.empty())
    throw Failed("settings that one object accepted are refused by another: " + why + "; " + text_of(table_, settings),
                 "keep nothing between objects");
}

const scree_object& object_of(const Component& component) {
  switch (component.kind) {
    case Kind::wall:
      return component.wall().object;
    case Kind::generator:
      return component.generator().object;
    case Kind::process:
      return component.process().object;
    default:
      return component.writer().object;
  }
}

std::vector<Settings> accepted_settings(const Subject& subject, std::size_t count, uint64_t seed) {
  const scree_object& table = object_of(*subject.component);
  Numbers random(seed);
  std::vector<Settings> list;
  std::string why;
  for (std::size_t tries = 0; list.size() < count && tries < 500 + 50 * count; ++tries) {
    Settings settings;
    for (uint32_t k = 0; k < table.property_count; ++k)
      if (has(table.properties[k], SCREE_REQUIRED) || random.chance(0.35))
        settings.push_back(random_value(table.properties[k], k, random));
    Object object(table);
    std::string refusal;
    for (const Given& given : settings)
      if (refusal.empty()) refusal = object.set(given);
    if (refusal.empty()) refusal = object.check();
    if (refusal.empty())
      list.push_back(std::move(settings));
    else
      why = refusal;
  }
  if (list.empty()) throw Skipped("it refuses every setting that was tried: " + why);
  return list;
}

Outcome settings_accepted(const Subject& subject) {
  const std::vector<Settings> all = accepted_settings(subject, 16);
  const scree_object& table = object_of(*subject.component);
  for (const Settings& settings : all) {
    Object first(table), second(table);
    first.set_all(settings);
    second.set_all(settings);
  }
  return passed(fmt::format("{} sets of settings", all.size()));
}

Outcome settings_refused(const Subject& subject) {
  const scree_object& table = object_of(*subject.component);
  std::size_t refusals = 0;
  Numbers random(3);
  const auto require = [&](const Given& given, const std::string& what) {
    Object object(table);
    const std::string why = object.set(given);
    const std::string name = given.property < table.property_count ? table.properties[given.property].name : "?";
    if (why.empty())
      throw Failed("'" + name + "' takes " + what, "check the type and the bounds of a value before it is stored");
    if (why == "refused without a reason")
      throw Failed("'" + name + "' refuses " + what + " without a reason", "throw a std::exception that says why");
    ++refusals;
  };
  for (uint32_t k = 0; k < table.property_count; ++k) {
    const scree_property& p = table.properties[k];
    const Given good = random_value(p, k, random);
    Given wrong = good;
    wrong.type = p.type == SCREE_TEXT ? SCREE_NUMBER : SCREE_TEXT;
    require(wrong, "a value of another type");
    if (good.numbers.empty()) {
      if (p.choices == nullptr) continue;
      wrong = good;
      wrong.texts = {"no such word"};
      require(wrong, "a word that is none of its choices");
      continue;
    }
    wrong = good;
    wrong.numbers[0] = std::numeric_limits<double>::quiet_NaN();
    require(wrong, "what is not a number");
    if (p.type == SCREE_TABLE) continue;
    wrong.numbers[0] = p.low - 1 - std::abs(p.low);
    if (has(p, SCREE_HAS_LOW)) require(wrong, "a value below its lower bound");
    wrong.numbers[0] = p.high + 1 + std::abs(p.high);
    if (has(p, SCREE_HAS_HIGH)) require(wrong, "a value above its upper bound");
  }
  if (refusals == 0) throw Skipped("it has no settings that could be wrong");
  return passed(fmt::format("{} refusals, each with its reason", refusals));
}

namespace {

// A sanitizer or another allocator in place of the C library's leaves its count at nothing.
bool heap_is_counted() {
  const std::size_t before = ::mallinfo2().uordblks;
  const std::unique_ptr<char[]> block = std::make_unique<char[]>(4096);
  return ::mallinfo2().uordblks > before;
}

}  // namespace

Outcome objects_given_back(const Subject& subject) {
  if (!heap_is_counted()) throw Skipped("the allocator of this program does not tell how much is taken");
  const scree_object& table = object_of(*subject.component);
  const std::vector<Settings> all = accepted_settings(subject, 8);
  const auto round = [&] {
    for (const Settings& settings : all) {
      Object object(table);
      object.set_all(settings);
    }
  };
  // The first rounds fill what the C library keeps for itself.
  for (int k = 0; k < 4; ++k) round();
  const std::size_t before = ::mallinfo2().uordblks;
  constexpr int rounds = 64;
  for (int k = 0; k < rounds; ++k) round();
  const std::size_t after = ::mallinfo2().uordblks;
  const double lost = after > before ? static_cast<double>(after - before) / rounds : 0;
  Worst worst;
  worst.see(lost, [&] {
    return fmt::format("{:.0f} bytes stay taken for every {} objects made and destroyed", lost, all.size());
  });
  return worst.judged(8, "free in the destructor what the object holds");
}

}  // namespace scree::core::vet
