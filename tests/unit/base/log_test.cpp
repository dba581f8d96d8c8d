#include "core/base/log.hpp"

#include "support/catch.hpp"
#include "support/child.hpp"
#include "support/temporary_folder.hpp"

using namespace scree::core;

TEST_CASE("log lines go to stderr with their level and to the file with the time") {
  const TemporaryFolder folder;
  const ChildEnd end = in_child([&] {
    log::open({});
    log::info("before the file {}", 1);
    log::debug("not shown");
    if (!log::open_file(folder / "log.txt")) return 1;
    log::warning("overlap {:.1f} %", 7.25);
    log::error("bad");
    return 0;
  });
  CHECK(end.code == 0);
  CHECK(end.text == "before the file 1\nwarning: overlap 7.2 %\nerror: bad\n");
  const std::string file = read_text(folder / "log.txt");
  CHECK(file.find("Z") == std::string::npos);
  CHECK(file.find(" info: before the file 1\n") == 23);
  CHECK(file.find(" warning: overlap 7.2 %\n") != std::string::npos);
  CHECK(file.find("not shown") == std::string::npos);
}

TEST_CASE("quiet and verbose change what is shown") {
  const TemporaryFolder folder;
  const ChildEnd quiet = in_child([&] {
    log::open({.quiet = true});
    log::open_file(folder / "log.txt");
    log::info("for the file");
    log::warning("for both");
    return 0;
  });
  CHECK(quiet.text == "warning: for both\n");
  CHECK(read_text(folder / "log.txt").find("for the file") != std::string::npos);
  const ChildEnd verbose = in_child([&] {
    log::open({.verbose = true});
    log::debug("detail");
    return 0;
  });
  CHECK(verbose.text == "detail\n");
}

TEST_CASE("a log line takes the status line away and draws it again") {
  const ChildEnd end = in_child([] {
    log::open({});
    log::status_line("41 %");
    log::info("saved");
    log::status_line("");
    return 0;
  });
  CHECK(end.text == "\r\x1b[K41 %\r\x1b[Ksaved\n41 %\r\x1b[K");
}
