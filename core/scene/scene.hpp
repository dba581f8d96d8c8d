#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/error.hpp"
#include "core/plugin/catalogue.hpp"
#include "core/scene/distribution.hpp"
#include "core/scene/formula.hpp"

namespace scree::core {

using Triple = std::array<double, 3>;

/// A value in SI units, as scree_value carries it.
struct Value {
  uint32_t type = 0;            ///< SCREE_NUMBER, ...
  std::vector<double> numbers;  ///< rows x columns
  uint32_t rows = 0, columns = 0;
  std::vector<std::string> texts;
};

/// One property of a component, set by the scene. A number may be a formula over position (x, y, z) instead, or drawn.
struct Setting {
  std::string name;
  uint32_t property = 0;  ///< index in the component's table
  Value value;
  std::shared_ptr<Formula> formula;  ///< null unless the value is an expression that depends on x, y or z
  Place place;
  std::shared_ptr<Distribution> drawn{};  ///< null unless each contact draws its value
};

/// A component with its settings. Fallbacks are not filled in: absent means absent.
struct Use {
  const Component* component = nullptr;
  std::vector<Setting> settings;
  uint32_t form = 0;  ///< contact model: which alternative input form the settings chose
  Place place;
};

/// A contact property given on a piece (`contact:` of balls or walls); matched by name when a rule mixes.
struct PieceProperty {
  std::string name;
  double value = 0;
  std::string unit;  ///< as written, "" for plain SI; checked against the law's unit when a rule uses it
  std::shared_ptr<Formula> formula;
  Place place;
  std::shared_ptr<Distribution>
      drawn{};  ///< null unless each ball draws its value; cut to the laws' range by the check
};

struct BallSet {
  std::string name;
  Use generator;
  std::optional<double> density;  ///< kg/m3
  std::vector<PieceProperty> contact;
  bool fixed = false;
  std::optional<Triple> velocity, spin;  ///< m/s, rad/s
  Place place;
};

struct WallUse {
  std::string name;
  Use wall;
  Triple velocity{}, spin{};     ///< m/s, rad/s
  std::optional<Triple> centre;  ///< of rotation, m
  std::vector<PieceProperty> contact;
  Place place;
};

/// Which law for which pair: the first rule that fits wins.
struct Rule {
  std::string name;
  std::array<std::vector<std::string>, 2>
      between;        ///< names of ball sets, sub-groups (`sand.fine`), walls, or `balls`, `walls`
  bool none = false;  ///< `model: none`: these pairs do not interact
  Use model;
  Place place;
};

struct ProcessUse {
  std::string name;
  Use process;
  Place place;
};

/// A named number. Either an expression over published quantities, or a reduction over balls.
struct Quantity {
  std::string name;
  std::shared_ptr<Formula> formula;  ///< plain form
  std::string reduction;             ///< "sum", "min", "max", "mean", "count", or "" for the plain form
  std::string over;                  ///< group; "balls" for all
  std::shared_ptr<Formula> each,
      where;  ///< over x y z vx vy vz wx wy wz radius mass volume speed id contacts; may be null
  Place place;
};

/// A length of run: by model time or by cycles.
struct Span {
  std::optional<double> time;  ///< s
  std::optional<uint64_t> cycles;
};

/// A test that ends a run.
struct Until {
  enum class Test { below, above, falls_to, rises_to };
  std::shared_ptr<Formula> quantity;  ///< over quantities
  Test test =
      Test::below;  ///< falls_to: at or below `value` times the largest seen so far; rises_to: times the smallest
  double value = 0;
  Place place;
};

struct Name {
  std::string text;
  Place place;
};

struct AddAction {
  std::vector<WallUse> walls;
  std::vector<BallSet> balls;
  std::vector<Rule> contacts;
  std::vector<ProcessUse> processes;
};
/// One assignment of `set:`; the path is taken apart and checked against what it names.
struct SetAction {
  enum class Target { rule, wall, wall_contact, balls, process, timestep } target = Target::rule;
  std::string name;  ///< of the rule, wall, process, ball set or sub-group
  std::string key;   ///< property; walls: velocity, spin, position; balls: velocity, spin
  std::string unit;  ///< wall_contact: as for PieceProperty
  Setting setting;   ///< of the component (rule, process), or a bare value; timestep 0: automatic again, -1: accurate
};
struct DeleteAction {
  std::string what;
  Name name;
  std::shared_ptr<Formula> where;
};  ///< what: walls, balls, contacts, processes
struct FixAction {
  bool fix = true;
  Name balls;
  std::array<bool, 3> velocity{true, true, true}, spin{true, true, true};
  std::shared_ptr<Formula> where;
};
struct ApplyAction {
  Name balls;
  Triple force{}, moment{};
  std::shared_ptr<Formula> where;
};  ///< N, N m, on each ball, until applied anew
/// Bonds the pairs of a rule that are near enough.
struct BondAction {
  Name rule;
  double gap = 0;                            ///< m; pairs with at most this gap
  bool again = true;                         ///< also pairs whose bond broke
  std::array<std::vector<Name>, 2> between;  ///< groups; empty: all pairs of the rule
};
struct RunAction {
  enum class Word { run, cycle, solve } word = Word::run;
  Span length;               ///< empty: no limit (only with `until`)
  std::vector<Until> until;  ///< any of them ends the run
};
/// What a numerical stop calls the state it saves; no `save` may have that name.
inline constexpr const char* stopped_state = "stopped";
struct SaveAction {
  Name name;
};
struct Action {
  std::variant<AddAction, SetAction, DeleteAction, FixAction, ApplyAction, BondAction, RunAction, SaveAction> what;
  Place place;
};
struct Stage {
  std::string name;
  std::vector<Action> actions;
  Place place;
};

struct Record {
  std::string name;
  Use writer;
  Span every;
  std::vector<std::shared_ptr<Formula>> quantities;  ///< text() is what the scene wrote
  std::vector<Name> fields;                          ///< ball and contact fields
  Place place;
};

struct Expect {
  std::shared_ptr<Formula> quantity;
  std::optional<double> low, high;          ///< inclusive
  std::optional<double> equals, tolerance;  ///< |quantity - equals| <= tolerance
  std::string source;                       ///< where the expected value comes from, for the report
  std::string text;                         ///< the expectation as the scene wrote it
  Place place;
};

struct Cell {
  Triple low{}, high{};
  std::array<bool, 3> periodic{};
  Place place;
};

struct Scene {
  std::string file, title;
  uint64_t seed = 1;
  std::map<std::string, double> vars;
  std::optional<Cell> cell;
  std::optional<double> timestep;  ///< s; absent: automatic
  Place timestep_place;
  bool accurate = false;  ///< automatic, with collisions resolved three times as finely
  bool unsafe = false;
  std::optional<double> skin;  ///< m; absent: chosen from the radii
  double overlap_limit = 0.5;  ///< of the smaller radius
  std::vector<WallUse> walls;
  std::vector<BallSet> balls;
  std::vector<Rule> contacts;
  std::vector<ProcessUse> processes;
  std::vector<Quantity> quantities;
  std::vector<Stage> stages;
  std::vector<Record> record;
  std::vector<Expect> expect;
  std::optional<Name> start_state;    ///< `start: {state: other.out/packed}`
  std::string resolved;               ///< the scene after include and --set, as YAML that reads back to the same scene
  std::vector<std::string> warnings;  ///< each "file:line:column: warning: ..."
};

struct ReadOptions {
  std::string file;                                      ///< path, or "" with text
  std::string text;                                      ///< scene given directly (tests, demo)
  std::vector<std::pair<std::string, std::string>> set;  ///< --set a.b=c, in order
  std::vector<std::string> include_dirs;                 ///< besides the scene's folder: the installed configs
};

/// Reads, checks and resolves a scene. Every error of the file is collected; throws SceneErrors (exit 3), or Refusal
/// (exit 4) when a named plug-in is missing. [one thread]
Scene read_scene(const ReadOptions& options, Catalogue& catalogue);

/// All errors of a scene, each "file:line:column: error: ..."; what() joins them by newlines.
class SceneErrors : public Refusal {
 public:
  explicit SceneErrors(std::vector<std::string> errors);
  const std::vector<std::string>& errors() const { return errors_; }

 private:
  std::vector<std::string> errors_;
};

}  // namespace scree::core
