#pragma once
#include "core/plugin/catalogue.hpp"
#include "core/run/packing.hpp"
#include "core/scene/scene.hpp"

namespace scree::core {

// What the scene's words are now: after `set`, `add` and `delete` they are no longer those of the file.

void pack(Packer& out, const Use& use);
void pack(Packer& out, const Rule& rule);
void pack(Packer& out, const BallSet& set);

/// Opens the plug-ins that the words name and compiles their formulas anew.
struct UseReader {
  Unpacker& in;
  Catalogue& catalogue;
  const std::map<std::string, double>& vars;

  Use use(Kind kind);
  Rule rule();
  BallSet ball_set();

 private:
  Place place();
  Setting setting(const Component& component);
  Value value(const scree_property& property);
  PieceProperty piece();
  std::shared_ptr<Formula> formula(const Place& at);
  std::shared_ptr<Distribution> drawn();
};

}  // namespace scree::core
