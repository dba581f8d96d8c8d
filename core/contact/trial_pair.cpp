#include "core/contact/trial_pair.hpp"

namespace scree::core {

void load_trial(const BoundRule& rule, const Birth& birth, double gap, uint32_t k, Scratch& s) {
  std::vector<double> words = rule.words;
  if (!rule.varying.empty()) rule.vary(birth, words.data());
  for (std::size_t v = 0; v < rule.varying.size(); ++v) s.property[v][k] = words[rule.varying[v]];
  for (uint32_t w = 0; w < rule.state_words(); ++w) s.state[w][k] = 0;
  s.nx[k] = 1;
  s.ny[k] = s.nz[k] = s.vx[k] = s.vy[k] = s.vz[k] = 0;
  s.gap[k] = gap;
  s.r1[k] = birth.r1;
  s.r2[k] = birth.r2;
  s.mass[k] = birth.mass;
}

}  // namespace scree::core
