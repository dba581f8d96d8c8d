#pragma once
#include <scree/abi.h>
#include <scree/math.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/isa.hpp"

namespace scree::core::vet {

/// What a law sees of one contact; see scree_batch.
struct Seen {
  Vec3 normal{0, 0, 1}, velocity, spin, turn;
  double gap = 0, r1 = 0.01, r2 = 0.01, mass = 0.01;
};
std::string text_of(const Seen& seen);

/// Which of a model's functions runs.
enum class Part { touch, bonded, normal_only };
const char* part_name(Part part);

/// What a law says of its tangent at one contact.
struct Tangent {
  double normal = 0, shear = 0, bending = 0, twist = 0, dashpot_normal = 0, dashpot_shear = 0;
};

/// Contacts under one rule as the kernel hands them to a law: arrays, null where the law did not ask. Around every
/// array lie guard words.
class LawBench {
 public:
  LawBench(const scree_contact_model& model, Part part, std::size_t count, const std::vector<double>& words);
  LawBench(const LawBench&) = delete;
  LawBench& operator=(const LawBench&) = delete;

  double dt = 1e-5;
  /// m; a contact of a touch list that is farther apart is dropped with its state, as the kernel does.
  std::vector<double> reach;
  Isa isa = Isa::baseline;
  std::size_t batch = SCREE_BATCH;  ///< contacts handed over at once
  bool varying = false, energy = false;

  void put(std::size_t i, const Seen& seen);
  void set_words(std::size_t i, const std::vector<double>& words);  ///< of one contact, for `varying`
  /// Runs the law over all contacts. Throws Failed when it says that the author's code threw.
  void run();
  /// The batch that begins at a contact, for a caller that times or watches the law itself.
  scree_batch prepared(std::size_t first, std::size_t count);
  scree_law law() const;  ///< null when the model lacks it
  const void* rule() const { return rule_.data(); }
  Tangent tangent(std::size_t i);

  std::size_t size() const { return count_; }
  Vec3 force(std::size_t i) const { return {out(0, i), out(1, i), out(2, i)}; }
  Vec3 moment(std::size_t i) const { return {out(3, i), out(4, i), out(5, i)}; }
  double event(std::size_t i) const { return out(6, i); }
  double sliding(std::size_t i) const { return out(7, i); }
  double energies(std::size_t term, std::size_t i) const { return energy_[term][guard + i]; }
  /// Puts a mark into the energies, and whether the law wrote over it.
  void mark_energies();
  bool energies_written() const;
  std::size_t state_words() const { return state_.size(); }
  double state(std::size_t word, std::size_t i) const { return state_[word][guard + i]; }
  void set_state(std::size_t word, std::size_t i, double value) { state_[word][guard + i] = value; }
  void copy_state(std::size_t i, const LawBench& from, std::size_t j);

  /// Everything the law wrote: forces, moments, events, sliding, state, as bits, contact by contact.
  std::vector<uint64_t> bits() const;
  /// What was written outside of the arrays, or to an input; "" when nothing was.
  std::string trespass() const;

 private:
  static constexpr std::size_t guard = 16;
  using Column = std::vector<double>;
  Column column() const;
  double out(std::size_t k, std::size_t i) const { return out_[k][guard + i]; }
  bool guarded(const Column& column) const;
  void drop_open();

  const scree_contact_model& model_;
  Part part_;
  std::size_t count_;
  std::vector<double> rule_;
  std::array<Column, 16> in_, copy_;
  std::array<Column, 8> out_;
  std::array<Column, 4> energy_;
  std::vector<Column> words_, state_;
  std::vector<uint8_t> mask_;
  std::vector<const double*> property_pointers_;
  std::vector<double*> state_pointers_;
  std::array<double*, 4> energy_pointers_{};
};

}  // namespace scree::core::vet
