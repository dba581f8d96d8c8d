#include "core/vet/isolated.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>

#include "core/base/error.hpp"
#include "core/base/file.hpp"

namespace scree::core::vet {

namespace {

using Clock = std::chrono::steady_clock;

// The end mark tells a whole answer from one that was cut off by an exit() in the plug-in's code.
constexpr char end_mark = '\x04';

[[noreturn]] void run_child(const std::function<std::string()>& work, int out) {
  ::setpgid(0, 0);
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPIPE}) std::signal(number, SIG_DFL);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
  if (nowhere > STDERR_FILENO) ::close(nowhere);
  const std::string bytes = work() + end_mark;
  const int failure = write_all(out, bytes.data(), bytes.size());
  ::_exit(failure == 0 ? 0 : 1);
}

/// Reads until the child closes its end; false when the time is over first.
bool read_until(int in, Clock::time_point deadline, std::string& bytes) {
  char piece[4096];
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return false;
    pollfd ready{in, POLLIN, 0};
    const int count = ::poll(&ready, 1, static_cast<int>(left < 1000 ? left : 1000));
    if (count < 0 && errno != EINTR) return true;
    if (count <= 0) continue;
    const ssize_t size = ::read(in, piece, sizeof piece);
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return true;
    bytes.append(piece, static_cast<std::size_t>(size));
  }
}

/// The status of a child that ended, or was killed because the time was over.
int reaped(pid_t child, Clock::time_point deadline, bool& timed_out) {
  int status = 0;
  while (!timed_out) {
    const pid_t ended = ::waitpid(child, &status, WNOHANG);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR) return 0;
    timed_out = Clock::now() >= deadline;
    ::usleep(200);
  }
  // Its own children go with it. The group may not exist yet, so the child is named as well.
  ::kill(-child, SIGKILL);
  ::kill(child, SIGKILL);
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

ChildEnd isolated(const std::function<std::string()>& work, double limit) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw Refusal(Exit::io, "cannot make a pipe: " + errno_text(errno) + ": close some programs and try again");
  const Fd in(ends[0]);
  Fd out(ends[1]);
  const pid_t child = ::fork();
  if (child < 0)
    throw Refusal(Exit::io, "cannot start a process: " + errno_text(errno) + ": close some programs and try again");
  if (child == 0) run_child(work, out.get());
  out.close();
  ChildEnd end;
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit));
  end.timed_out = !read_until(in.get(), deadline, end.bytes);
  const int status = reaped(child, deadline, end.timed_out);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  if (WIFEXITED(status)) end.code = WEXITSTATUS(status);
  end.finished = !end.timed_out && end.signal == 0 && !end.bytes.empty() && end.bytes.back() == end_mark;
  if (end.finished)
    end.bytes.pop_back();
  else
    end.bytes.clear();
  return end;
}

}  // namespace scree::core::vet
