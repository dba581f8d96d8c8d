#include "core/scene/drawn.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scene/mapping.hpp"
#include "core/scene/units.hpp"
#include "core/scene/use.hpp"

namespace scree::core {
namespace {

using Law = Distribution::Law;

constexpr double infinite = std::numeric_limits<double>::infinity();

const std::vector<std::string>& laws() {
  static const std::vector<std::string> names = {"normal", "uniform", "weibull"};
  return names;
}

/// The parameters of one law, each a number in the unit of the property or a pure one.
class Parameters {
 public:
  Parameters(const Node& node, const std::string& law, const Wanted& wanted, Context& context)
      : mapping_(node, "'" + law + "' of '" + wanted.name + "'", context), wanted_(wanted), context_(context) {}

  double need(const std::string& key, bool pure = false) {
    const Node* node = mapping_.need(key);
    good_ = good_ && node != nullptr;
    return node == nullptr ? 0 : number(*node, key, pure);
  }
  double bound(const std::string& key, double absent) {
    const Node* node = mapping_.take(key);
    return node == nullptr ? absent : number(*node, key, false);
  }
  void wants(bool holds, const std::string& key, const std::string& what) {
    if (holds || !good_) return;
    const Node* node = mapping_.node().find(key);
    context_.report.error(node->place(),
                          "'" + wanted_.name + "." + key + "' must be " + what + ", not " + describe(*node));
    good_ = false;
  }
  bool finish() {
    mapping_.finish();
    return good_ && mapping_.is_map();
  }
  const std::string& unit() const { return unit_; }

 private:
  double number(const Node& node, const std::string& key, bool pure) {
    const auto read = read_number(node, {wanted_.name + "." + key, pure ? "1" : wanted_.unit}, context_);
    good_ = good_ && read;
    if (!read) return 0;
    if (!pure && !read->unit.empty()) {
      if (!unit_.empty() && !units::same_dimension(unit_, read->unit)) {
        context_.report.error(node.place(), "'" + wanted_.name + "." + key + "' is " + units::dimension(read->unit) +
                                                ", but another parameter is " + units::dimension(unit_));
        good_ = false;
      }
      unit_ = read->unit;
    }
    return read->value;
  }

  Mapping mapping_;
  Wanted wanted_;
  Context& context_;
  bool good_ = true;
  std::string unit_;
};

std::shared_ptr<Distribution> read_law(const std::string& law, Parameters& from) {
  if (law == "uniform") {
    const double low = from.need("low"), high = from.need("high");
    from.wants(low <= high, "high", "at least 'low'");
    return std::make_shared<Distribution>(Law::uniform, low, high);
  }
  std::shared_ptr<Distribution> out;
  if (law == "normal") {
    const double mean = from.need("mean"), sd = from.need("sd");
    from.wants(sd >= 0, "sd", "at least 0");
    out = std::make_shared<Distribution>(Law::normal, mean, sd);
  } else {
    const double shape = from.need("shape", true), scale = from.need("scale");
    from.wants(shape > 0, "shape", "above 0");
    from.wants(scale > 0, "scale", "above 0");
    out = std::make_shared<Distribution>(Law::weibull, shape, scale);
  }
  const double low = from.bound("low", -infinite), high = from.bound("high", infinite);
  from.wants(low <= high, "high", "at least 'low'");
  out->cut(low, high);
  return out;
}

}  // namespace

bool is_distribution(const std::string& name) { return std::find(laws().begin(), laws().end(), name) != laws().end(); }

std::optional<Drawn> read_drawn(const Node& node, const Wanted& wanted, Context& context) {
  const bool one = node.keys.size() == 1;
  if (!one || !is_distribution(node.keys[0].text)) {
    context.report.error(
        one ? node.keys[0].spot.place() : node.place(),
        "'" + wanted.name + "' wants a number or one distribution, as in {normal: {mean: 3, sd: 1}}" +
            (one ? ", not '" + node.keys[0].text.substr(0, 60) + "'" + suggestion(node.keys[0].text, laws()) : "") +
            "  (" + list_of(laws()) + ")");
    return std::nullopt;
  }
  Wanted plain = wanted;
  plain.infinity = plain.position = false;
  Parameters parameters(node.items[0], node.keys[0].text, plain, context);
  Drawn drawn;
  drawn.distribution = read_law(node.keys[0].text, parameters);
  drawn.unit = parameters.unit();
  if (!parameters.finish()) return std::nullopt;
  return drawn;
}

bool cut_to_range(Distribution& distribution, const scree_property& property, const Place& place, Context& context) {
  const bool uniform = distribution.law() == Law::uniform;
  const double given[2] = {uniform ? distribution.first() : distribution.low(),
                           uniform ? distribution.second() : distribution.high()};
  for (const double bound : given) {
    const auto why = std::isinf(bound) ? std::nullopt : range_error(property, bound);
    if (!why) continue;
    context.report.error(place, *why + ": a bound of its distribution lies outside");
    return false;
  }
  double low = (property.flags & SCREE_HAS_LOW) != 0 ? property.low : -infinite;
  double high = (property.flags & SCREE_HAS_HIGH) != 0 ? property.high : infinite;
  if ((property.flags & SCREE_LOW_OPEN) != 0) low = std::nextafter(low, infinite);
  if ((property.flags & SCREE_HIGH_OPEN) != 0) high = std::nextafter(high, -infinite);
  distribution.cut(low, high);
  constexpr double least = 0.01;
  const double kept = distribution.kept();
  if (kept >= least) return true;
  context.report.error(place, "'" + std::string(property.name) + "': the bounds of its distribution keep " +
                                  number_text(std::round(kept * 1e6) / 1e4) +
                                  " % of it, less than 1 %: widen 'low' and 'high', or choose parameters whose values "
                                  "lie in the range of the property");
  return false;
}

}  // namespace scree::core
