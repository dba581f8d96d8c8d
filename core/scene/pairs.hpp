#pragma once
#include <map>
#include <string>
#include <vector>

#include "core/scene/context.hpp"

namespace scree::core {

/// What exists at a point of the scene.
struct Live {
  std::map<std::string, const WallUse*> walls;
  std::map<std::string, const BallSet*> balls;
  std::map<std::string, const ProcessUse*> processes;
  std::vector<const Rule*> rules;
};

/// "sand" of "sand.fine": sub-groups exist only after generation.
std::string set_of(const std::string& group);

/// Reports walls and pairs that no rule covers, and warns of pieces that touch nothing. A rule for a sub-group counts
/// for the pairs of its set; what it leaves open is found at set-up.
void pairs_have_rules(const Live& live, bool open, Context& context);

/// Whether any pair reaches a rule, and the earlier ones that take its pairs otherwise.
struct RuleUse {
  bool reached = false;
  std::vector<const Rule*> before;
};
using RuleUses = std::vector<std::pair<const Rule*, RuleUse>>;
/// Looks at the rules as they stand now and adds what it finds; a rule counts as reached once it ever was. Where pieces
/// are not known (`open`), nothing is said.
void rules_in_use(const Live& live, bool open, RuleUses& uses);

/// Reports properties that neither a rule nor its pieces give, and those of pieces that no law knows.
void pieces_meet_laws(Scene& scene, bool open, Context& context);

}  // namespace scree::core
