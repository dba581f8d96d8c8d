#include "core/scene/units.hpp"

#include <locale.h>
#include <udunits2.h>

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "core/base/error.hpp"

namespace scree::core::units {
namespace {

/// UDUNITS reads its database and formats numbers with the locale of the thread.
class PlainLocale {
 public:
  PlainLocale() : plain_(newlocale(LC_ALL_MASK, "C", nullptr)), before_(uselocale(plain_)) {}
  ~PlainLocale() {
    uselocale(before_);
    freelocale(plain_);
  }
  PlainLocale(const PlainLocale&) = delete;
  PlainLocale& operator=(const PlainLocale&) = delete;

 private:
  locale_t plain_, before_;
};

struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
struct FreeSystem {
  void operator()(ut_system* system) const { ut_free_system(system); }
};
struct FreeConverter {
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;

/// A unit and its dimension, as "m-1.kg.s-2", with any angle as "rad".
struct Entry {
  Unit unit;
  std::string base;
};

/// The words of UDUNITS' grammar that make a time stamp or a logarithm, and signs it should not see.
bool harmless(const std::string& unit) {
  constexpr size_t longest = 80;
  if (unit.empty() || unit.size() > longest) return false;
  const bool digit_first = unit[0] >= '0' && unit[0] <= '9';
  if (digit_first && unit != "1" && unit.rfind("1/", 0) != 0) return false;
  std::string word;
  for (size_t i = 0; i <= unit.size(); ++i) {
    const char c = i < unit.size() ? unit[i] : ' ';
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) >= 0x80;
    if (letter) {
      word += c;
      continue;
    }
    for (const char* refused : {"since", "from", "after", "ref", "re", "lg", "ln", "lb", "log"})
      if (word == refused) return false;
    word.clear();
    if (!(c >= '0' && c <= '9') && std::string(" %/*.^-()").find(c) == std::string::npos) return false;
  }
  return true;
}

class Database {
 public:
  Database() {
    const PlainLocale plain;
    ut_set_error_message_handler(ut_ignore);
    system_.reset(ut_read_xml(nullptr));
    if (!system_)
      throw Refusal(Exit::io,
                    "the unit database of UDUNITS-2 cannot be loaded: install libudunits2-data, or mend the "
                    "variable UDUNITS2_XML_PATH; a scene with plain SI numbers needs no database");
    // UDUNITS spells it out; everybody else writes deg.
    const Unit degree(ut_get_unit_by_name(system_.get(), "degree"));
    if (degree) ut_map_symbol_to_unit("deg", UT_ASCII, degree.get());
  }

  const Entry* find(const std::string& text) {
    const auto known = entries_.find(text);
    if (known != entries_.end()) return known->second.unit ? &known->second : nullptr;
    if (!harmless(text)) return nullptr;
    // Callers hold two entries at a time; a file of endless made-up units must not fill the memory.
    constexpr size_t most_remembered = 1000;
    Entry& entry = entries_.size() < most_remembered ? entries_[text] : spare_[turn_ = 1 - turn_];
    const PlainLocale plain;
    entry.unit.reset(ut_parse(system_.get(), text.c_str(), UT_UTF8));
    if (!entry.unit) return nullptr;
    entry.base = base_of(entry.unit.get());
    if (entry.base.empty()) entry.unit.reset();
    return entry.unit ? &entry : nullptr;
  }

 private:
  /// The definition "1000 m-1.kg.s-2" without its factor and offset; empty for logarithms.
  static std::string base_of(const ut_unit* unit) {
    std::array<char, 256> buffer{};
    const int length = ut_format(unit, buffer.data(), buffer.size(), UT_ASCII | UT_DEFINITION);
    if (length <= 0 || static_cast<size_t>(length) >= buffer.size()) return "";
    std::string text(buffer.data(), static_cast<size_t>(length));
    if (text.find('(') != std::string::npos) return "";
    if (const size_t at = text.find(" @"); at != std::string::npos) text.erase(at);
    double factor = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), factor);
    if (error == std::errc()) text.erase(0, static_cast<size_t>(end - text.data()));
    while (!text.empty() && text[0] == ' ') text.erase(0, 1);
    return text.empty() ? "1" : text;
  }

