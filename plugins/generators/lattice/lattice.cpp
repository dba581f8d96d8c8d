#include <scree/generator.hpp>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace {

using namespace scree;

/// The orthogonal cell of a lattice: its edges in units of the spacing, and its balls in units of the edges.
struct Cell {
  Vec3 edge;
  std::vector<Vec3> basis;
};

Cell cell_of(const std::string& kind) {
  if (kind == "sc") return {{1, 1, 1}, {{0, 0, 0}}};
  if (kind == "bcc") {
    const double a = 2 / std::sqrt(3.0);
    return {{a, a, a}, {{0, 0, 0}, {0.5, 0.5, 0.5}}};
  }
  if (kind == "fcc") {
    const double a = std::sqrt(2.0);
    return {{a, a, a}, {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}}};
  }
  // hcp: layers normal to z, the second one shifted by (1/2, 1/(2 sqrt 3)) of the spacing.
  return {{1, std::sqrt(3.0), std::sqrt(8.0 / 3)}, {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 1.0 / 6, 0.5}, {0, 2.0 / 3, 0.5}}};
}

/// Indices i with start + i * edge inside, ends included or not.
struct Range {
  long long first, last;
};

/// Equal balls on the points of a crystal lattice.
struct Lattice {
  std::string kind;
  double radius = 0;
  std::optional<double> spacing;
  std::array<Vec3, 2> box{};
  std::optional<Vec3> origin;
  bool fit = true;

  static void describe(Settings<Lattice>& settings) {
    settings.text("kind", &Lattice::kind, "simple cubic, body-centred, face-centred or hexagonal close packed")
        .choices("sc bcc fcc hcp")
        .required();
    settings.number("radius", &Lattice::radius, "m", "radius of every ball").above(0).required();
    settings.number("spacing", &Lattice::spacing, "m", "distance of nearest neighbours; 2 radius when absent").above(0);
    settings.box("box", &Lattice::box, "m", "lower and upper corner of the region to fill").required();
    settings.vector("origin", &Lattice::origin, "m",
                    "one lattice point; the lower corner of the box when absent, moved in by a radius with `fit`");
    settings.boolean("fit", &Lattice::fit,
                     "balls lie wholly inside the box; false: centres from low up to, not including, high");
  }

  /// Rounding must not decide whether the last layer exists: 1e-9 of an edge is forgiven at both ends. Without `fit`
  /// the upper end is excluded, so that a box of whole cells repeats without a double layer.
  Range range(std::size_t axis, double start, double edge) const {
    constexpr double slack = 1e-9;
    const double inset = fit ? radius : 0.0;
    const double low = (box[0][axis] + inset - start) / edge, high = (box[1][axis] - inset - start) / edge;
    const double last = fit ? std::floor(high + slack) : std::ceil(high - slack) - 1;
    if (!(std::abs(low) < 1e15) || !(std::abs(last) < 1e15))
      throw std::runtime_error(
          "'spacing' is too small for 'box': the lattice would have more points than can be counted");
    return {static_cast<long long>(std::ceil(low - slack)), static_cast<long long>(last)};
  }

  void generate(Sink& sink) const {
    const Cell cell = cell_of(kind);
    const Vec3 edge = cell.edge * spacing.value_or(2 * radius);
    const double inset = fit ? radius : 0.0;
    const Vec3 start = origin.value_or(box[0] + Vec3{inset, inset, inset});
    std::size_t count = 0;
    for (const Vec3& offset : cell.basis) {
      Vec3 first;
      std::array<Range, 3> range_of{};
      for (std::size_t k = 0; k < 3; ++k) {
        first[k] = start[k] + offset[k] * edge[k];
        range_of[k] = range(k, first[k], edge[k]);
      }
      for (long long iz = range_of[2].first; iz <= range_of[2].last; ++iz)
        for (long long iy = range_of[1].first; iy <= range_of[1].last; ++iy)
          for (long long ix = range_of[0].first; ix <= range_of[0].last; ++ix, ++count)
            sink.ball(
                {.position = {first.x + static_cast<double>(ix) * edge.x, first.y + static_cast<double>(iy) * edge.y,
                              first.z + static_cast<double>(iz) * edge.z},
                 .radius = radius});
    }
    if (count == 0)
      throw std::runtime_error(
          "no ball of radius " + shortest(radius) +
          " m fits: enlarge 'box', reduce 'radius', or set 'fit: false' to place centres in the box");
  }
};

}  // namespace

SCREE_PLUGIN(scree::generator<Lattice>("lattice", "1.0.0", "equal balls on a crystal lattice"))
