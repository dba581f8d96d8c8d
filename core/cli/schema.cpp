#include "core/cli/schema.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "core/base/file.hpp"
#include "core/base/log.hpp"
#include "core/cli/command.hpp"
#include "core/cli/flags.hpp"
#include "core/cli/kinds.hpp"
#include "core/cli/output.hpp"

namespace scree::core {

std::string schema_text(Catalogue& catalogue) {
  std::vector<const Component*> components;
  for (const Kind kind : all_kinds)
    for (const std::string& name : catalogue.names(kind)) try {
        components.push_back(&catalogue.open(kind, name));
      } catch (const Refusal& refusal) {
        log::write(log::Level::warning, std::string(refusal.what()) + "; the schema does not know it");
      }
  return schema_text(components);
}

Deed declare_schema(CLI::App& app) {
  struct Flags {
    CommonFlags common;
    std::string output;
  };
  auto flags = std::make_shared<Flags>();
  app.add_option("-o,--output", flags->output, "the file to write; by default stdout")->type_name("FILE");
  flags->common.declare(app);
  return [flags] {
    flags->common.open_log();
    const auto catalogue = flags->common.catalogue();
    const std::string text = schema_text(*catalogue);
    if (flags->output.empty()) {
      print(text);
    } else if (const int failure = write_atomically(flags->output, text); failure != 0) {
      throw Refusal(Exit::io, flags->output + ": cannot write the schema: " + errno_text(failure) +
                                  ": choose another file with -o");
    }
    return Exit::done;
  };
}

}  // namespace scree::core
