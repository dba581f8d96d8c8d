#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/run/study.hpp"
#include "core/run/study_files.hpp"
#include "core/run/study_judge.hpp"

namespace scree::core {

namespace {

std::optional<std::size_t> index_of(const Study& study, const std::function<bool(const StudyPoint&)>& wanted) {
  for (std::size_t k = 0; k < study.points.size(); ++k)
    if (wanted(study.points[k])) return k;
  return std::nullopt;
}

std::string share(const StudyNorm& norm, double error) {
  if (norm.trajectory) return fmt::format("{:.2g} R", error);
  if (norm.rotation) return fmt::format("{:.2g} rad", error);
  return norm.relative || norm.name == energy_residual ? fmt::format("{:.2g} %", 100 * error)
                                                       : fmt::format("{:.2g}", error);
}

// "deepest within 0.4 %, trajectories within 1e-3 R"
std::string errors_at(const Study& study, std::size_t point) {
  std::string out;
  for (const StudyNorm& norm : study.norms) {
    const StudyNorm::Entry& entry = norm.entries[point];
    if (!entry.error || !std::isfinite(*entry.error)) continue;
    const double bound = entry.resolved ? *entry.error + norm.uncertainty : *entry.error + 3 * norm.uncertainty;
    const std::string name = norm.trajectory                ? "short trajectories"
                             : norm.rotation                ? "rotations"
                             : norm.name == energy_residual ? "the energy balance"
                                                            : norm.name;
    out += (out.empty() ? "" : ", ") + name + " within " + share(norm, bound);
  }
  return out.empty() ? "no error that could be measured" : out;
}

std::string time_at(const Study& study, std::size_t point) {
  return fmt::format("{:.2g} s", cost_of(study.points[point]).wall);
}

}  // namespace

std::string conclusion(const Study& study) {
  const auto rung = [&](const std::string& name) {
    return index_of(study, [&](const StudyPoint& p) { return p.name == name; });
  };
  std::optional<std::size_t> best = rung("automatic/1");
  if (!best || !study.points[*best].trouble().empty()) best = rung("automatic");
  if (!best || cost_of(study.points[*best]).run == nullptr) return "The study did not come far enough for an answer.";
  std::string out = fmt::format("For this scene the automatic step ({:.3g} s) gives {}, in {}", study.automatic,
                                errors_at(study, *best), time_at(study, *best));
  if (const auto half = rung("automatic/2"); half && cost_of(study.points[*half]).run != nullptr)
    out += "; half of it gives " + errors_at(study, *half) + ", in " + time_at(study, *half);
  if (const auto usual = index_of(study, [](const StudyPoint& p) { return p.kind == StudyPoint::Kind::usual; })) {
    const StudyPoint& point = study.points[*usual];
    if (point.trouble().empty() && cost_of(point).run != nullptr)
      out += fmt::format("; the usual step 0.8 sqrt(m/k) ({:.3g} s) gives {}, in {}", point.step,
                         errors_at(study, *usual), time_at(study, *usual));
    else
      out += fmt::format("; a run with the usual step 0.8 sqrt(m/k) ({:.3g} s) fails", point.step);
  }
  for (const StudyBias& bias : study.biases)
    if (bias.point == "automatic/1" && bias.spread > 0)
      out +=
          fmt::format("; {} differs from seed to seed by {:.2g} (standard deviation), {}", bias.quantity, bias.spread,
                      bias.converged ? "so that a smaller step gains nothing"
                                     : "and this study does not show that the step is small enough beside it");
  return out + ".";
}

}  // namespace scree::core
