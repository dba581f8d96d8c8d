#include "core/run/study_judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "core/run/study_drift.hpp"
#include "core/run/study_statistics.hpp"

namespace scree::core {

namespace {

using Values = std::vector<double>;
using Distance = std::function<double(const Values&, const Values&)>;

/// A norm as numbers: what each point gave, and how far two of them are apart.
struct Measured {
  std::vector<const Values*> of;  ///< one for each point, null where there is none
  Distance distance;
  std::optional<Values> exact;
  double useless = 0.3;  ///< errors above it are no longer small: they say nothing about the order
};

// The rungs that have a value, finest first.
std::vector<std::size_t> rungs(const Study& study, const Measured& measured) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < study.points.size(); ++k)
    if (study.points[k].kind == StudyPoint::Kind::ladder && measured.of[k] != nullptr) out.push_back(k);
  std::sort(out.begin(), out.end(),
            [&](std::size_t a, std::size_t b) { return study.points[a].step < study.points[b].step; });
  return out;
}

// The order that three steps show without a reference; absent where the differences do not fall.
std::optional<double> shown_order(const Study& study, const Measured& m, const std::vector<std::size_t>& finest) {
  if (finest.size() < 3) return std::nullopt;
  const auto step = [&](std::size_t k) { return study.points[finest[k]].step; };
  const double near = m.distance(*m.of[finest[0]], *m.of[finest[1]]);
  const double far = m.distance(*m.of[finest[1]], *m.of[finest[2]]);
  if (!(near > 0) || !(far > near)) return std::nullopt;
  // Differences go as h2^p - h1^p; with the steps near a geometric row their ratio is that of the steps to the p.
  return std::log(far / near) / (0.5 * std::log(step(2) / step(0)));
}

bool expected_order(const StudyNorm& norm, double order) {
  return order >= norm.least_order - 0.5 && order <= norm.most_order + 0.5;
}

Values reference(const Study& study, const Measured& m, const std::vector<std::size_t>& finest, StudyNorm& norm) {
  if (m.exact) {
    norm.uncertainty = norm.name == energy_residual ? 1e-9 : 1e-12;  // rounding
    return *m.exact;
  }
  Values out = *m.of[finest[0]];
  const Values& next = *m.of[finest[1]];
  norm.uncertainty = m.distance(out, next);
  norm.method = "the finest step";
  const std::optional<double> order = shown_order(study, m, finest);
  if (!order || !expected_order(norm, *order)) {
    norm.method += "; the three finest do not show an order to extrapolate with";
    return out;
  }
  const double ratio = std::pow(study.points[finest[1]].step / study.points[finest[0]].step, *order);
  for (std::size_t k = 0; k < out.size(); ++k) out[k] += (out[k] - next[k]) / (ratio - 1);
  norm.method =
      fmt::format("Richardson's extrapolation of the two finest steps with the order {:.2f} they show", *order);
  return out;
}

void fit(const Study& study, const Measured& m, const std::vector<std::size_t>& finest, StudyNorm& norm) {
  std::vector<std::pair<double, double>> points;
  double most = 0;
  for (const std::size_t k : finest) {
    const StudyNorm::Entry& entry = norm.entries[k];
    // Beyond the steps at which the error grows with the step it may be small again by chance.
    if (*entry.error >= m.useless || *entry.error < 0.5 * most) break;
    most = std::max(most, *entry.error);
    if (entry.resolved) points.emplace_back(study.points[k].step, *entry.error);
  }
  if (points.size() >= 3) {
    norm.order = fitted_order(points);
    norm.fit = fmt::format("least squares over {} rungs", points.size());
  } else if (m.exact) {
    norm.fit = "fewer than three rungs have a small error that is not rounding";
  } else if ((norm.order = shown_order(study, m, finest))) {
    norm.fit = "differences of the three finest rungs";
  } else {
    norm.fit = "fewer than three rungs are resolved";
  }
  // With fewer rungs a single impact looks odd by the phase in which it begins.
  norm.odd = points.size() >= 5 && !expected_order(norm, *norm.order);
}

