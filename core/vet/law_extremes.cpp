#include <algorithm>
#include <limits>

#include "core/base/log.hpp"
#include "core/vet/law_checks.hpp"

namespace scree::core::vet {

namespace {

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Contacts that a run may meet on a bad day: no overlap at all, a whole radius of it, motion far too fast, none.
std::vector<Seen> hard_contacts(const Case& c) {
  const double radius = c.r2 > 0 ? std::min(c.r1, c.r2) : c.r1;
  Numbers random(7);
  std::vector<Seen> list;
  for (const double gap :
       {0.0, -0.0, -5e-324, -1e-300, -1e-30, -1e-9 * radius, -0.1 * radius, -0.999 * radius, c.reach})
    for (const double speed : {0.0, 5e-324, 1e-200, 1e-3, 1e4})
      for (const double angle : {0.0, 1e-300, 1.0}) {
        Seen s = c.seen();
        s.normal = list.size() % 5 == 0 ? Vec3{0, 0, list.size() % 2 == 0 ? 1.0 : -1.0} : random.direction();
        s.gap = gap;
        s.velocity = speed * (list.size() % 3 == 0 ? s.normal : random.direction());
        s.spin = (speed / radius) * random.direction();
        s.turn = angle * random.direction();
        list.push_back(s);
      }
  return list;
}

/// What of an answer is not a number or not finite; "" when nothing.
std::string flaw(const LawBench& bench, std::size_t i, const Tangent& t) {
  if (!finite(bench.force(i))) return "force";
  if (!finite(bench.moment(i))) return "moment";
  for (std::size_t w = 0; w < bench.state_words(); ++w)
    if (!std::isfinite(bench.state(w, i))) return fmt::format("word {} of the state", w);
  for (const double k : {t.normal, t.shear, t.bending, t.twist, t.dashpot_normal, t.dashpot_shear})
    if (!std::isfinite(k)) return "reported stiffness";
  return "";
}

}  // namespace

Outcome accepts_inputs(const Subject& subject) {
  const scree_contact_model& model = subject.component->contact_model();
  const std::vector<Case> all = cases(model, 64, 121);
  for (const Case& c : all) {
    for (const double word : c.words)
      if (std::isnan(word))
        return failed("'prepare' or 'derive' makes a property that is not a number; " + c.text,
                      "refuse such inputs by throwing in 'prepare'");
    std::vector<double> again = c.inputs;
    char why[64] = "";
    const scree_refusal refusal{sizeof(scree_refusal), sizeof why, why};
    const scree_pair pair{sizeof(scree_pair), 0, c.r1, c.r2, c.mass};
    if (model.prepare != nullptr) model.prepare(again.data(), c.form, &refusal);
    if (model.derive != nullptr) model.derive(again.data(), c.form, &pair);
    if (again != c.words)
      return failed("'prepare' and 'derive' give other properties when called again; " + c.text,
                    "they may depend on nothing but inputs and pair");
    // The kernel calls them again for every new contact, on words that are already filled in.
    if (model.derive != nullptr) model.derive(again.data(), c.form, &pair);
    if (again != c.words)
      return failed("'derive' changes what it computed itself; " + c.text,
                    "compute from inputs only, never from a property that 'derive' writes");
  }
  return passed(fmt::format("{} sets of inputs, {} form{}", all.size(), std::max<uint32_t>(model.form_count, 1),
                            model.form_count > 1 ? "s" : ""));
}

Outcome extremes_finite(const Subject& subject) {
  const scree_contact_model& model = subject.component->contact_model();
  std::size_t seen = 0;
  for (const Case& c : extreme_cases(model))
    for (const Part part : parts(model)) {
      const std::vector<Seen> list = hard_contacts(c);
      LawBench bench(model, part, list.size(), c.words);
      std::fill(bench.reach.begin(), bench.reach.end(), c.reach);
      for (const double dt : {0.0, 1e-12, 1e-7, 1e-3})
        for (int repeat = 0; repeat < 2; ++repeat) {
          bench.dt = dt;
          for (std::size_t i = 0; i < list.size(); ++i) bench.put(i, list[i]);
          bench.run();
          for (std::size_t i = 0; i < list.size(); ++i, ++seen)
            if (const std::string what = flaw(bench, i, bench.tangent(i)); !what.empty())
              return failed(
                  fmt::format("{} is not finite at dt {:g} s; {}", what, dt, text_of(c, part, list[i])),
                  "look for a division by zero, a root of something negative, or a factor of 0 times infinity");
        }
    }
  return passed(fmt::format("{} contacts", seen));
}

Outcome nan_passes(const Subject& subject) {
  Worst worst;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for_cases(subject, 16, 123, [&](const Case& c, Part part) {
    LawBench bench(*c.model, part, 3, c.words);
    bench.dt = c.dt;
    std::fill(bench.reach.begin(), bench.reach.end(), c.reach);
    Seen s = c.seen();
    s.gap = -c.depth;
    bench.put(0, s);
    s.velocity = (0.1 * c.depth / c.dt) * Vec3{0.6, 0, 0.8};
    bench.put(1, s);
    const bool loaded = [&] {
      bench.run();
      return bench.force(0).norm() > 0;
    }();
    const bool feels_motion = (bench.force(1) - bench.force(0)).norm() > 1e-6 * bench.force(1).norm();
    for (std::size_t w = 0; w < bench.state_words(); ++w)
      for (std::size_t i = 0; i < 3; ++i) bench.set_state(w, i, 0);
    const auto number = [&](std::size_t i) {
      const Vec3 f = bench.force(i);
      return !std::isnan(f.x) && !std::isnan(f.y) && !std::isnan(f.z);
    };
    s.gap = nan;
    bench.put(0, s);
    s.gap = -c.depth;
    s.velocity = {nan, nan, nan};
    bench.put(1, s);
    bench.run();
    if (loaded) worst.see(number(0) ? 1 : 0, [&] { return "the gap is not a number, but the force is; " + c.text; });
    if (feels_motion)
      worst.see(number(1) ? 1 : 0, [&] { return "the velocity is not a number, but the force is; " + c.text; });
  });
  return worst.judged(0,
                      "what is not a number must not look like no contact: use scree::max and scree::min, not those of "
                      "the standard library");
}

}  // namespace scree::core::vet
