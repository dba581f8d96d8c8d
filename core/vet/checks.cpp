#include "core/vet/check.hpp"
#include "core/vet/kind_checks.hpp"
#include "core/vet/law_checks.hpp"
#include "core/vet/library_checks.hpp"
#include "core/vet/object.hpp"

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
    {"inputs", "properties within their bounds are accepted and follow from the inputs alone", accepts_inputs},
    {"exchange", "with the pieces exchanged the force is reversed", exchange},
    {"frame_turn", "in a turned frame the force is turned", frame_turn},
    {"turns_along", "a pair that turns as a whole keeps its forces", turns_along},
    {"stiffness", "normal and shear stiffness are not less than the slope of the force", stiffness_touch},
    {"stiffness_rotation", "bending and twisting stiffness are not less than the slope of the moment",
     stiffness_rotation},
    {"stiffness_bonded", "all four stiffnesses of a bonded contact are not less than the slopes", stiffness_bonded},
    {"stiffness_generous", "the normal stiffness is not needlessly large", stiffness_generous},
    {"dashpot_share", "dashpots are not stronger than reported", dashpot_share},
    {"nothing_back", "from touch to separation no path gives energy", nothing_back},
    {"nothing_back_bonded", "no closed path of a bonded contact gives energy", nothing_back_bonded},
    {"continuity", "the force has no jump at touch, at reach or in between", continuity},
    {"reach", "no force is left where the kernel stops calling the law", reach_honest},
    {"bond_breaks_once", "a bond breaks once, and a broken one holds nothing", bond_breaks_once},
    {"energy_balance", "work is stored, slid away, damped or broken", energy_balance},
    {"energy_balance_bonded", "the same for a bonded contact", energy_balance_bonded},
    {"batch_sizes", "batches of 1, 7, 8 and 128 give the same bits", batch_sizes},
    {"instruction_sets", "baseline, v3 and v4 give the same bits", instruction_sets},
    {"varying", "uniform and varying properties give the same bits", varying_properties},
    {"energy_variant", "keeping energies changes no bit of the forces", energy_variant},
    {"normal_only", "the law without tangential part gives the force of the full law", normal_only_variant},
    {"bonded_variants", "bonded contacts have the same bits however the law is called", bonded_variants},
    {"state_round_trip", "a copied state goes on with the same bits", state_round_trip},
    {"repeatable", "the same inputs give the same bits, whatever ran in between", repeatable},
    {"no_allocation", "the law takes nothing from the heap", law_allocates},
    {"no_global_state", "the law changes no variable of the library", law_global_state},
    {"float_mode", "the law leaves the floating-point mode as it is (MXCSR)", law_float_mode},
    {"trespass", "the law writes its own arrays and nothing else", law_trespass},
    {"extremes", "extreme inputs give finite answers", extremes_finite},
    {"nan_passes", "what is not a number is passed on", nan_passes},
    {"speed", "time for one contact, and whether the compiler made a vector loop", law_speed},
};

const std::vector<Check> of_object = {
    {"settings", "values within their bounds are accepted, by every object alike", settings_accepted},
    {"refusals", "values of a wrong type or outside their bounds are refused with a reason", settings_refused},
    {"given_back", "objects that are destroyed give back what they took", objects_given_back},
};

const std::vector<Check> of_wall = {
    {"touches", "unit normals, finite distances, each patch of a ball once", wall_touches_sound},
    {"slope", "the distance changes along the normal as the ball moves", wall_slope},
    {"wall_reach", "every patch within reach is named, whatever the reach", wall_reach},
    {"flat", "a flat patch has one normal", wall_flat},
    {"outline", "polygons and area are finite", wall_outline},
    {"arrays", "balls in an array touch as they do alone", wall_arrays},
    {"overflow", "touches beyond the room are counted and not written", wall_overflow},
    {"extremes", "extreme places give finite touches", wall_extremes},
    {"no_allocation", "touching takes nothing from the heap", wall_allocates},
    {"no_global_state", "touching changes no variable of the library", wall_global_state},
    {"float_mode", "touching leaves the floating-point mode as it is", wall_float_mode},
};

const std::vector<Check> of_process = {
    {"row_bits", "blocks of 1, 7, 8 and 256 on every instruction set give the same bits", process_bits},
    {"columns", "only columns declared as written are written, and optional ones may be absent", process_columns},
    {"extremes", "extreme columns stay finite", process_extremes},
    {"no_allocation", "rows take nothing from the heap", process_allocates},
    {"no_global_state", "rows change no variable of the library", process_global_state},
    {"float_mode", "rows leave the floating-point mode as it is", process_float_mode},
    {"steps", "steps in a small scene work or refuse with a reason, within their State", process_step},
    {"damping", "the share of damping is at least 0 and below 1", process_damping},
    {"speed", "time for one ball", process_speed},
};

const std::vector<Check> of_generator = {
    {"repeatable", "the same random numbers give the same balls", generator_repeatable},
    {"balls", "radii and densities are positive, positions finite, ids unique", generator_balls_sound},
    {"stops", "it stops when the program refuses a ball", generator_stops},
};

const std::vector<Check> of_writer = {
    {"frames", "full, empty and extreme frames are written below the output folder", writer_frames},
    {"repeatable", "the same frames give the same bytes", writer_repeatable},
    {"full_disk", "a disk that takes nothing is noticed", writer_full_disk},
    {"resume", "a recording that was cut goes on with the same bytes", writer_resume},
};

std::vector<Check> joined(std::vector<Check> first, const std::vector<Check>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

const std::vector<Check>& library_checks() { return of_library; }

std::vector<Check> component_checks(Kind kind) {
  switch (kind) {
    case Kind::contact_model:
      return of_contact_model;
    case Kind::wall:
      return joined(of_object, of_wall);
    case Kind::process:
      return joined(of_object, of_process);
    case Kind::generator:
      return joined(of_object, of_generator);
    case Kind::writer:
      return joined(of_object, of_writer);
  }
  return {};
}

}  // namespace scree::core::vet
