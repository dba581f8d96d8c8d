#include "core/cycle/process.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace scree::core {

bool Process::needs(uint32_t column) const {
  for (uint32_t k = 0; k < table->need_count; ++k)
    if (table->needs[k].column == column && (table->needs[k].access & SCREE_OPTIONAL) == 0) return true;
  return false;
}

std::vector<const Process*> row_order(const std::vector<Process>& processes, bool adding) {
  std::vector<const Process*> order;
  for (const Process& process : processes)
    if (process.has_rows() && process.adds() == adding) order.push_back(&process);
  std::sort(order.begin(), order.end(), [](const Process* a, const Process* b) { return a->name < b->name; });
  return order;
}

ProcessHost::ProcessHost(Balls& balls, std::vector<Wall>& walls) : balls_(balls), walls_(walls) {
  host_ = {sizeof(scree_host), 0, this, wall, wall_view, publish, column, ids, read, bond};
}

void ProcessHost::fill_views() {
  views_.assign(walls_.size(), {});
  stiffness_known_.assign(walls_.size(), 0);
  for (std::size_t k = 0; k < walls_.size(); ++k) {
    const Wall& w = walls_[k];
    scree_wall_view& view = views_[k];
    view.struct_size = sizeof view;
    view.contacts = static_cast<uint32_t>(w.contacts);
    view.area = w.table->area != nullptr ? w.table->area(w.geometry.get()) : 0;
    for (std::size_t c = 0; c < 3; ++c) {
      view.force[c] = w.force[c];
      view.moment[c] = w.moment[c];
      view.position[c] = w.centre[c];
      view.velocity[c] = w.velocity[c];
      view.spin[c] = w.spin[c];
    }
  }
}

void ProcessHost::take_views() {
  for (std::size_t k = 0; k < views_.size() && k < walls_.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      walls_[k].velocity[c] = views_[k].velocity[c];
      walls_[k].spin[c] = views_[k].spin[c];
    }
}

const Wall* ProcessHost::spoilt_wall() const {
  for (std::size_t k = 0; k < views_.size() && k < walls_.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c)
      if (!std::isfinite(views_[k].velocity[c]) || !std::isfinite(views_[k].spin[c])) return &walls_[k];
  return nullptr;
}

int ProcessHost::wall(void* self, const char* name, uint32_t* handle) {
  const auto& walls = static_cast<ProcessHost*>(self)->walls_;
  for (std::size_t k = 0; k < walls.size(); ++k)
    if (walls[k].name == name) {
      *handle = static_cast<uint32_t>(k);
      return 1;
    }
  return 0;
}

scree_wall_view* ProcessHost::wall_view(void* self, uint32_t handle) {
  auto& host = *static_cast<ProcessHost*>(self);
  if (host.views_.size() != host.walls_.size()) host.fill_views();
  if (handle >= host.views_.size()) return nullptr;
  if (host.stiffness_known_[handle] == 0) host.views_[handle].stiffness = host.wall_stiffness(handle);
  host.stiffness_known_[handle] = 1;
  return &host.views_[handle];
}

void ProcessHost::listen_to(const std::string& process, bool prepares) {
  prefix_ = "processes." + process + ".";
  prepares_ = prepares;
}

void ProcessHost::publish(void* self, const char* quantity, double value) {
  auto& host = *static_cast<ProcessHost*>(self);
  if (host.prepares_)
    host.published.try_emplace(host.prefix_ + quantity, value);
  else
    host.published[host.prefix_ + quantity] = value;
}

std::vector<BondRequest> ProcessHost::take_bonds() { return std::exchange(bonds_, {}); }

int ProcessHost::bond(void* self, const char* rule, double gap, int again) {
  auto& host = *static_cast<ProcessHost*>(self);
  if (!host.can_bond(rule) || !(gap >= 0) || !std::isfinite(gap)) return 0;
  if (!host.prepares_) host.bonds_.push_back({rule, gap, again != 0});
  return 1;
}

const double* ProcessHost::column(void* self, uint32_t column, uint32_t component, uint64_t* rows) {
  Balls& balls = static_cast<ProcessHost*>(self)->balls_;
  *rows = balls.size();
  const auto from = [&](Column first) { return balls[static_cast<Column>(static_cast<uint32_t>(first) + component)]; };
  if (component > 2) return nullptr;
  switch (column) {
    case SCREE_POSITION:
      return from(Column::x);
    case SCREE_VELOCITY:
      return from(Column::vx);
    case SCREE_SPIN:
      return from(Column::wx);
    case SCREE_RADIUS:
      return component == 0 ? balls[Column::radius] : nullptr;
    case SCREE_MASS:
      return component == 0 ? balls[Column::mass] : nullptr;
    default:
      return nullptr;
  }
}

const uint64_t* ProcessHost::ids(void* self, uint64_t* rows) {
  const Balls& balls = static_cast<ProcessHost*>(self)->balls_;
  *rows = balls.size();
  return balls.id();
}

int ProcessHost::read(void* self, const char* quantity, double* value) {
  const auto& published = static_cast<ProcessHost*>(self)->published;
  const auto found = published.find(quantity);
  if (found == published.end()) return 0;
  *value = found->second;
  return 1;
}

}  // namespace scree::core
