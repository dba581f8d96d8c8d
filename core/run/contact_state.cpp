#include "core/run/contact_state.hpp"

#include <algorithm>

#include "core/run/section_check.hpp"
#include "core/run/wall_list_state.hpp"

namespace scree::core {

namespace {

std::string section_of(std::size_t list, const std::string& what) {
  return "contacts/" + std::to_string(list) + "/" + what;
}

template <class T>
std::span<const T> view(const Array<T>& values) {
  return {values.data(), values.size()};
}

template <class T>
Array<T> read_array(const ArchiveReader& in, const std::string& section, uint64_t count) {
  const std::vector<T> values = in.get<T>(section, count);
  Array<T> out;
  out.resize_for_overwrite(values.size());
  std::copy(values.begin(), values.end(), out.data());
  return out;
}

void save_list(const TouchList& list, std::size_t index, ArchiveWriter& out) {
  out.put(section_of(index, "begin"), view(list.begin));
  out.put(section_of(index, "other"), view(list.other));
  out.put(section_of(index, "where"), view(list.where));
  out.put(section_of(index, "active"), view(list.active));
  if (list.bonded) out.put(section_of(index, "broken"), view(list.broken));
  out.put(section_of(index, "dashpot"), view(list.dashpot));
  out.put(section_of(index, "words"),
          std::vector<uint64_t>{list.state.size(), list.property.size(), list.stale ? 1u : 0u});
  for (std::size_t w = 0; w < list.state.size(); ++w)
    out.put(section_of(index, "state/" + std::to_string(w)), view(list.state[w]));
  for (std::size_t v = 0; v < list.property.size(); ++v)
    out.put(section_of(index, "property/" + std::to_string(v)), view(list.property[v]));
}

void check_rows(const TouchList& list, std::size_t index, const ArchiveReader& in, uint64_t rows) {
  const std::string begin = section_of(index, "begin"), other = section_of(index, "other");
  want(list.begin[0] == 0 && list.begin[rows] == list.other.size(), in, begin, "it does not span the list");
  for (uint64_t row = 0; row < rows; ++row)
    want(list.begin[row] <= list.begin[row + 1], in, begin, "it does not ascend");
  for (uint64_t row = 0; row < rows; ++row)
    for (uint64_t slot = list.begin[row]; slot < list.begin[row + 1]; ++slot) {
      const bool ascends = slot == list.begin[row] || list.other[slot] > list.other[slot - 1];
      want(list.other[slot] > row && list.other[slot] < rows && ascends, in, other, "a row is out of range or order");
    }
}

// The pass trusts the image code and the flip bit; both say nothing new, so they can be checked.
void check_where(const TouchList& list, std::size_t index, const ArchiveReader& in, const uint64_t* id,
                 const PeriodicCell& cell) {
  const std::string section = section_of(index, "where");
  for (std::size_t row = 0; row + 1 < list.begin.size(); ++row)
    for (uint64_t slot = list.begin[row]; slot < list.begin[row + 1]; ++slot) {
      const uint32_t word = list.where[slot], image = target::image(word);
      for (int axis = 0; axis < 3; ++axis) {
        const uint32_t code = (image >> (2 * axis)) & 3u;
        want(code < 3 && (code == 0 || cell.periodic[axis]), in, section, "a periodic image does not exist");
      }
      if (id != nullptr)
        want(((word & target::flip) != 0) == (id[row] > id[list.other[slot]]), in, section,
             "the orientation of a pair is wrong");
    }
}

TouchList read_list(const ArchiveReader& in, std::size_t index, uint64_t rows, std::size_t rules) {
  TouchList list;
  list.rule = static_cast<uint16_t>(index % rules);
  list.bonded = index >= rules;
  const auto words = in.get<uint64_t>(section_of(index, "words"), 3);
  want(words[0] <= Scratch::state_words && words[1] <= 2 * Scratch::state_words && words[2] <= 1, in,
       section_of(index, "words"), "a law has more words than this version can hold");
  list.begin = read_array<uint64_t>(in, section_of(index, "begin"), ArchiveReader::any_count);
  list.other = read_array<uint32_t>(in, section_of(index, "other"), ArchiveReader::any_count);
  want(list.begin.size() == rows + 1 || (list.begin.empty() && list.other.empty()), in, section_of(index, "begin"),
       "its size differs from the number of rows");
  const std::size_t slots = list.size();
  list.where = read_array<uint32_t>(in, section_of(index, "where"), slots);
  list.active = read_array<uint8_t>(in, section_of(index, "active"), slots);
  want(std::all_of(list.active.begin(), list.active.end(), [](uint8_t a) { return a <= 1; }), in,
       section_of(index, "active"), "a flag is neither 0 nor 1");
  if (list.bonded) {
    list.broken = read_array<uint8_t>(in, section_of(index, "broken"), slots);
    want(std::all_of(list.broken.begin(), list.broken.end(), [](uint8_t mode) { return mode <= 2; }), in,
         section_of(index, "broken"), "there is no such way to break");
  }
  for (uint64_t w = 0; w < words[0]; ++w)
    list.state.push_back(read_array<double>(in, section_of(index, "state/" + std::to_string(w)), slots));
  for (uint64_t v = 0; v < words[1]; ++v)
    list.property.push_back(read_array<double>(in, section_of(index, "property/" + std::to_string(v)), slots));
  list.dashpot = read_array<double>(in, section_of(index, "dashpot"), ArchiveReader::any_count);
  want(list.dashpot.size() == 0 || list.dashpot.size() == slots, in, section_of(index, "dashpot"),
       "its size differs from the number of contacts");
  list.stale = words[2] != 0;
  if (!list.begin.empty()) check_rows(list, index, in, rows);
  return list;
}

// Lists that are in use must have the words of their rule; before a rebuild they may still have those of the old one.
void check_words(const SavedContacts& saved, const RuleBook& book, const ArchiveReader& in) {
  for (std::size_t k = 0; k < saved.rules.size(); ++k)
    want(saved.rules[k] == book.rules[k].name && saved.models[k] == book.rules[k].model_name, in, "contacts/rules",
         "the rules are not those of the scene");
  for (std::size_t k = 0; k < saved.lists.size(); ++k) {
    const TouchList& list = saved.lists[k];
    const BoundRule& rule = book.rules[list.rule];
    if (list.bonded && list.size() == 0) continue;
    want(!list.bonded || rule.can_bond(), in, section_of(k, "words"), "the rule's law makes no bonds");
    if (!saved.built || rule.model == nullptr) continue;
    want(!list.begin.empty() && list.state.size() == rule.memory_words(list.bonded) &&
             list.property.size() == rule.varying.size(),
         in, section_of(k, "words"), "they are not those of the rule's law");
  }
  for (const WallList& list : saved.wall_lists) {
    const BoundRule& rule = book.rules[list.rule];
    want(!saved.built || rule.model == nullptr ||
             (list.state.size() == list.slots.size() * rule.memory_words(list.bonded) &&
              list.property.size() == list.slots.size() * rule.varying.size()),
         in, "wall_lists/words", "they are not those of the rule's law");
    want(!saved.built || rule.model != nullptr, in, "wall_lists/rule", "a rule without a law has contacts");
    want(!list.bonded || rule.can_bond(), in, "wall_lists/rule", "the rule's law makes no bonds");
  }
}

}  // namespace

std::vector<std::string> state_names(const BoundRule& rule) {
  std::vector<std::string> names;
  if (rule.state_words() == 0) return names;
  for (uint32_t k = 0; k < rule.model->state_count; ++k) {
    const scree_state_word& word = rule.model->states[k];
    names.push_back(std::string(word.name) + ":" + std::to_string(word.word) + ":" + std::to_string(word.words));
  }
  return names;
}

namespace {

void save_breaks(const Contacts& contacts, ArchiveWriter& out) {
  std::vector<uint64_t> ids;
  std::vector<uint32_t> counts;
  for (const auto& [pair, count] : contacts.breaks) {
    ids.insert(ids.end(), {pair.first, pair.second});
    counts.push_back(count);
  }
  out.put("bonds/pairs", ids);
  out.put("bonds/breaks", counts);
  std::vector<uint64_t> walls;
  for (const auto& [spot, count] : contacts.wall_breaks)
    walls.insert(walls.end(), {spot.id, spot.wall, spot.patch, count});
  out.put("bonds/walls", walls);
  out.put("bonds/broken", std::vector<uint64_t>(contacts.broken_bonds.begin(), contacts.broken_bonds.end()));
}

void read_breaks(const ArchiveReader& in, std::size_t wall_count, SavedContacts& saved) {
  const auto counts = in.get<uint32_t>("bonds/breaks");
  const auto ids = in.get<uint64_t>("bonds/pairs", 2 * counts.size());
  const auto broken = in.get<uint64_t>("bonds/broken", 2);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    want(ids[2 * k] < ids[2 * k + 1] && counts[k] > 0, in, "bonds/pairs", "a pair or its count makes no sense");
    saved.breaks[{ids[2 * k], ids[2 * k + 1]}] = counts[k];
  }
  const auto walls = in.get<uint64_t>("bonds/walls");
  want(walls.size() % 4 == 0, in, "bonds/walls", "an entry is cut short");
  for (std::size_t k = 0; k < walls.size(); k += 4) {
    want(walls[k + 1] < wall_count && walls[k + 2] < no_row && walls[k + 3] > 0 && walls[k + 3] < no_row, in,
         "bonds/walls", "a wall, a patch or its count makes no sense");
    saved.wall_breaks[{walls[k], static_cast<uint16_t>(walls[k + 1]), static_cast<uint32_t>(walls[k + 2])}] =
        static_cast<uint32_t>(walls[k + 3]);
  }
  saved.broken_bonds = {broken[0], broken[1]};
}

}  // namespace