void measure(const Study& study, const Measured& m, StudyNorm& norm) {
  norm.entries.resize(study.points.size());
  const std::vector<std::size_t> finest = rungs(study, m);
  if (!m.exact && finest.size() < 2) {
    norm.method = "none: fewer than two rungs came to their end";
    norm.fit = "no reference";
    return;
  }
  const Values exact = reference(study, m, finest, norm);
  if (!norm.trajectory && !norm.rotation) norm.reference = exact[0];
  for (std::size_t k = 0; k < study.points.size(); ++k) {
    StudyNorm::Entry& entry = norm.entries[k];
    if (m.of[k] == nullptr) continue;
    entry.error = m.distance(*m.of[k], exact);
    entry.resolved = *entry.error >= 3 * norm.uncertainty && *entry.error > 0;
  }
  fit(study, m, finest, norm);
}

void promise(StudyNorm& norm, const Horizon& horizon) {
  norm.least_order = horizon.dashpots || horizon.tangential ? 1 : 2;
  // Where contacts begin, a force that grows from touch as overlap^1.5 is met half an order better.
  norm.most_order = horizon.dashpots ? 1 : horizon.impacts ? 2.5 : 2;
}

// The square root of a mean of squares, weighed by the masses of the balls.
template <class Square>
double mean_over_mass(const Horizon& horizon, std::size_t balls, Square square) {
  double sum = 0, mass = 0;
  for (double one : horizon.mass) mass += one;
  for (std::size_t k = 0; k < balls; ++k) sum += horizon.mass[k] * square(k);
  return std::sqrt(sum / mass);
}

StudyNorm trajectory(const Study& study, const Horizon& horizon, const PeriodicCell& cell) {
  StudyNorm norm;
  norm.name = "trajectory";
  norm.trajectory = true;
  promise(norm, horizon);
  Measured m;
  m.distance = [&](const Values& a, const Values& b) {
    return mean_over_mass(horizon, std::min(a.size(), b.size()) / 3,
                          [&](std::size_t k) {
                            double square = 0;
                            for (int axis = 0; axis < 3; ++axis) {
                              const std::size_t at = 3 * k + static_cast<std::size_t>(axis);
                              double away = std::fabs(a[at] - b[at]);
                              if (cell.periodic[axis]) away = std::min(away, std::fabs(away - cell.length(axis)));
                              square += away * away;
                            }
                            return square;
                          }) /
           horizon.radius;
  };
  double travel = 0;
  for (const StudyPoint& point : study.points) {
    m.of.push_back(point.flight.empty() ? nullptr : &point.flight);
    if (!point.flight.empty() && point.kind == StudyPoint::Kind::ladder)
      travel = m.distance(point.flight, horizon.start);
  }
  m.useless = 0.3 * travel;
  measure(study, m, norm);
  return norm;
}

// 2 acos|q.q'|, from the sine where the turn is small and the cosine says nothing.
double angle_between(const double* q, const double* p) {
  const double along = std::fabs(q[0] * p[0] + q[1] * p[1] + q[2] * p[2] + q[3] * p[3]);
  double across = 0;
  const double turn[3] = {q[0] * p[1] - q[1] * p[0] - q[2] * p[3] + q[3] * p[2],
                          q[0] * p[2] + q[1] * p[3] - q[2] * p[0] - q[3] * p[1],
                          q[0] * p[3] - q[1] * p[2] + q[2] * p[1] - q[3] * p[0]};
  for (const double one : turn) across += one * one;
  return 2 * std::atan2(std::sqrt(across), along);
}

// Absent where no ball turns by more than rounding.
std::optional<StudyNorm> rotation(const Study& study, const Horizon& horizon) {
  StudyNorm norm;
  norm.name = "rotation";
  norm.rotation = true;
  norm.relative = false;
  promise(norm, horizon);
  Measured m;
  m.distance = [&](const Values& a, const Values& b) {
    return mean_over_mass(horizon, std::min(a.size(), b.size()) / 4, [&](std::size_t k) {
      const double angle = angle_between(&a[4 * k], &b[4 * k]);
      return angle * angle;
    });
  };
  Values still(4 * horizon.mass.size(), 0.0);
  for (std::size_t k = 0; k < still.size(); k += 4) still[k] = 1;
  double turn = 0;
  for (const StudyPoint& point : study.points) {
    m.of.push_back(point.turned.empty() ? nullptr : &point.turned);
    if (!point.turned.empty() && point.kind == StudyPoint::Kind::ladder) turn = m.distance(point.turned, still);
  }
  if (!(turn > 1e-9)) return std::nullopt;
  m.useless = 0.3 * turn;
  measure(study, m, norm);
  return norm;
}

