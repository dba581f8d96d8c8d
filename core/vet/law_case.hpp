#pragma once
#include <scree/abi.h>

#include <string>
#include <vector>

#include "core/vet/law_bench.hpp"
#include "core/vet/numbers.hpp"

namespace scree::core::vet {

/// One rule of a contact model with the pieces it is used for, and the scales on which its contacts live.
struct Case {
  const scree_contact_model* model = nullptr;
  std::vector<double> inputs;  ///< as a scene gives them
  std::vector<double> words;   ///< after `prepare` and `derive`
  uint32_t form = 0;
  double r1 = 0, r2 = 0, mass = 0;  ///< r2 0: a flat wall
  double reach = 0;                 ///< m
  double depth = 0;                 ///< m: overlap of a loaded contact
  double stiffness = 0;             ///< N/m, as reported at that overlap
  double dt = 0;                    ///< s: a small share of the contact's own period
  bool usual = true;                ///< every mode (whole number or switch) is at its default
  std::string text;                 ///< inputs and pieces, for a message

  Seen seen() const;                        ///< a contact of these pieces in touch at gap 0
  Case exchanged() const;                   ///< the same with the pieces exchanged
  double slow() const { return 1e6 * dt; }  ///< s: a step so long that dashpots do nothing at the same displacement
};

/// Random cases over all input forms: values within the declared bounds on scales that follow from their units, each
/// optional input at its default as often as not. The same seed gives the same cases. Throws Failed when `prepare`
/// refuses everything.
std::vector<Case> cases(const scree_contact_model& model, std::size_t count, uint64_t seed = 1);

/// Cases with every input at an end of its bounds, or as large or small as its unit goes.
std::vector<Case> extreme_cases(const scree_contact_model& model);

/// The parts of a model to check: touching, and bonded where it can bond.
std::vector<Part> parts(const scree_contact_model& model);

}  // namespace scree::core::vet