void save_contacts(const Contacts& contacts, std::size_t balls, ArchiveWriter& out) {
  const std::vector<TouchList>& lists = contacts.lists();
  std::vector<std::string> rules, models;
  uint64_t rows = contacts.built() ? balls : 0;
  const std::size_t count = lists.size() / 2;
  for (std::size_t k = 0; k < count; ++k) {
    rules.push_back(contacts.book.rules[k].name);
    models.push_back(contacts.book.rules[k].model_name);
  }
  for (const TouchList& list : lists)
    if (!list.begin.empty()) rows = list.begin.size() - 1;
  out.put_texts("contacts/rules", rules);
  out.put_texts("contacts/models", models);
  out.put("contacts/shape", std::vector<uint64_t>{contacts.built() ? 1u : 0u, rows});
  out.put("contacts/rows_before", contacts.rows_before());
  for (std::size_t k = 0; k < count; ++k) {
    out.put_texts(section_of(k, "state_names"), state_names(contacts.book.rules[k]));
    out.put_value<uint64_t>(section_of(k, "varying"), contacts.book.rules[k].varying.size());
  }
  for (std::size_t k = 0; k < lists.size(); ++k) save_list(lists[k], k, out);
  save_breaks(contacts, out);
  save_wall_lists(contacts.wall_lists(), out);
}

