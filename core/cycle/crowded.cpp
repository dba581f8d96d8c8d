#include <algorithm>

#include "core/contact/closing.hpp"
#include "core/contact/holding.hpp"
#include "core/contact/links.hpp"
#include "core/cycle/engine.hpp"
#include "core/cycle/impact_share.hpp"

// The step where balls move so fast that estimates would follow each other closely: the room round each ball limits
// what can touch it.

namespace scree::core {

namespace {

constexpr uint64_t close_together = 100;  ///< cycles between estimates: below, they cost more than 3 %
constexpr uint64_t patience = 500;        ///< cycles until shallower overlaps are looked for
constexpr uint64_t asking = 1000;         ///< cycles until it is asked again whether estimates would be worth it
/// Share of the step that is given up to be rid of estimates: what one costs in cycles, lists included, over those
/// between two, and the most.
constexpr double estimate_cost = 3, most_price = 0.25;
constexpr double least_depth = 1e-4, grain = 1.1;

// Few values, so that it seldom changes.
double rounded_up(double overlap) {
  double depth = least_depth;
  while (depth < overlap) depth *= grain;
  return depth;
}

}  // namespace

// Makes the limit anew where it has grown old; whether there is one.
bool Engine::know_crowd() {
  for (const TouchList& list : contacts.lists())
    if (list.bonded && list.size() > 0) return false;
  for (const WallList& list : contacts.wall_lists())
    if (list.bonded && !list.slots.empty()) return false;
  if (crowd_use_.depth == 0 || clock.cycle - crowd_use_.since >= patience) {
    crowd_use_.depth = rounded_up(grain * largest_overlap());
    crowd_use_.since = clock.cycle;
  }
  if (!crowd_ || !crowd_->still(balls)) crowd_ = std::make_unique<Crowd>(contacts.book, balls, cell, team);
  const double damping = local_damping();
  if (crowd_->depth() != crowd_use_.depth || crowd_->local_damping() != damping)
    crowd_->take(contacts.book, balls, crowd_use_.depth, damping);
  return crowd_->unknown().empty();
}

// Would estimates allow so much more that they are worth their price? Only a look at the contacts can tell.
bool Engine::estimates_pay(const LinkQuery& links, double damping, double wanted) {
  if (clock.cycle - crowd_use_.asked < asking) return false;
  crowd_use_.asked = clock.cycle;
  crowd_use_.refused = step_holds(contacts, balls, walls, cell, links, damping, wanted, 1, team).holds ? 1 : 0;
  return crowd_use_.refused != 0;
}

std::optional<StepBound> Engine::crowded(const NetworkQuery& query, uint64_t lasted) {
  const bool fast = query.sweeps == 0 && lasted < close_together && step.automatic() && step.step() > 0;
  if (!fast || !know_crowd()) return {};
  // While the step comes from an estimate, less than this is not worth it.
  const double least = crowd_use_.rests == 0 ? step.holding() / (1 + most_price) : 0;
  if (crowd_->bound().step < least) return {};
  std::size_t wall_slots = 0;
  for (const WallList& list : contacts.wall_lists()) wall_slots += list.slots.size();
  const double ends = static_cast<double>(2 * contacts.active() + wall_slots);
  const bool few = ends < few_contacts * static_cast<double>(balls.size());
  LinkQuery links = query.links;
  links.birth_depth = birth_depth;
  links.impact_share = step.accurate ? accurate_share : few ? impact_share : 0.0;
  const Links with_walls = wall_links(contacts, balls, walls, cell, links, team);
  StepBound bound = crowd_at_walls(*crowd_, with_walls.links, balls, walls, least);
  if (bound.step == 0) return {};
  if (links.impact_share > 0) {
    if (!(crowd_->pair_step() > 0)) return {};
    bound = smaller(bound, {links.impact_share * crowd_->pair_step(), bound.ball, 0, "", "pair", false});
  }
  // For a while the estimates that were found worth their price are kept, unless the room would let the step rise.
  const bool again = clock.cycle - crowd_use_.asked >= asking || bound.step > StepControl::rise * step.holding();
  if (crowd_use_.refused != 0 && !again) return {};
  crowd_use_.refused = 0;
  // What it must give up for estimates to pay.
  const double wanted =
      bound.step * (1 + std::min(most_price, estimate_cost / static_cast<double>(std::max<uint64_t>(1, lasted))));
  if (crowd_use_.rests == 0) {  // the step of now comes from an estimate
    crowd_use_.asked = clock.cycle;
    if (wanted < step.holding()) return {};
  }
  const StepBound others = smaller(smaller(with_walls.impact, with_walls.kinematic),
                                   soonest_closing(contacts, balls, cell, birth_depth, wanted, team));
  const bool free = others.step == 0 || others.step > wanted;
  if (free && estimates_pay(links, query.local_damping, wanted)) return {};
  crowd_use_.rests = 1;
  estimated_ = "the room round each ball, for overlaps of at most " + std::to_string(crowd_use_.depth) +
               " of the radius, and " + std::to_string(with_walls.links.size()) + " contacts with walls";
  return smaller(bound, others);
}

// A deeper overlap lets more balls meet one, and makes laws stiffer that stiffen.
void Engine::watch_depth() {
  if (crowd_use_.rests == 0 || !(contacts.deepest() > crowd_use_.depth)) return;
  crowd_use_.depth = rounded_up(grain * contacts.deepest());
  crowd_use_.since = clock.cycle;
  choose_step();
}

}  // namespace scree::core
