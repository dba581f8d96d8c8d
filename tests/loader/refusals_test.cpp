// Every way in which a library can be wrong has its own sentence, and none of its code runs before it is told.
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
const std::string file = "DIR/contact_model/spring.so: ";
const std::string model = file + "contact_model 'spring': ";
const std::string rebuild = ": build the plug-in with this SDK, or report it to its author";

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
  CHECK(refused("older_minor.so") == "");
}

TEST_CASE("wrong files are refused before any of their code runs") {
  unsetenv("SCREE_TEST_STARTED");
  CHECK(refused("newer_major.so") ==
        file + "built for scree ABI 2.0, this scree has 0.1: rebuild it with this SDK, or use a newer scree");
  CHECK(refused("newer_minor.so") ==
        file + "built for scree ABI 0.99, this scree has 0.1: rebuild it with this SDK, or use a newer scree");
  CHECK(std::getenv("SCREE_TEST_STARTED") == nullptr);
  CHECK(refused("no_symbol.so") == file +
                                       "it does not export scree_plugin, so it is not a scree plug-in: end one source "
                                       "file with SCREE_CONTACT_MODEL or SCREE_PLUGIN");
  CHECK(refused("bad_magic.so") == file +
                                       "its scree_plugin does not begin with the mark of a scree plug-in: end one "
                                       "source file with SCREE_PLUGIN and nothing else named scree_plugin");
  CHECK(refused("short_header.so") ==
        file + "its header has 8 bytes, at least 48 are needed: rebuild it with this SDK");
  CHECK(refused("no_components.so") ==
        file + "it lists 0 components, 1 to 256 are allowed: name them in SCREE_PLUGIN(...)");
  CHECK(refused("extra_export.so") == file +
                                          "it exports 'helper' besides scree_plugin, which could replace code of other "
                                          "libraries: build with hidden visibility, as scree_add_plugin() does");
  CHECK(refused("own_path.so") == file +
                                      "it carries its own search path for libraries (/opt/other), through which other "
                                      "code could come in: link without -rpath, as scree_add_plugin() does");
  CHECK(refused("program") == file + "a program, not a shared library: link it with scree_add_plugin()");
#if defined(__GNUC__) && !defined(__clang__)
  CHECK(refused("unique.so") == file +
                                    "the variable '_ZN7CounterIiE5countE' would be shared with other plug-ins (unique "
                                    "binding): build with hidden visibility, as scree_add_plugin() does");
#endif
}

TEST_CASE("a library that lacks something is refused with the reason") {
  CHECK(refused("needs_symbol.so") ==
        file +
            "the system cannot load it: undefined symbol: scree_test_function_that_does_not_exist: link every library "
            "it uses in scree_add_plugin(... LIBRARIES ...), and install them");
  CHECK(refused("two_components.so") ==
        file + "it holds two contact_model components named 'spring': give each its own name");
  CHECK(refused("wrong_kind.so") ==
        file + "'spring' is a writer, but it lies in a folder contact_model/: move it to a folder writer/");
  CHECK(refused("wrong_name.so") ==
        file +
            "it holds no contact_model 'spring' (it holds contact_model 'jkr'): the file must bear the name of its "
            "component");
}

TEST_CASE("a table that is not sound is refused with the reason") {
  CHECK(refused("no_table.so") == model + "its description failed, so there is nothing to use" + rebuild);
  CHECK(refused("short_table.so") == model + "its table has 16 bytes, at least " +
                                         std::to_string(sizeof(scree_contact_model)) + " are needed" + rebuild);
  CHECK(refused("short_property.so") ==
        model + "property 1 has 8 bytes, at least " + std::to_string(sizeof(scree_property)) + " are needed" + rebuild);
  CHECK(refused("no_stiffness.so") == model + "its function 'stiffness' is missing" + rebuild);
  CHECK(refused("outside_rule.so") == model + "property 'kn' lies outside the model's struct" + rebuild);
  CHECK(refused("bad_property.so") == model + "property 1 has no usable name (letters, digits, _)" + rebuild);
  CHECK(refused("bad_fallback.so") == model + "property 'kn' has a default outside its own bounds" + rebuild);
  CHECK(refused("bad_form.so") == model + "its input form 'kn ks' names 'ks', which is no property" + rebuild);
}

TEST_CASE("what is no library at all is refused") {
  PluginFolder folder;
  std::ofstream(folder.file()) << "kn: 1e6\n";
  Catalogue catalogue = folder.catalogue();
  CHECK(refusal(folder, catalogue) ==
        file + "not a shared library (it does not begin as an ELF file): a plug-in is built with scree_add_plugin()");
  std::ofstream(folder.file("empty"));
  std::filesystem::create_directory(folder.file("folder"));
  Catalogue more = folder.catalogue();
  CHECK(refusal(folder, more, "empty") ==
        "DIR/contact_model/empty.so: not a shared library (it does not begin as an ELF file): a plug-in is built with "
        "scree_add_plugin()");
  CHECK(refusal(folder, more, "folder") == "DIR/contact_model/folder.so: not a file: a plug-in is a shared library");
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
  folder.put("fast_math.so");
  Catalogue catalogue = folder.catalogue();
  CHECK(refusal(folder, catalogue) == "");
  volatile double tiny = 4e-320;  // denormal: zero in the mode that the library sets
  CHECK(tiny * 1.0 != 0.0);
  REQUIRE(catalogue.warnings().size() == 1);
  CHECK(catalogue.warnings()[0] == folder.file().string() +
                                       ": changed the floating-point mode when it was loaded, which was put back: "
                                       "build it without -ffast-math");
}
