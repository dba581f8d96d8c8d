#include "core/run/bound_state.hpp"

#include <cmath>

#include "core/run/packing.hpp"

namespace scree::core {

void save_bound(const RuleBook& book, ArchiveWriter& out) {
  Packer packer;
  packer.u64(book.rules.size());
  for (const BoundRule& rule : book.rules) {
    packer.u64(rule.words.size());
    packer.f64s(rule.words.data(), rule.words.size());
    packer.u64(rule.varying.size());
    for (uint32_t word : rule.varying) packer.u64(word);
    packer.f64(rule.reach);
    packer.u64(rule.needs);
  }
  out.put("rules/bound", packer.bytes());
}

void load_bound(RuleBook& book, const ArchiveReader& archive) {
  Unpacker in(archive, "rules/bound");
  if (in.count() != book.rules.size()) in.refuse("it holds another number of rules than the scene");
  for (BoundRule& rule : book.rules) {
    if (in.count() != rule.words.size()) in.refuse("rule '" + rule.name + "' has another number of words");
    in.f64s(rule.words.data(), rule.words.size());
    rule.varying.clear();
    for (uint64_t left = in.count(); left > 0; --left) {
      const uint64_t word = in.u64();
      if (word >= rule.words.size() || (!rule.varying.empty() && word <= rule.varying.back()))
        in.refuse("a word of rule '" + rule.name + "' is out of range or order");
      rule.varying.push_back(static_cast<uint32_t>(word));
    }
    rule.reach = in.f64();
    if (!(rule.reach >= 0 && std::isfinite(rule.reach))) in.refuse("the reach of rule '" + rule.name + "' is wrong");
    const uint64_t needs = in.u64(), can = rule.model == nullptr ? 0 : rule.model->flags | SCREE_NORMAL_ONLY;
    if ((needs & ~can) != 0 || ((needs & SCREE_NORMAL_ONLY) != 0 && rule.model->normal_only[0] == nullptr))
      in.refuse("rule '" + rule.name + "' needs what its law does not have");
    rule.needs = static_cast<uint32_t>(needs);
  }
  in.finish();
}

}  // namespace scree::core
