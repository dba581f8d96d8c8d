#pragma once
#include <sys/wait.h>
#include <unistd.h>

#include <string>

/// How a child process ended and what it wrote to stderr.
struct ChildEnd {
  int code = -1;   ///< exit status, -1 when a signal ended it
  int signal = 0;  ///< that signal, 0 when it exited
  std::string text;
};

/// Runs f in a forked child, with its stderr caught; the child ends with f's value by _exit. Kept for faults that must
/// not touch the test program: signals, limits, crashes.
template <class F>
ChildEnd in_child(F f) {
  int ends[2];
  if (::pipe(ends) != 0) return {};
  const pid_t pid = ::fork();
  if (pid == 0) {
    ::dup2(ends[1], STDERR_FILENO);
    ::close(ends[0]);
    ::close(ends[1]);
    int code = 99;
    try {
      code = f();
    } catch (...) {
      code = 98;
    }
    ::_exit(code);
  }
  ::close(ends[1]);
  ChildEnd end;
  char piece[4096];
  for (ssize_t n; (n = ::read(ends[0], piece, sizeof piece)) > 0;) end.text.append(piece, static_cast<size_t>(n));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(pid, &status, 0);
  if (WIFEXITED(status)) end.code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  return end;
}
