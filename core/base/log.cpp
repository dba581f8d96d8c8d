#include "core/base/log.hpp"

#include <fcntl.h>
#include <spdlog/logger.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <memory>
#include <mutex>

#include "core/base/file.hpp"

namespace scree::core::log {

namespace {

spdlog::level::level_enum level_of(Level level) {
  switch (level) {
    case Level::debug:
      return spdlog::level::debug;
    case Level::info:
      return spdlog::level::info;
    case Level::warning:
      return spdlog::level::warn;
    case Level::error:
      return spdlog::level::err;
  }
  return spdlog::level::err;
}

bool terminal_on_stderr() {
  const char* kind = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) != 0 && kind != nullptr && std::string_view(kind) != "dumb";
}

/// "warning: text" on stderr; errors that occur while writing are nobody's business.
class TerminalSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  void set_colour(bool colour) {
    const std::lock_guard lock(mutex_);
    colour_ = colour;
  }
  void set_status(std::string_view text) {
    const std::lock_guard lock(mutex_);
    std::string out;
    if (!status_.empty() || !text.empty()) out = "\r\x1b[K";
    status_ = text;
    out += status_;
    put(out);
  }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    std::string out;
    if (!status_.empty()) out += "\r\x1b[K";
    const bool warns = message.level == spdlog::level::warn, fails = message.level == spdlog::level::err;
    if (warns || fails) {
      if (colour_) out += fails ? "\x1b[1;31m" : "\x1b[1;33m";
      out += fails ? "error: " : "warning: ";
      if (colour_) out += "\x1b[0m";
    }
    out.append(message.payload.data(), message.payload.size());
    out += '\n';
    out += status_;
    put(out);
  }
  void flush_() override {}

 private:
  static void put(const std::string& text) {
    if (!text.empty()) write_all(STDERR_FILENO, text.data(), text.size());
  }
  bool colour_ = false;
  std::string status_;
};

/// Time, level, text. A write that fails loses the line and is counted.
class FileSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  FileSink() {
    set_formatter(std::make_unique<spdlog::pattern_formatter>("%Y-%m-%dT%H:%M:%S.%e %l: %v",
                                                              spdlog::pattern_time_type::utc, "\n"));
  }
  bool open(const std::string& path) {
    const std::lock_guard lock(mutex_);
    fd_ = Fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0666));
    if (!fd_) return false;
    lost_ = 0;
    put(early_);
    early_.clear();
    return true;
  }
  void close() {
    const std::lock_guard lock(mutex_);
    fd_.close();
  }
  unsigned long lost() const { return lost_; }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    const std::string_view text(line.data(), line.size());
    if (fd_)
      put(text);
    else if (early_.size() + text.size() <= 65536)
      early_ += text;
  }
  void flush_() override {}

 private:
  void put(std::string_view text) {
    if (!text.empty() && write_all(fd_.get(), text.data(), text.size()) != 0) ++lost_;
  }
  Fd fd_;
  std::string early_;
  std::atomic<unsigned long> lost_{0};
};

struct Log {
  std::shared_ptr<TerminalSink> terminal = std::make_shared<TerminalSink>();
  std::shared_ptr<FileSink> file = std::make_shared<FileSink>();
  spdlog::logger logger{"scree", {terminal, file}};

  Log() {
    logger.set_level(spdlog::level::debug);
    logger.set_error_handler([](const std::string&) {});
    set(Settings{});
  }
  void set(const Settings& settings) {
    const char* no_colour = std::getenv("NO_COLOR");
    const bool plain = no_colour != nullptr && *no_colour != '\0';
    terminal->set_colour(settings.colour && !plain && terminal_on_stderr());
    const auto shown = settings.verbose ? spdlog::level::debug : spdlog::level::info;
    const auto on_terminal = settings.quiet ? spdlog::level::warn : shown;
    terminal->set_level(settings.silent ? spdlog::level::off : on_terminal);
    file->set_level(shown);
  }
};

// Never destroyed: a thread or a destructor that logs late must find it.
Log& the_log() {
  static Log& log = *new Log;
  return log;
}

}  // namespace

void open(const Settings& settings) { the_log().set(settings); }
bool open_file(const std::string& path) { return the_log().file->open(path); }
void close_file() { the_log().file->close(); }
unsigned long lines_lost() { return the_log().file->lost(); }
void write(Level level, std::string_view text) {
  the_log().logger.log(level_of(level), spdlog::string_view_t(text.data(), text.size()));
}
void status_line(std::string_view text) { the_log().terminal->set_status(text); }
bool on_terminal() { return terminal_on_stderr(); }

}  // namespace scree::core::log
