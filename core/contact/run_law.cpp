#include "core/contact/run_law.hpp"

#include <algorithm>

#include "core/base/error.hpp"

namespace scree::core {

scree_batch batch_of(const BoundRule& rule, uint32_t n, const LawCall& call, Scratch& s, BatchColumns& columns) {
  scree_batch batch{};
  batch.struct_size = sizeof batch;
  batch.n = n;
  batch.dt = call.dt;
  batch.nx = s.nx;
  batch.ny = s.ny;
  batch.nz = s.nz;
  batch.gap = s.gap;
  batch.vx = s.vx;
  batch.vy = s.vy;
  batch.vz = s.vz;
  batch.r1 = s.r1;
  batch.r2 = s.r2;
  batch.mass = s.mass;
  batch.fx = s.fx;
  batch.fy = s.fy;
  batch.fz = s.fz;
  if (!rule.varying.empty()) {
    for (std::size_t w = 0; w < rule.words.size(); ++w) columns.property[w] = &rule.constants[w * SCREE_BATCH];
    for (std::size_t v = 0; v < rule.varying.size(); ++v) columns.property[rule.varying[v]] = s.property[v];
    batch.property = columns.property;
  }
  if (call.energy) {
    for (std::size_t e = 0; e < 4; ++e) {
      columns.energy[e] = s.energy[e];
      std::fill_n(s.energy[e], n, 0.0);
    }
    batch.energy = columns.energy;
  }
  if (rule.normal_only()) return batch;
  if (rule.needs & SCREE_NEEDS_SPIN) {
    batch.wx = s.wx;
    batch.wy = s.wy;
    batch.wz = s.wz;
  }
  if (rule.needs & SCREE_NEEDS_TURN) {
    batch.tx = s.tx;
    batch.ty = s.ty;
    batch.tz = s.tz;
  }
  if (rule.needs & SCREE_GIVES_MOMENT) {
    batch.mx = s.mx;
    batch.my = s.my;
    batch.mz = s.mz;
  }
  for (uint32_t w = 0; w < rule.memory_words(call.bonded); ++w) columns.state[w] = s.state[w];
  batch.state = columns.state;
  batch.sliding = s.sliding;
  if (call.bonded) {
    std::fill_n(s.bonded, n, uint8_t{1});
    std::fill_n(s.event, n, 0.0);
    batch.bonded = s.bonded;
    batch.event = s.event;
  }
  return batch;
}

void tangents(const BoundRule& rule, uint32_t n, bool bonded, Scratch& s, Tangents& t) {
  BatchColumns columns;
  const scree_batch batch = batch_of(rule, n, {0.0, bonded, false}, s, columns);
  std::fill_n(reinterpret_cast<double*>(&t), sizeof t / sizeof(double), 0.0);
  const scree_stiffness out{
      sizeof(scree_stiffness), n, t.normal, t.shear, t.bending, t.twist, t.ratio_normal, t.ratio_shear};
  rule.model->stiffness(rule.words.data(), &batch, &out);
  if (rule.normal_only()) std::fill_n(t.shear, n, 0.0);
}

namespace {
scree_law law_of(const BoundRule& rule, const LawCall& call) {
  if (call.bonded) return rule.bonded_law;
  return call.energy && rule.energy_law != nullptr ? rule.energy_law : rule.law;
}
}  // namespace

uint32_t run_law(const BoundRule& rule, uint32_t n, const LawCall& call, Scratch& s) {
  BatchColumns columns;
  const scree_batch batch = batch_of(rule, n, call, s, columns);
  return law_of(rule, call)(rule.words.data(), &batch);
}

uint32_t find_thrower(const BoundRule& rule, uint32_t n, const LawCall& call, Scratch& s) {
  BatchColumns columns;
  const auto next = [](auto*& column) {
    if (column != nullptr) ++column;
  };
  scree_batch batch = batch_of(rule, 1, call, s, columns);
  for (uint32_t k = 0; k < n; ++k) {
    if (law_of(rule, call)(rule.words.data(), &batch) == law_threw) return k;
    for (auto* column : {&batch.nx, &batch.ny, &batch.nz, &batch.gap, &batch.vx, &batch.vy, &batch.vz, &batch.wx,
                         &batch.wy, &batch.wz, &batch.tx, &batch.ty, &batch.tz, &batch.r1, &batch.r2, &batch.mass})
      next(*column);
    for (auto* column : {&batch.fx, &batch.fy, &batch.fz, &batch.mx, &batch.my, &batch.mz, &batch.sliding})
      next(*column);
    if (batch.property != nullptr)
      for (std::size_t w = 0; w < rule.words.size(); ++w) next(columns.property[w]);
    if (batch.state != nullptr)
      for (uint32_t w = 0; w < rule.memory_words(call.bonded); ++w) next(columns.state[w]);
  }
  return n;
}

void refuse_thrower(const BoundRule& rule, const std::string& pieces, uint64_t cycle) {
  throw Refusal(Exit::plugin, "cycle " + std::to_string(cycle) + ": contact model '" + rule.model_name + "' of rule '" +
                                  rule.name + "' threw an exception" +
                                  (pieces.empty() ? "" : " for the contact of " + pieces) +
                                  ": report it to the plug-in's author");
}

}  // namespace scree::core
