#include "core/run/event_log.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace scree::core {

namespace {
constexpr const char* file_name = "events.csv";
constexpr const char* modes[] = {"", "tension", "shear"};
}  // namespace

EventLog::EventLog(OutputFiles& files) : files_(&files) {
  const auto table = files.table();
  begun_ = std::any_of(table.begin(), table.end(), [](const FileRecord& file) { return file.name == file_name; });
}

void EventLog::take(Engine& engine) {
  if (engine.broken.empty()) return;
  std::string text;
  if (!begun_) text = "cycle,time,event,mode,rule,id1,id2,x,y,z,energy,wall\n";
  begun_ = true;
  for (const BrokenBond& bond : engine.broken)
    text += fmt::format("{},{},bond_break,{},{},{},{},{},{},{},{},{}\n", bond.cycle, bond.time,
                        modes[bond.what.mode <= 2 ? bond.what.mode : 0],
                        engine.contacts.book.rules[bond.what.rule].name, bond.what.ids.first, bond.what.ids.second,
                        bond.what.point[0], bond.what.point[1], bond.what.point[2], bond.what.energy,
                        bond.what.wall < engine.walls.size() ? engine.walls[bond.what.wall].name : "");
  files_->append(file_name, text.data(), text.size());
  engine.broken.clear();
}

}  // namespace scree::core