SavedContacts read_contacts(const ArchiveReader& in, const Balls& balls, const PeriodicCell& cell, std::size_t walls) {
  SavedContacts saved;
  saved.rules = in.get_texts("contacts/rules");
  saved.models = in.get_texts("contacts/models");
  want(saved.rules.size() == saved.models.size() && saved.rules.size() < no_rule, in, "contacts/models",
       "its size differs from that of 'contacts/rules'");
  const auto shape = in.get<uint64_t>("contacts/shape", 2);
  saved.built = shape[0] != 0;
  saved.rows = shape[1];
  want(shape[0] <= 1 && saved.rows < no_row && (!saved.built || saved.rows == balls.size()), in, "contacts/shape",
       "the lists were built for another number of balls");
  saved.rows_before = in.get<uint32_t>("contacts/rows_before");
  want(saved.rows_before.empty() || (!saved.built && saved.rows_before.size() <= balls.size()), in,
       "contacts/rows_before", "it does not fit the balls");
  for (uint32_t row : saved.rows_before) want(row < saved.rows, in, "contacts/rows_before", "a row is out of range");
  for (std::size_t k = 0; k < saved.rules.size(); ++k) {
    saved.state_names.push_back(in.get_texts(section_of(k, "state_names")));
    saved.varying.push_back(static_cast<std::size_t>(in.get_value<uint64_t>(section_of(k, "varying"))));
  }
  for (std::size_t k = 0; k < 2 * saved.rules.size(); ++k) {
    saved.lists.push_back(read_list(in, k, saved.rows, saved.rules.size()));
    check_where(saved.lists[k], k, in, saved.built ? balls.id() : nullptr, cell);
  }
  read_breaks(in, walls, saved);
  saved.wall_lists = read_wall_lists(in, {saved.rows, saved.rules.size(), walls});
  return saved;
}

void load_contacts(Contacts& contacts, const ArchiveReader& in, const Balls& balls, const PeriodicCell& cell,
                   std::size_t walls, Team& team) {
  SavedContacts saved = read_contacts(in, balls, cell, walls);
  const std::size_t rules = contacts.book.rules.size();
  want(saved.built ? saved.rules.size() == rules : saved.rules.size() <= rules, in, "contacts/rules",
       "it holds another number of rules than were set up");
  check_words(saved, contacts.book, in);
  contacts.breaks = std::move(saved.breaks);
  contacts.wall_breaks = std::move(saved.wall_breaks);
  contacts.broken_bonds = saved.broken_bonds;
  contacts.restore(std::move(saved.lists), std::move(saved.wall_lists), std::move(saved.rows_before), saved.built,
                   balls.size(), team);
}

}  // namespace scree::core
