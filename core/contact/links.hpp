#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/threads.hpp"
#include "core/contact/contacts.hpp"
#include "core/contact/step_bound.hpp"

namespace scree::core {

/// A contact as the step sees it: which rows it joins, where, and its springs and dashpots.
struct Link {
  uint32_t row[2];        ///< row[1] is no_row for a wall
  uint32_t wall;          ///< index, where row[1] is no_row
  uint32_t record;        ///< of row[1] in the slice of the block of row[0], see Slices
  double normal[3];       ///< from row[0] to the other side
  double arm[2];          ///< from each centre to the contact point, m; arm[1] is 0 for a wall
  double kn, ks, kb, kt;  ///< normal, shear, N/m; bending, twist, N m/rad
  double cn, cs;          ///< dashpots, N s/m
};

/// What is asked of the listed contacts.
struct LinkQuery {
  double margin = 0;        ///< m; pairs that this much approach may close count as touching, at the stiffness of then
  double impact_share = 0;  ///< of the limit of a pair that collides; 0: impacts are not looked at
  double birth_depth = 0;   ///< share of the smaller radius that a pair may close in one cycle; 0: not looked at
};

/// Everything about the contacts of some rows that limits the step.
struct Links {
  std::vector<Link> links;  ///< by block of rows and list, then by block and wall list
  StepBound impact, kinematic;
  bool dashpots = false, rotates = false;
};

/// All links with an end in the rows [first, last): balls and walls. The same for any number of threads.
Links gather_links(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls,
                   const PeriodicCell& cell, const LinkQuery& query, std::size_t first, std::size_t last, Team& team);

/// The links with walls alone.
Links wall_links(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls, const PeriodicCell& cell,
                 const LinkQuery& query, Team& team);

/// Links as columns, up to a batch of them; words as in Link.
struct LinkColumns {
  static constexpr std::size_t size = SCREE_BATCH;
  std::size_t count = 0;
  uint32_t row[2][size], record[size];
  double x[size], y[size], z[size];  ///< normal
  double arm[2][size], kn[size], ks[size], kb[size], kt[size], cn[size], cs[size];
  void add(const Link& link);  ///< there must be room
};

/// Takes links of pairs owned by a block of rows. Blocks come from several threads, each from one.
using LinkSink = std::function<void(std::size_t block, const LinkColumns& links)>;
/// The same over all rows, but links of pairs go batch by batch to `sink` and are not kept; those of walls are.
Links stream_links(const Contacts& contacts, const Balls& balls, const std::vector<Wall>& walls,
                   const PeriodicCell& cell, const LinkQuery& query, Team& team, const LinkSink& sink);

/// Contacts per ball: pairs that touch count for both balls, those with walls as of the last pass once.
double coordination(const Contacts& contacts, const Balls& balls, const PeriodicCell& cell);

}  // namespace scree::core
