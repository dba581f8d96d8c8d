#pragma once
#include <string>
#include <vector>

#include "core/contact/contacts.hpp"
#include "core/run/archive.hpp"

namespace scree::core {

/// The contact lists as they lie in a file, checked against themselves: rows in range and in order, sizes that match.
struct SavedContacts {
  std::vector<std::string> rules, models;             ///< of each rule; its touch list has its index
  std::vector<std::vector<std::string>> state_names;  ///< of each rule
  std::vector<std::size_t> varying;                   ///< varying words of each rule
  std::vector<TouchList> lists;                       ///< touch lists, then bonded lists
  BreakHistory breaks;
  WallBreakHistory wall_breaks;
  std::array<uint64_t, 2> broken_bonds{};
  std::vector<WallList> wall_lists;
  std::vector<uint32_t> rows_before;
  uint64_t rows = 0;  ///< when the lists were built
  bool built = false;
};

/// Touch lists and wall lists with everything they remember, and what the next rebuild follows.
void save_contacts(const Contacts& contacts, std::size_t balls, ArchiveWriter& out);
/// `walls`: how many the file has.
SavedContacts read_contacts(const ArchiveReader& in, const Balls& balls, const PeriodicCell& cell, std::size_t walls);
/// Into contacts whose book holds the same rules. Lays out force records, which are zero afterwards.
void load_contacts(Contacts& contacts, const ArchiveReader& in, const Balls& balls, const PeriodicCell& cell,
                   std::size_t walls, Team& team);

/// The names of the state words of a rule as it runs now.
std::vector<std::string> state_names(const BoundRule& rule);

}  // namespace scree::core
