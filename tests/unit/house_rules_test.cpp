// The rules of CONTRIBUTING.md that a machine can hold: sizes, names, forbidden calls, and a kernel that knows no
// physics.
#include <regex>
#include <set>

#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/source_scan.hpp"

namespace {

using scree::test::scan_folders;
using scree::test::scan_text;
using scree::test::SourceFile;

constexpr std::size_t longest_file = 500;

std::vector<SourceFile> all_sources() {
  return scan_folders(support::source_dir(), {"core", "sdk", "contact_models", "plugins", "tests", "examples"});
}
std::vector<SourceFile> product_sources() {
  return scan_folders(support::source_dir(), {"core", "sdk", "contact_models", "plugins"});
}

// PolyData is the name that VTK gives its file format.
bool bad_name(const std::string& code) {
  static const std::regex words(
      R"(\b(class|struct|enum|using|namespace)\s+(class\s+)?(?!PolyData\b)\w*(Manager|Helper|Util|Utils|Data)\b)");
  return std::regex_search(code, words);
}
bool unfinished(const std::string& comments) {
  static const std::regex words(R"(\b(TODO|FIXME|XXX|HACK)\b)");
  return std::regex_search(comments, words);
}
// Random numbers come from the keyed generator, numbers from text by <charconv>: neither asks the library or the
// locale.
bool forbidden_call(const std::string& code) {
  static const std::regex words(
      R"(\b(mt19937|random_device|(uniform|normal|lognormal)_\w*distribution|srand|stod|stof|atof|strtod|setlocale)\b)");
  return std::regex_search(code, words);
}
// Functions of the C library that round differently from machine to machine; sqrt does not.
bool forbidden_in_a_law(const std::string& code) {
  static const std::regex words(R"(\b(pow|exp|log|sin|cos|tan|atan2?|asin|acos|cbrt|fma)\s*\()");
  return std::regex_search(code, words);
}

std::set<std::string> folders_below(const std::filesystem::path& folder) {
  std::set<std::string> names;
  if (!std::filesystem::is_directory(folder)) return names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.is_directory()) names.insert(entry.path().filename().string());
  return names;
}

// The names of all components in the tree: each is a folder.
std::set<std::string> component_names() {
  const std::filesystem::path root = support::source_dir();
  std::set<std::string> names = folders_below(root / "contact_models");
  for (const char* kind : {"walls", "generators", "processes", "writers"})
    names.merge(folders_below(root / "plugins" / kind));
  return names;
}

}  // namespace

TEST_CASE("no file is longer than 500 lines", "[house]") {
  for (const SourceFile& file : all_sources()) {
    INFO(file.path << " has " << file.lines << " lines");
    CHECK(file.lines <= longest_file);
  }
}

TEST_CASE("names say what a thing is, and nothing is left for later", "[house]") {
  for (const SourceFile& file : all_sources()) {
    INFO(file.path);
    CHECK_FALSE(bad_name(file.code));
    CHECK_FALSE(unfinished(file.comments));
  }
}

TEST_CASE("numbers and randomness depend on neither library nor locale", "[house]") {
  for (const SourceFile& file : product_sources()) {
    INFO(file.path);
    CHECK_FALSE(forbidden_call(file.code));
  }
  for (const SourceFile& file : scan_folders(support::source_dir(), {"contact_models"})) {
    INFO(file.path);
    CHECK_FALSE(forbidden_in_a_law(file.code));
  }
}

TEST_CASE("the kernel names no plug-in component", "[house]") {
  const std::set<std::string> components = component_names();
  REQUIRE(components.count("linear") == 1);
  REQUIRE(components.count("gravity") == 1);
  for (const SourceFile& file : scan_folders(support::source_dir(), {"core"}))
    for (const std::string& text : file.strings) {
      INFO(file.path << " names the component \"" << text << "\"");
      CHECK(components.count(text) == 0);
    }
}

TEST_CASE("each broken house rule is seen", "[house]") {
  CHECK(bad_name("class BallManager {"));
  CHECK(bad_name("struct ContactData {"));
  CHECK_FALSE(bad_name("struct Impl; int data = 0; class PolyData {"));
  CHECK(unfinished(scan_text("int a;  // TO"
                             "DO: later\n")
                       .comments));
  CHECK(forbidden_call("std::mt19937 engine;"));
  CHECK(forbidden_call("x = std::stod(text);"));
  CHECK(forbidden_in_a_law("f = std::pow(gap, 1.5);"));
  CHECK_FALSE(forbidden_in_a_law("f = sqrt(gap) * gap;"));
}

TEST_CASE("the scanner tells code, comments and strings apart", "[house]") {
  const SourceFile file = scan_text(
      "#include <vector>\n"
      "int a = 1'000; // say \"no\"\n"
      "const char* b = \"it's // \\\"quoted\\\"\"; /* two\nlines */ char c = '\"';\n"
      "auto d = R\"(raw \" text)\";\n");
  CHECK(file.includes == std::vector<std::string>{"vector"});
  CHECK(file.strings == std::vector<std::string>{"it's // \\\"quoted\\\"", "raw \" text"});
  CHECK(file.code.find("1'000") != std::string::npos);
  CHECK(file.code.find("say") == std::string::npos);
  CHECK(file.comments.find("say \"no\"") != std::string::npos);
  CHECK(file.lines == 5);
}
