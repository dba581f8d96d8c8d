#include "core/vet/library_checks.hpp"

#include <algorithm>

#include "core/base/log.hpp"
#include "core/plugin/elf_check.hpp"
#include "core/plugin/header_check.hpp"
#include "core/plugin/library.hpp"
#include "core/vet/process_state.hpp"

namespace scree::core::vet {

namespace {

ElfFacts facts_of(const Subject& subject) { return read_elf(read_library(subject.file), subject.file); }

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

}  // namespace

Outcome exported_symbols(const Subject& subject) {
  std::vector<std::string> extra = facts_of(subject).exports;
  const auto end = std::remove(extra.begin(), extra.end(), "scree_plugin");
  if (end == extra.end())
    return failed("it does not export scree_plugin", "end one source file with SCREE_CONTACT_MODEL or SCREE_PLUGIN");
  extra.erase(end, extra.end());
  if (!extra.empty())
    return failed("it exports " + joined(extra) + " besides scree_plugin",
                  "build with hidden visibility, as scree_add_plugin() does");
  return passed();
}

Outcome unshared_symbols(const Subject& subject) {
  const ElfFacts facts = facts_of(subject);
  if (!facts.shared.empty())
    return failed("shared with other plug-ins (unique binding): " + joined(facts.shared),
                  "build with hidden visibility, as scree_add_plugin() does");
  return passed();
}

Outcome search_paths(const Subject& subject) {
  const ElfFacts facts = facts_of(subject);
  if (!facts.search_paths.empty())
    return failed("it carries a search path of its own: " + joined(facts.search_paths),
                  "link without -rpath, as scree_add_plugin() does");
  for (const std::string& name : facts.needed)
    if (name.find('/') != std::string::npos)
      return failed("it asks for a library by path: " + name, "link against an installed library by name");
  return {Verdict::pass, "needs " + joined(facts.needed), "", NAN, NAN};
}

Outcome code_is_constant(const Subject& subject) {
  const ElfFacts facts = facts_of(subject);
  if (facts.text_relocations)
    return failed("the system must write into its code to load it (text relocations)", "compile with -fPIC");
  if (facts.executable_stack)
    return failed("it asks for a stack that can run code",
                  "link without -z execstack; assembler files need a .note.GNU-stack section");
  return passed();
}

Outcome header_sound(const Subject& subject) {
  check_numbers(check_elf(read_library(subject.file), subject.file), subject.file);
  return passed();
}

Outcome opens(const Subject& subject) {
  std::string text;
  for (const auto& [kind, name] : list_components(subject.file)) {
    load_component(kind, name, subject.file);
    text += (text.empty() ? "" : ", ") + std::string(kind_name(kind)) + " " + name;
  }
  return passed(text);
}

Outcome named_as_file(const Subject& subject) {
  std::string held;
  for (const auto& [kind, name] : list_components(subject.file)) {
    if (subject.file.stem() == name) return passed();
    held += (held.empty() ? "" : ", ") + name;
  }
  return {Verdict::note, "the file holds " + held + ": a scene finds a component in <kind>/<name>.so only",
          "name the file after the component", NAN, NAN};
}

Outcome start_up_leaves_no_trace(const Subject& subject) {
  const ProcessState before;
  bool changed_float_mode = false;
  for (const auto& [kind, name] : list_components(subject.file))
    changed_float_mode = load_component(kind, name, subject.file).changed_float_mode || changed_float_mode;
  // The loader puts the floating-point mode back, so it is asked for.
  std::string trace = before.difference(ProcessState());
  if (changed_float_mode) trace = "the floating-point mode";
  if (!trace.empty())
    return failed("loading it changed " + trace,
                  "a plug-in runs no code when it is loaded; build without -ffast-math and without start-up code");
  return passed();
}

}  // namespace scree::core::vet
