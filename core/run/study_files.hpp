#pragma once
#include <string>

#include "core/run/study.hpp"

namespace scree::core {

/// One row for each point and norm; everything but the last columns (`wall_*`) is the same each time. [any thread]
std::string study_table(const Study& study);
/// The report in Markdown. [any thread]
std::string study_report(const Study& study);
/// Input of gnuplot that draws error against cost as study.svg, log-log; "" when there is nothing to draw. [any thread]
std::string study_plot(const Study& study);

/// Runs gnuplot on a file in a folder; "" when it drew, otherwise why not.
std::string draw(const std::string& folder, const std::string& script);

/// Wall time of the point's runs: median, least, most; of the short run where there is no other. s
struct StudyCost {
  double wall = 0, least = 0, most = 0;
  const StudyRun* run = nullptr;  ///< counts are those of this one; null when nothing ran
};
StudyCost cost_of(const StudyPoint& point);

}  // namespace scree::core
