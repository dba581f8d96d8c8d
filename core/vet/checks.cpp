#include "core/vet/check.hpp"
#include "core/vet/law_checks.hpp"
#include "core/vet/library_checks.hpp"

// The one list of all checks; docs/vet.md says more about each.

namespace scree::core::vet {

namespace {

const std::vector<Check> of_library = {
    {"exported_symbols", "the library exports scree_plugin and nothing else", exported_symbols},
    {"unshared_symbols", "no variable is shared with other plug-ins", unshared_symbols},
    {"search_paths", "no RPATH, no RUNPATH, no library by path", search_paths},
    {"constant_code", "no text relocations, no stack that can run code", code_is_constant},
    {"header", "an ELF library for this machine with the header of this ABI", header_sound},
    {"opens", "every component passes the loader's own checks", opens},
    {"file_name", "the file bears the name of a component", named_as_file},
    {"start_up", "loading changes neither float mode, signals, locale, environment, files nor threads",
     start_up_leaves_no_trace},
};

const std::vector<Check> of_contact_model = {
    {"exchange", "with the pieces exchanged the force is reversed", exchange},
    {"frame_turn", "in a turned frame the force is turned", frame_turn},
    {"turns_along", "a pair that turns as a whole keeps its forces", turns_along},
    {"batch_sizes", "batches of 1, 7, 8 and 128 give the same bits", batch_sizes},
    {"instruction_sets", "baseline, v3 and v4 give the same bits", instruction_sets},
    {"varying", "uniform and varying properties give the same bits", varying_properties},
    {"energy_variant", "keeping energies changes no bit of the forces", energy_variant},
    {"normal_only", "the law without tangential part gives the force of the full law", normal_only_variant},
    {"bonded_variants", "bonded contacts have the same bits however the law is called", bonded_variants},
};

}  // namespace

const std::vector<Check>& library_checks() { return of_library; }

std::vector<Check> component_checks(Kind kind) {
  switch (kind) {
    case Kind::contact_model:
      return of_contact_model;
    default:
      return {};
  }
}

}  // namespace scree::core::vet
