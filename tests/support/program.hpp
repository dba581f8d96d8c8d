#pragma once
// The built program as a user calls it: words in, exit code, stdout and stderr out.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

namespace support {

struct ProgramEnd {
  int code = -1;    ///< exit status, -1 when a signal ended it
  int signal = 0;   ///< that signal, 0 when it exited
  std::string out;  ///< stdout, unless it was sent elsewhere
  std::string err;
};

/// Runs `scree WORDS...` in a folder, with no plug-ins but those of this build. `out`: a file for stdout; "-" closes
/// it.
inline ProgramEnd scree(const std::vector<std::string>& words, const std::string& folder = ".", std::string out = "") {
  const TemporaryFolder caught;
  const std::string errors = caught / "err", program = support::binary_dir() + "/bin/scree";
  const bool keep = out.empty();
  if (keep) out = caught / "out";
  const pid_t pid = ::fork();
  if (pid == 0) {
    // Before stdout is closed, whose number the next file that is opened would take.
    ::dup2(::open(errors.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666), STDERR_FILENO);
    ::close(STDOUT_FILENO);
    if (out != "-" && ::open(out.c_str(), O_WRONLY | O_CREAT, 0666) != STDOUT_FILENO) ::_exit(97);
    if (::chdir(folder.c_str()) != 0) ::_exit(96);
    ::unsetenv("SCREE_PLUGIN_PATH");
    ::setenv("XDG_DATA_HOME", caught.path().c_str(), 1);
    std::vector<char*> argv{const_cast<char*>(program.c_str())};
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    ::execv(program.c_str(), argv.data());
    ::_exit(95);
  }
  int status = 0;
  ::waitpid(pid, &status, 0);
  ProgramEnd end;
  if (WIFEXITED(status)) end.code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  if (keep) end.out = read_text(out);
  end.err = read_text(errors);
  return end;
}

}  // namespace support
