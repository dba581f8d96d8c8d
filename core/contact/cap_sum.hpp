#pragma once

namespace scree::core {

/// What one contact adds to the block of its ball, in units that make the ball's mass and inertia 1: along and across
/// the contact's direction n for translations u, about n and across it for rotations w, and between the two, where the
/// energy has the term 2 mixed (u x w).n.
struct ContactShape {
  double along = 0, across = 0, twist = 0, bend = 0, mixed = 0;
};

/// How many directions, two by two at least twice this angle apart, there can be: their caps do not overlap. `cosine`
/// of the angle, below 1.
constexpr double caps(double cosine) { return 2 / (1 - cosine); }

/// Largest eigenvalue that a ball's block can have when all its contacts are `one` and their directions lie, two by
/// two, at least twice the angle apart whose cosine is given. Not the least such value, but never too small: over a cap
/// about n the average of a field G of blocks that are nowhere negative is at least the block of a contact along n, so
/// the sum over contacts is at most the integral of G over the sphere, over the area of a cap; it has the same value
/// for all translations, and for all rotations. Averages over caps scale harmonics of degree l by known factors
/// (Funk-Hecke, as in A. Erdelyi et al., Higher Transcendental Functions II, 1953, 11.4).
double cap_sum(const ContactShape& one, double cosine);

}  // namespace scree::core
