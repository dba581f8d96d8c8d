#pragma once
#include <spdlog/fmt/fmt.h>

#include <string>
#include <string_view>
#include <utility>

/// The program's log: plain lines on stderr and, once the output folder is known, in its log file. Losing a line (full
/// disk, closed terminal) never ends a run. [any thread]
namespace scree::core::log {

enum class Level { debug, info, warning, error };

struct Settings {
  bool quiet = false;    ///< stderr shows warnings and errors only
  bool silent = false;   ///< stderr shows nothing: the lines are for the file alone
  bool verbose = false;  ///< debug lines too, on stderr and in the file
  bool colour = true;    ///< false for --no-color; NO_COLOR and a stderr that is no terminal say the same
};

/// Sets what is shown. Lines logged before a file is opened are kept (the first 64 KiB) and go into it. [one thread]
void open(const Settings& settings);
/// Adds to the end of a file from now on; false with errno set when it cannot be opened, and the run goes on. [one
/// thread]
bool open_file(const std::string& path);
/// Closes the file; stderr stays. [one thread]
void close_file();
/// Lines that did not reach the file since it was opened.
unsigned long lines_lost();

void write(Level level, std::string_view text);

/// A line that is rewritten in place below the log lines (progress on a terminal). Log lines clear it first and draw it
/// again. An empty text takes it away.
void status_line(std::string_view text);

/// stderr is a terminal that can rewrite a line.
bool on_terminal();

template <class... A>
void debug(fmt::format_string<A...> format, A&&... arguments) {
  write(Level::debug, fmt::format(format, std::forward<A>(arguments)...));
}
template <class... A>
void info(fmt::format_string<A...> format, A&&... arguments) {
  write(Level::info, fmt::format(format, std::forward<A>(arguments)...));
}
template <class... A>
void warning(fmt::format_string<A...> format, A&&... arguments) {
  write(Level::warning, fmt::format(format, std::forward<A>(arguments)...));
}
template <class... A>
void error(fmt::format_string<A...> format, A&&... arguments) {
  write(Level::error, fmt::format(format, std::forward<A>(arguments)...));
}

}  // namespace scree::core::log
