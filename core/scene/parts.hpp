#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/scene/context.hpp"
#include "core/scene/mapping.hpp"
#include "core/scene/numbers.hpp"

namespace scree::core {

// The parts of a scene, each from its node. Errors are reported; what comes back then holds what could be read.

WallUse read_wall(const Key& name, const Node& node, Context& context);
BallSet read_ball_set(const Key& name, const Node& node, Context& context);
Rule read_rule(const Node& node, size_t index, Context& context);
ProcessUse read_process(const Key& name, const Node& node, Context& context);
Quantity read_quantity(const Key& name, const Node& node, Context& context);
Stage read_stage(const Node& node, Context& context);
Record read_record(const Key& name, const Node& node, Context& context);
Expect read_expect(const Node& node, Context& context);
Cell read_cell(const Node& node, Context& context);

/// One action of a stage. Nothing when it is wrong or unknown (reported).
std::optional<Action> read_action(const Key& key, const Node& node, Context& context);
BondAction read_bond(const Node& node, Context& context);
std::optional<SetAction> read_assignment(const Key& key, const Node& node, Context& context);

std::vector<PieceProperty> read_piece_properties(const Node& node, const std::string& what, bool drawn,
                                                 Context& context);
/// A bare number of `set:` that no component owns, as the velocity of a wall.
Setting bare_setting(const std::string& name, const Place& place, std::vector<double> numbers);

/// Columns that expressions over balls may read.
const std::vector<std::string>& ball_columns();
/// A condition or term over ball columns. Null when it is wrong (reported).
std::shared_ptr<Formula> read_over_balls(const Node& node, const std::string& name, Context& context);

}  // namespace scree::core
