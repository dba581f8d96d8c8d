#include <algorithm>
#include <sstream>

#include "core/scene/parts.hpp"
#include "core/scene/use.hpp"

namespace scree::core {
namespace {

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> parts;
  std::istringstream stream(path);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
}

class Assignment {
 public:
  Assignment(const Key& key, const Node& node, Context& context)
      : key_(key), node_(node), context_(context), parts_(split(key.text)) {}

  std::optional<SetAction> read() {
    if (key_.text == "timestep") return timestep();
    const std::vector<std::string> roots = {"contacts", "walls", "processes", "balls", "timestep"};
    const std::string root = parts_.empty() ? "" : parts_[0];
    if (std::find(roots.begin(), roots.end(), root) == roots.end())
      return refuse("'" + key_.text.substr(0, 60) + "' cannot be set" + suggestion(root, roots) +
                    "  (contacts.RULE.property, walls.NAME.velocity, processes.NAME.property, balls.NAME.velocity, "
                    "timestep)");
    if (parts_.size() < 3) return refuse("'" + key_.text + "' wants a name and a key, as in " + root + ".NAME.KEY");
    action_.name = parts_[1];
    if (root == "contacts") return component(SetAction::Target::rule, "rule", context_.rules);
    if (root == "processes") return component(SetAction::Target::process, "process", context_.processes);
    if (root == "walls") return wall();
    action_.target = SetAction::Target::balls;
    if (parts_.size() > 4) return refuse("'" + key_.text + "' is not the path of a ball set");
    if (parts_.size() == 4) action_.name += "." + parts_[2];
    return motion(parts_.back(), {"velocity", "spin"});
  }

 private:
  std::nullopt_t refuse(const std::string& why) {
    context_.report.error(key_.spot.place(), why);
    return std::nullopt;
  }

  std::optional<SetAction> timestep() {
    action_.target = SetAction::Target::timestep;
    action_.key = "timestep";
    const bool automatic = node_.is_scalar() && (node_.text == "automatic" || node_.text == "accurate");
    const auto value = automatic ? std::optional<double>(node_.text == "accurate" ? -1.0 : 0.0)
                                 : read_plain(node_, {"timestep", "s"}, context_);
    if (!value) return std::nullopt;
    if (!automatic && !(*value > 0)) {
      context_.report.error(node_.place(), "'timestep' must be above 0 s, not " + describe(node_));
      return std::nullopt;
    }
    action_.setting = bare_setting("timestep", node_.place(), {*value});
    return action_;
  }

  std::optional<SetAction> component(SetAction::Target target, const std::string& what,
                                     const std::map<std::string, Known>& known) {
    action_.target = target;
    const auto found = known.find(action_.name);
    if (found == known.end()) {
      std::vector<std::string> names;
      for (const auto& [name, entry] : known) names.push_back(name);
      return refuse("no " + what + " '" + action_.name + "' at this point of the scene" +
                    suggestion(action_.name, names));
    }
    const Component& owner = *found->second.component;
    action_.key = parts_[2];
    const scree_property* property = parts_.size() == 3 ? find_property(owner, action_.key) : nullptr;
    if (!property) {
      const std::vector<std::string> names = property_names(owner);
      const std::string rest = key_.text.substr(parts_[0].size() + parts_[1].size() + 2);
      return refuse(std::string(owner.kind == Kind::contact_model ? "contact model" : kind_name(owner.kind)) + " '" +
                    owner.name + "' of '" + action_.name + "' has no '" + rest + "'" + suggestion(rest, names) + "  (" +
                    list_of(names) + ")");
    }
    if (found->second.form && property->forms && !(property->forms >> *found->second.form & 1u))
      return refuse("rule '" + action_.name + "' is given by '" + owner.contact_model().forms[*found->second.form] +
                    "': set one of these instead of '" + action_.key + "'");
    auto setting = read_setting(owner, {action_.key, key_.spot}, node_, context_);
    if (!setting) return std::nullopt;
    action_.setting = std::move(*setting);
    return action_;
  }

  std::optional<SetAction> wall() {
    action_.target = SetAction::Target::wall;
    if (parts_.size() == 3) return motion(parts_[2], {"velocity", "spin", "position"});
    if (parts_.size() != 4 || parts_[2] != "contact")
      return refuse("'" + key_.text + "' cannot be set  (walls.NAME.velocity, .spin, .position, .contact.PROPERTY)");
    action_.target = SetAction::Target::wall_contact;
    action_.key = parts_[3];
    Wanted wanted{action_.key, ""};
    wanted.infinity = true;
    const auto number = read_number(node_, wanted, context_);
    if (!number) return std::nullopt;
    action_.unit = number->unit;
    action_.setting = bare_setting(action_.key, node_.place(), {number->value});
    return action_;
  }

  std::optional<SetAction> motion(const std::string& key, const std::vector<std::string>& allowed) {
    if (std::find(allowed.begin(), allowed.end(), key) == allowed.end())
      return refuse("'" + key + "' of " + parts_[0] + " cannot be set" + suggestion(key, allowed) + "  (" +
                    list_of(allowed) + ")");
    action_.key = key;
    const std::string unit = key == "velocity" ? "m/s" : key == "spin" ? "rad/s" : "m";
    const auto value = read_triple(node_, {key, unit}, context_);
    if (!value) return std::nullopt;
    action_.setting = bare_setting(key, node_.place(), {(*value)[0], (*value)[1], (*value)[2]});
    return action_;
  }

  const Key& key_;
  const Node& node_;
  Context& context_;
  std::vector<std::string> parts_;
  SetAction action_;
};

}  // namespace

std::optional<SetAction> read_assignment(const Key& key, const Node& node, Context& context) {
  return Assignment(key, node, context).read();
}

}  // namespace scree::core
