#include "core/scene/parts.hpp"

namespace scree::core {

namespace {

void read_between(const Node& node, BondAction& bond, Context& context) {
  const bool pair = node.is_list() && node.items.size() == 2;
  if (!pair)
    context.report.error(node.place(),
                         "'between' wants two sides, as in [sand, [gravel, sand]], not " + describe(node));
  for (size_t side = 0; pair && side < 2; ++side) bond.between[side] = read_words(node.items[side], "between", context);
}

}  // namespace

BondAction read_bond(const Node& node, Context& context) {
  BondAction bond;
  Mapping mapping(node, "action 'bond'", context);
  if (const Node* rule = mapping.need("rule"))
    if (const auto name = read_word(*rule, "rule", context)) bond.rule = {*name, rule->place()};
  if (const Node* gap = mapping.take("gap")) {
    bond.gap = read_plain(*gap, {"gap", "m"}, context).value_or(0.0);
    if (bond.gap < 0) context.report.error(gap->place(), "'gap' must be at least 0, not " + describe(*gap));
  }
  if (const Node* again = mapping.take("again")) bond.again = read_bool(*again, "again", context).value_or(true);
  if (const Node* between = mapping.take("between")) read_between(*between, bond, context);
  mapping.finish();
  return bond;
}

}  // namespace scree::core
