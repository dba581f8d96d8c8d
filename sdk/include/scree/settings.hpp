#pragma once
/// What a wall, generator, process or writer can be told from a scene: one line per key, tied to a member of the
/// author's struct.
///
///     struct Gravity {
///       Vec3 acceleration{0, 0, -9.81};
///       static void describe(Settings<Gravity>& s) {
///         s.vector("acceleration", &Gravity::acceleration, "m/s2", "pull on every ball");
///       }
///     };
///
/// Values arrive in SI. A key that the scene does not name leaves the member at its initial value, which is therefore
/// the default that `scree show` prints. Bounds are checked before the member is written.
#include <scree/abi.h>
#include <scree/math.hpp>
#include <scree/refusal.hpp>
#include <scree/setting_value.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace scree {

/// Refines one key; returned by every function of Settings and Columns.
class Setting {
 public:
  explicit Setting(scree_property& property) : property_(property) {}

  Setting& required() { return flag(SCREE_REQUIRED); }                   ///< the scene must give it
  Setting& at_least(double low) { return set_low(low, SCREE_HAS_LOW); }  ///< bounds are in SI units
  Setting& above(double low) { return set_low(low, SCREE_HAS_LOW | SCREE_LOW_OPEN); }
  Setting& at_most(double high) { return set_high(high, SCREE_HAS_HIGH); }
  Setting& below(double high) { return set_high(high, SCREE_HAS_HIGH | SCREE_HIGH_OPEN); }
  /// A default other than the member's initial value (number, integer, boolean, column of a table).
  Setting& fallback(double value) {
    property_.fallback = value;
    return flag(SCREE_HAS_FALLBACK);
  }
  /// Text and texts: the words that are allowed, separated by one space. A string literal.
  Setting& choices(const char* words) {
    property_.choices = words;
    return *this;
  }
  /// `.inf` is a legal value.
  Setting& infinite() { return flag(SCREE_POSITIVE_INFINITY); }

 private:
  Setting& flag(uint32_t flags) {
    property_.flags |= flags;
    return *this;
  }
  Setting& set_low(double low, uint32_t flags) {
    property_.low = low;
    return flag(flags);
  }
  Setting& set_high(double high, uint32_t flags) {
    property_.high = high;
    return flag(flags);
  }

  scree_property& property_;
};

/// The columns of a table key, tied to the members of one record; each call adds one. Numbers arrive in SI units.
template <class Row>
class Columns {
 public:
  using Store = std::function<void(Row&, const double*)>;

  Setting number(const char* name, double Row::*member, const char* unit, const char* doc) {
    return add(SCREE_NUMBER, 1, name, unit, doc, [member](Row& row, const double* w) { row.*member = w[0]; });
  }
  /// Two numbers, lower and upper end: `diameter: [12.5 mm, 25 mm]`.
  Setting interval(const char* name, std::array<double, 2> Row::*member, const char* unit, const char* doc) {
    return add(SCREE_NUMBERS, 2, name, unit, doc, [member](Row& row, const double* w) { row.*member = {w[0], w[1]}; });
  }
  Setting vector(const char* name, Vec3 Row::*member, const char* unit, const char* doc) {
    return add(SCREE_VECTOR, 3, name, unit, doc, [member](Row& row, const double* w) {
      row.*member = {w[0], w[1], w[2]};
    });
  }

  const std::deque<scree_property>& properties() const { return properties_; }
  const std::vector<Store>& stores() const { return stores_; }
  uint32_t words() const { return words_; }

 private:
  Setting add(uint32_t type, uint32_t words, const char* name, const char* unit, const char* doc, Store store) {
    properties_.push_back(blank_property(type, words, name, unit, doc));
    properties_.back().word = words_;
    words_ += words;
    stores_.push_back(std::move(store));
    return Setting(properties_.back());
  }

  std::deque<scree_property> properties_;
  std::vector<Store> stores_;
  uint32_t words_ = 0;
};

