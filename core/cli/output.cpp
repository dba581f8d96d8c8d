#include "core/cli/output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <string>

#include "core/base/file.hpp"
#include "core/base/log.hpp"

namespace scree::core {

void print(std::string_view text) {
  const int failure = write_all(STDOUT_FILENO, text.data(), text.size());
  if (failure != 0)
    throw Refusal(Exit::io, "cannot write to stdout: " + errno_text(failure) +
                                "; the result is cut off: send it to a place that takes it");
}

void print_note(std::string_view line) {
  log::status_line("");
  const std::string text = std::string(line) + "\n";
  write_all(STDERR_FILENO, text.data(), text.size());
}

void print_refusal(const Refusal& refusal) {
  const std::string text = refusal.what();
  if (text.find(": error: ") != std::string::npos)
    print_note(text);
  else
    log::write(log::Level::error, text);
}

void occupy_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    // In the direction that the stream is not used for, so that using it still fails. The lowest free number is taken,
    // which is this one, because those below were seen to first.
    if (::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0) return;
  }
}

}  // namespace scree::core
