// PFC's histories of one contact, by the scenes hertz_history_*.yaml as a user runs them: every printed digit.
#include <algorithm>
#include <cmath>

#include "support/hertz_histories.hpp"
#include "support/measure.hpp"
#include "support/program.hpp"

using namespace support;

namespace {

/// history.csv of the scenes: one row for each cycle from 0 on.
struct Row {
  double time, overlap, x, y, z, strain, friction, dashpot;
};
std::vector<Row> rows_of(const std::string& table) {
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string field;
    std::vector<double> v;
    while (std::getline(fields, field, ',')) v.push_back(std::stod(field));
    REQUIRE(v.size() == 9);
    rows.push_back({v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]});
  }
  return rows;
}

std::vector<Row> run(const std::string& name) {
  std::vector<std::string> words = {
      "run",     source_dir() + "/tests/scenes/hertz_history_" + (name[1] == 'b' ? "balls" : "wall") + ".yaml",
      "--quiet", "-j",
      "1",       "-o",
      "out"};
  if (name[2] != '1') words.insert(words.end(), {"--set", "vars.mode=1"});
  if (name[2] == '3') words.insert(words.end(), {"--set", "vars.ratio=0.5", "--set", "vars.dashpot_mode=3"});
  const TemporaryFolder folder;
  const ProgramEnd end = scree(words, folder.path());
  INFO(end.err << end.out);
  REQUIRE(end.code == 0);
  return rows_of(read_text(folder / "out/history.csv"));
}

/// What the shear spring of mode 1 loses from one row to the next as its stiffness falls, which PFC does not count as
/// slip.
double uncounted(const Row& before, const Row& now, double stiffness) {
  if (now.overlap >= before.overlap || now.overlap <= 0) return 0;
  const double k = stiffness * std::sqrt(before.overlap), left = std::sqrt(now.overlap / before.overlap);
  return (before.x * before.x + before.z * before.z) / (2 * k) * (1 - left);
}

/// PFC counts a dashpot with the velocity of each cycle, the energy account by the trapezoidal rule: half of it and
/// half of its geometric mean with the one before. This undoes the second, so that the sum is the first.
class DashpotWork {
 public:
  double with(double account) {
    const double gone = std::max(0.0, account - account_);
    account_ = account;
    root_ = 0.5 * (std::sqrt(root_ * root_ + 8 * gone) - root_);
    return sum_ += root_ * root_;
  }
  double sum() const { return sum_; }

 private:
  double account_ = 0, root_ = 0, sum_ = 0;
};

}  // namespace

TEST_CASE("scenes of one Hertz contact have PFC's histories to their printed digits") {
  const auto all = hertz_histories();
  REQUIRE(all.size() == 6);
  for (const auto& [name, instants] : all) {
    Measure measure("hertz histories, " + name,
                    "Hertz verification problem of PFC 6, 12 instants, seven printed digits; shear turned there by a "
                    "formula of second order");
    const std::vector<Row> rows = run(name);
    REQUIRE(rows.size() == 351);
    REQUIRE(instants.size() == 12);
    const double radius = name[1] == 'b' ? 0.25 : 0.5;
    const double shear = 2 * (1 - 0.3) / (2 - 0.3) * 2 * 1e9 / (1 - 0.3) * std::sqrt(radius);  // ks/sqrt(overlap)
    double lost = 0, off_force = 0, off_strain = 0, off_slip = 0, off_dashpot = 0, off_motion = 0;
    DashpotWork work;
    std::size_t next = 0;
    for (std::size_t n = 1; n < rows.size() && next < instants.size(); ++n) {
      const Row& row = rows[n];
      if (name[2] != '1') lost += uncounted(rows[n - 1], row, shear);
      // At the end of the contact the account has the second half of the last force, and PFC nothing.
      const double dashpot = row.overlap > 0 ? work.with(row.dashpot) : work.sum();
      const std::vector<double>& now = instants[next];
      if (row.time < now[0] - 1e-9) continue;
      ++next;
      // Relative, and absolute where zero is printed.
      const auto off = [](double value, double printed) {
        return std::abs(value - printed) / std::max(std::abs(printed), 1e-4);
      };
      // Printed is the dashpot along x; at the end of the turn about x the same force is along -z.
      const double along_z = now[5] - (std::abs(now[0] - 0.2) < 1e-9 ? instants[next - 2][6] : 0);
      off_motion = std::max({off_motion, std::abs(row.time - now[0]), std::abs(row.overlap - now[1])});
      off_force = std::max({off_force, off(row.y, now[2] + now[3]), off(row.x, now[4] + now[6]), off(row.z, along_z)});
      off_strain = std::max(off_strain, off(row.strain, now[7]));
      off_slip = std::max(off_slip, off(row.friction - lost, now[8]));
      off_dashpot = std::max(off_dashpot, off(dashpot, now[9]));
    }
    CHECK(next == instants.size());
    measure.check("worst difference of time (s) and overlap (m)", off_motion, 0, 1e-13);
    measure.check("worst difference of a force, relative", off_force, 0, 1e-6);
    measure.check("worst difference of the strain energy, relative", off_strain, 0, 5e-7);
    measure.check("worst difference of the slip energy, relative", off_slip, 0, 5e-7);
    measure.check("worst difference of the dashpot energy, relative", off_dashpot, 0, 5e-7);
  }
}
