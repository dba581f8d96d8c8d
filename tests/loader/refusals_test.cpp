// The checks of a library, from the inside; what each wrong one is told stands in sentences.txt.
#include <cstdlib>
#include <fstream>
#include <vector>

#include "core/plugin/elf_check.hpp"
#include "loader/plugin_folder.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"

namespace {
using namespace scree::test;
using scree::core::Catalogue;
using scree::core::Kind;

std::string refused(const std::string& library) {
  PluginFolder folder;
  folder.put(library);
  Catalogue catalogue = folder.catalogue();
  return refusal(folder, catalogue);
}

std::vector<std::byte> bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::vector<char> text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

}  // namespace

TEST_CASE("a right library opens and tells who it is") {
  PluginFolder folder;
  folder.put("good.so");
  Catalogue catalogue = folder.catalogue();
  const scree::core::Component& spring = catalogue.open(Kind::contact_model, "spring");
  CHECK(spring.name == "spring");
  CHECK(spring.version == "1.0.0");
  CHECK(spring.file == folder.file());
  CHECK(spring.sha256.size() == 64);
  CHECK(spring.property_count() == 1);
  CHECK(&catalogue.open(Kind::contact_model, "spring") == &spring);
  CHECK(catalogue.opened().size() == 1);
  CHECK(catalogue.warnings().empty());
}

TEST_CASE("what was built for another ABI is refused before any of its code runs") {
  unsetenv("SCREE_TEST_STARTED");
  CHECK(refused("newer_major.so") != "");
  CHECK(refused("newer_minor.so") != "");
  CHECK(std::getenv("SCREE_TEST_STARTED") == nullptr);
}

TEST_CASE("a library for another machine is told by its bytes") {
  std::vector<std::byte> other = bytes_of(std::filesystem::path(support::binary_dir()) / "tests/wrong/good.so");
  other[18] = std::byte{0xf3};  // e_machine: RISC-V
  CHECK_THROWS_WITH(scree::core::check_elf(other, "spring.so"),
                    "spring.so: built for another machine; this scree runs on 64-bit x86-64: build the plug-in on this "
                    "machine");
}

TEST_CASE("a library that is cut short anywhere or has any one byte changed never crashes the check") {
  const std::vector<std::byte> good = bytes_of(std::filesystem::path(support::binary_dir()) / "tests/wrong/good.so");
  REQUIRE(good.size() > 4096);
  CHECK_NOTHROW(scree::core::check_elf(good, "good.so"));
  std::size_t refusals = 0, tries = 0;
  const auto attempt = [&](const std::vector<std::byte>& bytes) {
    ++tries;
    try {
      scree::core::check_elf(bytes, "cut.so");
    } catch (const scree::core::Refusal& refused) {
      CHECK(refused.code() == scree::core::Exit::plugin);
      ++refusals;
    }
  };
  // Symbols and data end well before the section table, which the check does not read.
  for (std::size_t length = 0; length < 4096; length += 13)
    attempt({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)});
  CHECK(refusals == tries);
  for (std::size_t at = 0; at < good.size(); ++at) {
    std::vector<std::byte> bytes = good;
    bytes[at] ^= std::byte{0xff};
    attempt(bytes);
  }
  CHECK(refusals > 100);
}

TEST_CASE("a library that changes the floating-point mode does not change ours") {
  PluginFolder folder;
  folder.put("fast_math.so", "fast_math");
  Catalogue catalogue = folder.catalogue();
  CHECK(refusal(folder, catalogue, "fast_math") == "");
  volatile double tiny = 4e-320;  // denormal: zero in the mode that the library sets
  CHECK(tiny * 1.0 != 0.0);
  REQUIRE(catalogue.warnings().size() == 1);
  CHECK(catalogue.warnings()[0] == folder.file("fast_math").string() +
                                       ": changed the floating-point mode when it was loaded, which was put back: "
                                       "build it without -ffast-math");
}