/// The keys of one component; each call adds one. `unit`: UDUNITS spelling, "1" for a pure number; texts: literals.
template <class T>
class Settings {
 public:
  Setting number(const char* name, double T::*member, const char* unit, const char* doc) {
    return add(
        SCREE_NUMBER, 1, name, unit, doc, [member](T& t, const scree_value& v) { t.*member = v.numbers[0]; },
        [member](const T& t) { return t.*member; });
  }
  /// A number that stays empty when the scene is silent.
  Setting number(const char* name, std::optional<double> T::*member, const char* unit, const char* doc) {
    return add(SCREE_NUMBER, 1, name, unit, doc, [member](T& t, const scree_value& v) { t.*member = v.numbers[0]; });
  }
  template <class Whole>
  requires std::is_integral_v<Whole> Setting integer(const char* name, Whole T::*member, const char* unit,
                                                     const char* doc) {
    return add(
        SCREE_INTEGER, 1, name, unit, doc,
        [member, name](T& t, const scree_value& v) { t.*member = whole<Whole>(name, v.numbers[0]); },
        [member](const T& t) { return static_cast<double>(t.*member); });
  }
  /// An integer that stays empty when the scene is silent.
  template <class Whole>
  Setting integer(const char* name, std::optional<Whole> T::*member, const char* unit, const char* doc) {
    return add(SCREE_INTEGER, 1, name, unit, doc,
               [member, name](T& t, const scree_value& v) { t.*member = whole<Whole>(name, v.numbers[0]); });
  }
  Setting boolean(const char* name, bool T::*member, const char* doc) {
    return add(
        SCREE_BOOLEAN, 1, name, "1", doc, [member](T& t, const scree_value& v) { t.*member = v.numbers[0] != 0; },
        [member](const T& t) { return t.*member ? 1.0 : 0.0; });
  }
  Setting vector(const char* name, Vec3 T::*member, const char* unit, const char* doc) {
    return add(SCREE_VECTOR, 3, name, unit, doc, [member](T& t, const scree_value& v) { t.*member = vec3(v.numbers); });
  }
  /// A vector that stays empty when the scene is silent.
  Setting vector(const char* name, std::optional<Vec3> T::*member, const char* unit, const char* doc) {
    return add(SCREE_VECTOR, 3, name, unit, doc, [member](T& t, const scree_value& v) { t.*member = vec3(v.numbers); });
  }
  Setting text(const char* name, std::string T::*member, const char* doc) {
    return add(SCREE_TEXT, 0, name, "1", doc, [member](T& t, const scree_value& v) { t.*member = v.texts[0]; });
  }
  /// A file to read. The scene gives it relative to its own folder; the member receives a path that can be opened.
  Setting file(const char* name, std::string T::*member, const char* doc) {
    Setting setting = text(name, member, doc);
    entries_.back().property.flags |= SCREE_FILE;
    return setting;
  }
  /// A list of numbers of any length.
  Setting numbers(const char* name, std::vector<double> T::*member, const char* unit, const char* doc) {
    return add(SCREE_NUMBERS, 0, name, unit, doc,
               [member](T& t, const scree_value& v) { (t.*member).assign(v.numbers, v.numbers + v.rows); });
  }
  /// A list of vectors of any length.
  Setting vectors(const char* name, std::vector<Vec3> T::*member, const char* unit, const char* doc) {
    return add(SCREE_VECTORS, 0, name, unit, doc, [member](T& t, const scree_value& v) {
      (t.*member).clear();
      for (uint32_t row = 0; row < v.rows; ++row) (t.*member).push_back(vec3(v.numbers + 3 * row));
    });
  }
  /// Two opposite corners, lower and upper: `box: [[0, 0, 0], [1, 1, 1]]`.
  Setting box(const char* name, std::array<Vec3, 2> T::*member, const char* unit, const char* doc) {
    return add(SCREE_VECTORS, 6, name, unit, doc, [member, name](T& t, const scree_value& v) {
      t.*member = {vec3(v.numbers), vec3(v.numbers + 3)};
      check_corners(name, (t.*member)[0], (t.*member)[1]);
    });
  }
  Setting texts(const char* name, std::vector<std::string> T::*member, const char* doc) {
    return add(SCREE_TEXTS, 0, name, "1", doc,
               [member](T& t, const scree_value& v) { (t.*member).assign(v.texts, v.texts + v.text_count); });
  }
  /// A list of records: `grading: [{diameter: [9.5 mm, 12.5 mm], share: 1}]`. `columns` is a function that names the
  /// columns: `[](Columns<Row>& c) { c.number("share", &Row::share, "1", "..."); }`.
  template <class Row, class Describe>
  Setting table(const char* name, std::vector<Row> T::*member, const char* doc, Describe describe) {
    Columns<Row> columns;
    describe(columns);
    const uint32_t words = columns.words();
    Setting setting =
        add(SCREE_TABLE, words, name, "1", doc,
            [member, words, stores = columns.stores(), list = columns.properties()](T& t, const scree_value& v) {
              (t.*member).clear();
              for (uint32_t r = 0; r < v.rows; ++r) {
                Row row{};
                for (std::size_t c = 0; c < stores.size(); ++c) {
                  const double* cells = v.numbers + std::size_t{r} * words + list[c].word;
                  check_numbers(list[c], cells, list[c].words);
                  stores[c](row, cells);
                }
                (t.*member).push_back(row);
              }
            });
    entries_.back().columns.assign(columns.properties().begin(), columns.properties().end());
    return setting;
  }

  /// One key with the code that stores its value; for the adapters.
  struct Entry {
    scree_property property;
    std::function<void(T&, const scree_value&)> store;
    std::function<double(const T&)> initial;  ///< empty: no default that fits into one number
    std::vector<scree_property> columns;
  };
  std::deque<Entry>& entries() { return entries_; }

 private:
  Setting add(uint32_t type, uint32_t words, const char* name, const char* unit, const char* doc,
              std::function<void(T&, const scree_value&)> store, std::function<double(const T&)> initial = nullptr) {
    entries_.push_back({blank_property(type, words, name, unit, doc), std::move(store), std::move(initial), {}});
    return Setting(entries_.back().property);
  }

  std::deque<Entry> entries_;  // a deque, because a Setting refers into it
};

}  // namespace scree