StudyNorm quantity(const Study& study, const Horizon& horizon, std::size_t index,
                   const std::vector<ExpectationResult>& expected) {
  StudyNorm norm;
  norm.name = study.quantities[index];
  promise(norm, horizon);
  // The account may follow a dashpot better than the motion does.
  if (norm.name == energy_residual) norm.most_order = horizon.impacts ? 2.5 : 2;
  std::vector<Values> kept(study.points.size());
  Measured m;
  double scale = 0;
  for (std::size_t k = 0; k < study.points.size(); ++k) {
    const StudyPoint& point = study.points[k];
    if (point.done()) kept[k] = {point.runs[0].values[index]};
    const bool finite = point.done() && std::isfinite(kept[k][0]);
    m.of.push_back(finite ? &kept[k] : nullptr);
    if (finite && point.kind == StudyPoint::Kind::ladder) scale = std::fabs(kept[k][0]);
  }
  for (const ExpectationResult& expect : expected)
    if (expect.quantity == norm.name && expect.equals) {
      m.exact = Values{*expect.equals};
      scale = std::fabs(*expect.equals);
      norm.method = expect.source.empty() ? "the scene's expectation" : expect.source;
    }
  norm.relative = scale > 0;
  if (!norm.relative) scale = 1;
  m.distance = [scale](const Values& a, const Values& b) { return std::fabs(a[0] - b[0]) / scale; };
  measure(study, m, norm);
  for (std::size_t k = 0; k < study.points.size(); ++k)
    if (study.points[k].done()) norm.entries[k].value = study.points[k].runs[0].values[index];
  return norm;
}

void judge_seeds(Study& study, std::size_t index) {
  std::vector<std::size_t> finest;
  for (std::size_t k = 0; k < study.points.size(); ++k)
    if (study.points[k].kind == StudyPoint::Kind::ladder && study.points[k].done()) finest.push_back(k);
  if (finest.empty()) return;
  const StudyPoint& best = study.points[finest.back()];
  // Repeats share a seed and say nothing but how long they took.
  if (best.runs.size() < 2 || best.runs[0].seed == best.runs[1].seed) return;
  std::map<uint64_t, double> paired;
  Values sample;
  for (const StudyRun& run : best.runs)
    if (!run.values.empty()) sample.push_back(paired[run.seed] = run.values[index]);
  const Mean over = mean_of(sample);
  for (const StudyPoint& point : study.points) {
    if (&point == &best || point.runs.size() < 2) continue;
    Values differences;
    for (const StudyRun& run : point.runs)
      if (const auto found = paired.find(run.seed); found != paired.end() && !run.values.empty())
        differences.push_back(run.values[index] - found->second);
    if (differences.size() < 2) continue;
    const Mean bias = mean_of(differences);
    StudyBias out{study.quantities[index], point.name, bias.mean,         bias.interval,
                  over.deviation,          over.mean,  differences.size()};
    out.converged = std::fabs(out.bias) + out.interval <= std::max(0.01 * std::fabs(out.mean), 0.5 * out.spread);
    study.biases.push_back(out);
  }
}

}  // namespace

void judge(Study& study, const Horizon& horizon, const std::vector<ExpectationResult>& expected,
           const PeriodicCell& cell) {
  study.norms.clear();
  study.biases.clear();
  study.drifts = drifts(study);
  const bool flown = std::any_of(study.points.begin(), study.points.end(),
                                 [](const StudyPoint& point) { return !point.flight.empty(); });
  if (flown) study.norms.push_back(trajectory(study, horizon, cell));
  if (auto turns = rotation(study, horizon)) study.norms.push_back(std::move(*turns));
  for (std::size_t k = 0; k < study.quantities.size(); ++k) {
    study.norms.push_back(quantity(study, horizon, k, expected));
    judge_seeds(study, k);
  }
}

}  // namespace scree::core
