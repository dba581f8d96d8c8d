#include "core/cli/program.hpp"

#include <CLI/CLI.hpp>
#include <csignal>
#include <filesystem>
#include <new>

#include "core/base/heap.hpp"
#include "core/base/log.hpp"
#include "core/base/nearest.hpp"
#include "core/cli/command.hpp"
#include "core/cli/output.hpp"
#include "core/run/signals.hpp"

namespace scree::core {

namespace {

std::string help_text() {
  std::size_t width = 0;
  for (const Command& command : commands()) width = std::max(width, command.name.size() + 1 + command.operands.size());
  std::string out = "scree " SCREE_VERSION ": discrete element simulation with plug-in physics\n\n";
  for (const Command& command : commands())
    out += fmt::format("scree {:<{}}  {}\n", command.name + " " + command.operands, width, command.line);
  return out + "\n`scree COMMAND -h` lists the flags of a command; -h and --version work without one.\n";
}

std::string suggested(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string near = nearest_name(word, candidates);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

const Command& command_of(const std::string& word) {
  std::vector<std::string> names;
  for (const Command& command : commands()) {
    if (command.name == word) return command;
    names.push_back(command.name);
  }
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  if (word[0] == '-')
    throw Refusal(Exit::usage, "unknown flag '" + word + "' before the command: flags follow it, as in scree run " +
                                   word + "; -h and --version stand alone");
  throw Refusal(Exit::usage, "unknown command '" + word + "'" + suggested(word, names) + "  (" + all + ")");
}

std::vector<std::string> flags_of(const CLI::App& app) {
  std::vector<std::string> out;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) out.push_back("--" + name);
    for (const std::string& name : option->get_snames()) out.push_back("-" + name);
  }
  return out;
}

/// What no flag and no operand took.
void refuse_rest(const CLI::App& app, const Command& command) {
  for (const std::string& word : app.remaining()) {
    const std::string name = word.substr(0, word.find('='));
    if (word.size() > 1 && word[0] == '-' && word != "--")
      throw Refusal(Exit::usage, "unknown flag '" + name + "'" + suggested(name, flags_of(app)) + "  (scree " +
                                     command.name + " -h lists them)");
  }
  for (const std::string& word : app.remaining())
    if (word != "--")
      throw Refusal(Exit::usage, "'" + word + "' is one word too many: scree " + command.name + " " + command.operands +
                                     "  (scree " + command.name + " -h says more)");
}

Exit run_command(const Command& command, const std::vector<std::string>& words) {
  CLI::App app(command.line, "scree " + command.name);
  app.allow_extras();
  const Deed deed = command.declare(app);
  try {
    // CLI11 takes the words from the back.
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::CallForHelp&) {
    print(app.help());
    return Exit::done;
  } catch (const CLI::ParseError& error) {
    refuse_rest(app, command);
    throw Refusal(Exit::usage,
                  std::string(error.what()) + "  (scree " + command.name + " -h lists operands and flags)");
  }
  refuse_rest(app, command);
  return deed();
}

Exit dispatch(std::vector<std::string> words) {
  if (words.empty()) {
    print_note(help_text());
    return Exit::usage;
  }
  const std::string first = words.front();
  if (first == "-h" || first == "--help") {
    print(help_text());
    return Exit::done;
  }
  if (first == "--version") {
    print("scree " SCREE_VERSION "\n");
    return Exit::done;
  }
  const Command& command = command_of(first);
  words.erase(words.begin());
  return run_command(command, words);
}

Exit guarded(const std::vector<std::string>& words) {
  try {
    return dispatch(words);
  } catch (const Refusal& refusal) {
    print_refusal(refusal);
    return refusal.code();
  } catch (const std::bad_alloc&) {
    print_note("error: out of memory: use fewer balls or a machine with more; scree explain says what a scene needs");
    return Exit::memory;
  } catch (const std::filesystem::filesystem_error& error) {
    log::error("{}", error.what());
    return Exit::io;
  } catch (const std::exception& error) {
    log::error("internal error: {}; please report it with the scene and the output of scree --version", error.what());
  } catch (...) {
    log::error("internal error; please report it with the scene and the output of scree --version");
  }
  return Exit::internal;
}

}  // namespace

int run_program(int count, char** words) {
  occupy_standard_streams();
  // A reader that went away is a write that fails, with a message and an exit code, not a death by signal.
  std::signal(SIGPIPE, SIG_IGN);
  install_crash_handler();
  tune_heap();
  log::open({});
  return static_cast<int>(guarded({words + std::min(count, 1), words + count}));
}

}  // namespace scree::core