  std::unique_ptr<ut_system, FreeSystem> system_;
  std::map<std::string, Entry> entries_;
  std::array<Entry, 2> spare_;
  size_t turn_ = 0;
};

Database& database() {
  static Database instance;
  return instance;
}

double apply(const ut_unit* from, const ut_unit* to, double value) {
  const std::unique_ptr<cv_converter, FreeConverter> converter(
      ut_get_converter(const_cast<ut_unit*>(from), const_cast<ut_unit*>(to)));
  if (!converter) throw Refusal(Exit::internal, "UDUNITS-2 has no converter between two units of one dimension");
  const double offset = cv_convert_double(converter.get(), 0.0), factor = cv_convert_double(converter.get(), 1.0);
  // 35 mm must be the double 0.035: dividing by 1000 rounds once, multiplying by 0.001 twice.
  const double inverse = 1.0 / factor, whole = std::nearbyint(inverse);
  if (offset == 0.0 && factor < 1.0 && std::abs(inverse - whole) < 1e-12 * whole) return value / whole;
  return cv_convert_double(converter.get(), value);
}

}  // namespace

bool known(const std::string& unit) { return database().find(unit) != nullptr; }

bool same_dimension(const std::string& one, const std::string& other) {
  if (one == other) return true;
  const Entry* a = database().find(one);
  const Entry* b = database().find(other);
  return a && b && a->base == b->base;
}

std::optional<double> convert(double value, const std::string& unit, const std::string& wanted) {
  if (unit == wanted) return value;
  const Entry* from = database().find(unit);
  const Entry* to = database().find(wanted);
  if (!from || !to || from->base != to->base) return std::nullopt;
  return apply(from->unit.get(), to->unit.get(), value);
}

double to_si(double value, const std::string& unit) {
  const Entry* from = database().find(unit);
  const Entry* to = from ? database().find(from->base) : nullptr;
  if (!to) throw Refusal(Exit::internal, "the unit '" + unit + "' was not checked before its use");
  return apply(from->unit.get(), to->unit.get(), value);
}

std::string dimension(const std::string& unit) {
  static constexpr std::pair<const char*, const char*> names[] = {{"1", "a pure number"},
                                                                  {"m", "a length"},
                                                                  {"m2", "an area"},
                                                                  {"m3", "a volume"},
                                                                  {"kg", "a mass"},
                                                                  {"s", "a time"},
                                                                  {"K", "a temperature"},
                                                                  {"rad", "an angle"},
                                                                  {"m/s", "a velocity"},
                                                                  {"m/s2", "an acceleration"},
                                                                  {"rad/s", "an angular velocity"},
                                                                  {"1/s", "a frequency"},
                                                                  {"N", "a force"},
                                                                  {"Pa", "a pressure"},
                                                                  {"N/m", "a stiffness in N/m"},
                                                                  {"Pa/m", "a stiffness in Pa/m"},
                                                                  {"kg/m3", "a density"},
                                                                  {"N m", "a moment or energy"},
                                                                  {"N m/rad", "a rotational stiffness"},
                                                                  {"W", "a power"},
                                                                  {"N s", "an impulse"},
                                                                  {"N s/m", "a damping in N s/m"},
                                                                  {"Pa s", "a viscosity"},
                                                                  {"J/m2", "an energy per area"},
                                                                  {"A", "a current"},
                                                                  {"mol", "an amount"}};
  for (const auto& [si, name] : names)
    if (same_dimension(unit, si)) return name;
  const Entry* entry = database().find(unit);
  return "a quantity in " + (entry ? entry->base : unit);
}

}  // namespace scree::core::units
