#pragma once
// A run in the background that signals and kills can reach.
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "support/paths.hpp"
#include "support/program.hpp"

namespace support {

/// `scree WORDS...` in a folder, going on while the test does something to it. Killed with this object.
class Started {
 public:
  /// `file_limit`: bytes that a file may have, as on a full disk; 0: no limit.
  Started(const std::vector<std::string>& words, const std::string& folder, rlim_t file_limit = 0)
      : out_(caught_ / "out"), err_(caught_ / "err") {
    const std::string program = support::binary_dir() + "/bin/scree";
    pid_ = ::fork();
    if (pid_ != 0) return;
    ::dup2(::open(out_.c_str(), O_WRONLY | O_CREAT, 0666), STDOUT_FILENO);
    ::dup2(::open(err_.c_str(), O_WRONLY | O_CREAT, 0666), STDERR_FILENO);
    if (::chdir(folder.c_str()) != 0) ::_exit(96);
    ::unsetenv("SCREE_PLUGIN_PATH");
    ::setenv("XDG_DATA_HOME", caught_.path().c_str(), 1);
    if (file_limit > 0) {
      const rlimit limit{file_limit, file_limit};
      if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) ::_exit(97);
    }
    std::vector<char*> argv{const_cast<char*>(program.c_str())};
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    ::execv(program.c_str(), argv.data());
    ::_exit(95);
  }
  ~Started() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    int status = 0;
    ::waitpid(pid_, &status, 0);
  }
  Started(const Started&) = delete;
  Started& operator=(const Started&) = delete;

  void send(int signal) const { ::kill(pid_, signal); }
  std::string err() const { return read_text(err_); }
  /// Waits until f() holds; false after a minute.
  template <class F>
  static bool eventually(F f) {
    const timespec pause{0, 5000000};
    for (int k = 0; k < 12000; ++k) {
      if (f()) return true;
      ::nanosleep(&pause, nullptr);
    }
    return false;
  }
  bool says(const std::string& text) const {
    return eventually([&] { return err().find(text) != std::string::npos; });
  }
  ProgramEnd wait() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = 0;
    ProgramEnd end;
    if (WIFEXITED(status)) end.code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
    end.out = read_text(out_);
    end.err = read_text(err_);
    return end;
  }

 private:
  TemporaryFolder caught_;
  std::string out_, err_;
  pid_t pid_ = 0;
};

}  // namespace support
