#include "core/run/study_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <cmath>

#include "core/base/file.hpp"
#include "core/run/study_statistics.hpp"

extern char** environ;

namespace scree::core {

namespace {

const char* kind_word(StudyPoint::Kind kind) {
  switch (kind) {
    case StudyPoint::Kind::automatic:
      return "automatic";
    case StudyPoint::Kind::ladder:
      return "ladder";
    case StudyPoint::Kind::beyond:
      return "beyond";
    case StudyPoint::Kind::usual:
      return "usual";
    case StudyPoint::Kind::own:
      return "own";
    case StudyPoint::Kind::varied:
      return "varied";
  }
  return "";
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

std::string number(const std::optional<double>& value) { return value ? fmt::format("{}", *value) : ""; }

std::string error_text(const StudyNorm::Entry& entry) {
  if (!entry.error) return "-";
  return fmt::format("{:.2e}{}", *entry.error, entry.resolved ? "" : " (not resolved)");
}

std::string norm_title(const StudyNorm& norm) {
  if (norm.trajectory) return "trajectory / R";
  if (norm.rotation) return "rotation, rad";
  return norm.name + (norm.relative ? ", relative" : "");
}

std::string points_table(const Study& study) {
  std::string head = "| point | step, s | cycles | contact updates | wall time, s |", line = "|---|---|---|---|---|";
  for (const StudyNorm& norm : study.norms) {
    head += " " + norm_title(norm) + " |";
    line += "---|";
  }
  std::string out = head + "\n" + line + "\n";
  for (std::size_t k = 0; k < study.points.size(); ++k) {
    const StudyPoint& point = study.points[k];
    const StudyCost cost = cost_of(point);
    out += fmt::format("| {} |", point.name);
    if (cost.run == nullptr)
      out += " - | - | - | - |";
    else
      out += fmt::format(" {:.4g} | {} | {} | {:.3g} ({:.3g} to {:.3g}) |", cost.run->step, cost.run->cycles,
                         cost.run->contact_updates, cost.wall, cost.least, cost.most);
    for (const StudyNorm& norm : study.norms) out += " " + error_text(norm.entries[k]) + " |";
    out += "\n";
    if (const std::string trouble = point.trouble(); !trouble.empty())
      out += "| " + point.name + " | " + trouble + " |\n";
  }
  return out;
}

std::string norms_table(const Study& study) {
  std::string out =
      "| error | reference | its uncertainty | from | order | expected | how |\n|---|---|---|---|---|---|---|\n";
  for (const StudyNorm& norm : study.norms) {
    const std::string expected = norm.least_order == norm.most_order
                                     ? fmt::format("{}", norm.most_order)
                                     : fmt::format("{} to {}", norm.least_order, norm.most_order);
    out += fmt::format("| {} | {} | {:.2g} | {} | {} | {} | {} |\n", norm_title(norm),
                       norm.reference ? fmt::format("{:.8g}", *norm.reference) : "-", norm.uncertainty, norm.method,
                       norm.order ? fmt::format("{:.2f}{}", *norm.order, norm.odd ? " **(off)**" : "") : "-", expected,
                       norm.fit);
  }
  return out;
}

std::string seeds_table(const Study& study) {
  if (study.biases.empty()) return "";
  std::string out =
      "\nOver seeds, against the finest step with the same seeds (95 % t-interval of the paired differences; "
      "converged: "
      "bias and interval within 1 % of the mean or half the spread):\n\n"
      "| quantity | point | bias | interval | spread over seeds | mean | pairs | "
      "|\n|---|---|---|---|---|---|---|---|\n";
  for (const StudyBias& bias : study.biases)
    out +=
        fmt::format("| {} | {} | {:.3g} | {:.3g} | {:.3g} | {:.6g} | {} | {} |\n", bias.quantity, bias.point, bias.bias,
                    bias.interval, bias.spread, bias.mean, bias.pairs, bias.converged ? "converged" : "not shown");
  return out;
}

std::string drifts_table(const Study& study) {
  if (study.drifts.empty()) return "";
  std::string out =
      "\nDrift of the energy residual in 1e6 cycles, as a share of what passed through (95 % t-interval of a straight "
      "line over ten stretches of the run):\n\n| point | drift in 1e6 cycles | interval | cycles measured "
      "|\n|---|---|---|---|\n";
  for (const StudyDrift& drift : study.drifts)
    out += fmt::format("| {} | {:.2e} | {:.2e} | {}{} |\n", drift.point, drift.slope, drift.interval, drift.cycles,
                       std::fabs(drift.slope) > drift.interval ? "" : ", none shown");
  return out;
}

}  // namespace

StudyCost cost_of(const StudyPoint& point) {
  StudyCost cost;
  std::vector<double> walls;
  for (const StudyRun& run : point.runs)
    if (run.cycles > 0) {
      walls.push_back(run.wall);
      if (cost.run == nullptr) cost.run = &run;
    }
  if (walls.empty() && point.flown.cycles > 0) {
    walls.push_back(point.flown.wall);
    cost.run = &point.flown;
  }
  if (walls.empty()) return cost;
  cost.wall = median(walls);
  cost.least = *std::min_element(walls.begin(), walls.end());
  cost.most = *std::max_element(walls.begin(), walls.end());
  return cost;
}

std::string study_table(const Study& study) {
  std::string out =
      "point,kind,step,status,cycles,model_time,ball_steps,contact_updates,norm,value,reference,uncertainty,error,"
      "resolved,wall_median,wall_least,wall_most\n";
  for (std::size_t k = 0; k < study.points.size(); ++k) {
    const StudyPoint& point = study.points[k];
    const StudyCost cost = cost_of(point);
    const Exit code = !point.runs.empty() ? point.runs[0].code : point.flown.code;
    std::string head = quoted(point.name) + "," + kind_word(point.kind) + ",";
    head += cost.run != nullptr ? number(cost.run->step) : number(point.step);
    head += "," + (code == Exit::expectation ? status_word(Exit::done) : status_word(code));
    if (cost.run == nullptr)
      head += ",,,,";
    else
      head += fmt::format(",{},{},{},{}", cost.run->cycles, cost.run->model_time, cost.run->ball_steps,
                          cost.run->contact_updates);
    const std::string walls =
        cost.run == nullptr ? ",,," : fmt::format(",{:.4g},{:.4g},{:.4g}", cost.wall, cost.least, cost.most);
    bool any = false;
    for (const StudyNorm& norm : study.norms) {
      const StudyNorm::Entry& entry = norm.entries[k];
      if (!entry.error) continue;
      any = true;
      out += head + "," + quoted(norm.name) + "," + number(entry.value) + "," + number(norm.reference) + "," +
             number(norm.uncertainty) + "," + number(entry.error) + (entry.resolved ? ",yes" : ",no") + walls + "\n";
    }
    for (const StudyDrift& drift : study.drifts)
      if (drift.point == point.name)
        out += head + ",energy.residual_share per 1e6 cycles," + number(drift.slope) + ",," + number(drift.interval) +
               ",," + walls + "\n";
    if (!any) out += head + ",,,,,," + walls + "\n";
  }
  return out;
}

std::string study_report(const Study& study) {
  std::string out = "# Error against run time: " + study.scene + "\n\n" + conclusion(study) + "\n\n";
  out += fmt::format("The least automatic step was {:.6g} s.", study.automatic);
  if (study.horizon > 0)
    out += fmt::format(" Trajectories are compared after {:.6g} s, when {}.", study.horizon, study.horizon_reason);
  out += "\n\n" + points_table(study) + "\n" + norms_table(study) + drifts_table(study) + seeds_table(study);
  if (!study.picture.empty()) out += "\n![error against run time](" + study.picture + ")\n";
  if (!study.remarks.empty()) out += "\n";
  for (const std::string& remark : study.remarks) out += "* " + remark + "\n";
  return out;
}

namespace {

/// Numbers of gnuplot's symbols: filled where resolved, hollow where the reference is no better.
int symbol(StudyPoint::Kind kind, bool resolved) {
  const int filled = kind == StudyPoint::Kind::automatic ? 13
                     : kind == StudyPoint::Kind::beyond  ? 9
                     : kind == StudyPoint::Kind::usual   ? 5
                                                         : 7;
  return resolved ? filled : filled - 1;
}

std::string plot_rows(const Study& study, const StudyNorm& norm) {
  std::string rows;
  for (std::size_t k = 0; k < study.points.size(); ++k) {
    const StudyPoint& point = study.points[k];
    const StudyNorm::Entry& entry = norm.entries[k];
    const StudyCost cost = cost_of(point);
    if (!entry.error || *entry.error <= 0 || cost.wall <= 0) continue;
    const bool named = point.kind == StudyPoint::Kind::own || point.kind == StudyPoint::Kind::varied;
    rows += fmt::format("{} {} {} {} {} {} \"{}\"\n", cost.wall, *entry.error, cost.least, cost.most,
                        cost.run->contact_updates, symbol(point.kind, entry.resolved), named ? point.name : "");
  }
  return rows;
}

}  // namespace

std::string study_plot(const Study& study) {
  std::string blocks, wall, counted;
  for (std::size_t n = 0; n < study.norms.size(); ++n) {
    const std::string rows = plot_rows(study, study.norms[n]);
    if (rows.empty()) continue;
    const std::string name = fmt::format("$points{}", n), color = fmt::format("lc {}", n + 1);
    blocks += name + " << EOD\n" + rows + "EOD\n";
    const auto panel = [&](std::string& plot, const std::string& x) {
      plot += plot.empty() ? "plot " : ", \\\n     ";
      plot += "NaN with points pt 7 " + color + " title '" + norm_title(study.norms[n]) + "', \\\n     " + name +
              " using " + x + ":2:6 with points pt variable " + color + " notitle, \\\n     " + name + " using " + x +
              ":2:7 with labels offset 0,0.8 font ',9' notitle";
    };
    panel(wall, "1");
    wall += ", \\\n     " + name + " using 1:2:3:4 with xerrorbars pt 0 " + color + " notitle";
    panel(counted, "5");
  }
  if (wall.empty()) return "";
  return "set terminal svg size 1100,600 dynamic background 'white' noenhanced\nset output 'study.svg'\nset logscale "
         "xy\n"
         "set format xy '%.0e'\nset xtics 10\nset ytics 10\nset ylabel 'error'\nset grid\nset key outside below\n" +
         blocks +
         "set multiplot layout 1,2 title 'circles: ladder of steps; square: 0.8 sqrt(m/k); triangle: twice the "
         "automatic "
         "step; diamond: automatic; hollow: not resolved' font ',11'\nset xlabel 'wall time, s'\n" +
         wall + "\nset xlabel 'contact updates'\n" + counted + "\nunset multiplot\n";
}

std::string draw(const std::string& folder, const std::string& script) {
  // The program changes into the folder by itself, so that the script can be run there by hand too.
  const std::string there = "cd '" + [&] {
    std::string escaped;
    for (const char c : folder) {
      if (c == '\'') escaped += '\'';
      escaped += c;
    }
    return escaped;
  }() + "'";
  std::string words[] = {"gnuplot", "-e", there, script};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&quiet, 2, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failure = ::posix_spawnp(&child, words[0].c_str(), &quiet, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&quiet);
  if (failure == ENOENT) return "gnuplot is not installed (Debian: gnuplot-nox)";
  if (failure != 0) return "gnuplot: " + errno_text(failure);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? "" : "gnuplot failed on " + script;
}

}  // namespace scree::core
