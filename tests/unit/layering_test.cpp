// Who may include whom, and who alone uses which outside library: the table of docs/architecture.md.
#include <map>
#include <set>

#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/source_scan.hpp"

namespace {

using scree::test::SourceFile;

const std::map<std::string, std::set<std::string>> may_include = {
    {"sdk", {"sdk"}},
    {"contact_models", {"sdk"}},
    {"plugins", {"sdk"}},
    {"core/base", {"sdk", "core/base"}},
    {"core/world", {"sdk", "core/base", "core/world"}},
    {"core/plugin", {"sdk", "core/base", "core/plugin"}},
    {"core/contact", {"sdk", "core/base", "core/world", "core/plugin", "core/contact"}},
    {"core/cycle", {"sdk", "core/base", "core/world", "core/plugin", "core/contact", "core/cycle"}},
    {"core/scene", {"sdk", "core/base", "core/plugin", "core/scene"}},
    {"core/run",
     {"sdk", "core/base", "core/world", "core/plugin", "core/contact", "core/cycle", "core/scene", "core/run"}},
    {"core/vet", {"sdk", "core/base", "core/plugin", "core/vet"}},
    {"core/cli", {"sdk", "core/base", "core/plugin", "core/scene", "core/run", "core/vet", "core/cli"}},
    {"core", {"core/cli", "core/base"}},  // main.cpp
};

// Beginning of an outside header -> the only folder of the kernel that may include it.
const std::map<std::string, std::string> only_place = {
    {"spdlog/", "core/base"},     {"thread", "core/base"},
    {"mutex", "core/base"},       {"condition_variable", "core/base"},
    {"future", "core/base"},      {"barrier", "core/base"},
    {"latch", "core/base"},       {"semaphore", "core/base"},
    {"pthread.h", "core/base"},   {"dlfcn.h", "core/plugin"},
    {"openssl/", "core/plugin"},  {"yaml-cpp/", "core/scene"},
    {"udunits2.h", "core/scene"}, {"muParser", "core/scene"},
    {"CLI/", "core/cli"},
};

// The row of the table a file belongs to: its longest prefix.
std::string layer_of(const std::string& path) {
  std::string best;
  for (const auto& [layer, allowed] : may_include)
    if (path.compare(0, layer.size() + 1, layer + "/") == 0 && layer.size() > best.size()) best = layer;
  return best;
}

// The layer that an include names; "" for a header that is not ours or lies beside the file.
std::string target_of(const std::string& include) {
  if (include.compare(0, 6, "scree/") == 0) return "sdk";
  for (const char* top : {"core/", "contact_models/", "plugins/", "tests/"})
    if (include.compare(0, std::string(top).size(), top) == 0) {
      const std::string layer = layer_of(include);
      return layer.empty() ? include : layer;
    }
  return "";
}

bool is_standard(const std::string& include) {
  static const std::set<std::string> c_headers = {"stddef.h", "stdint.h"};
  return include.find('/') == std::string::npos &&
         (include.find('.') == std::string::npos || c_headers.count(include) > 0);
}

std::vector<std::string> violations(const SourceFile& file) {
  std::vector<std::string> found;
  const std::string layer = layer_of(file.path);
  if (layer.empty()) return {file.path + ": lies in no folder of the table"};
  for (const std::string& include : file.includes) {
    const std::string target = target_of(include);
    if (!target.empty() && may_include.at(layer).count(target) == 0)
      found.push_back(file.path + ": " + layer + " may not include " + include);
    if (layer == "sdk" && target.empty() && !is_standard(include))
      found.push_back(file.path + ": the sdk includes no outside header, here " + include);
    if (include.find("..") != std::string::npos) found.push_back(file.path + ": includes upwards, " + include);
    if (layer.compare(0, 4, "core") != 0) continue;
    for (const auto& [prefix, place] : only_place)
      if (include.compare(0, prefix.size(), prefix) == 0 && layer != place)
        found.push_back(file.path + ": only " + place + " may include " + include);
  }
  return found;
}

SourceFile file_with(const std::string& path, const std::string& text) {
  SourceFile file = scree::test::scan_text(text);
  file.path = path;
  return file;
}

}  // namespace

TEST_CASE("the include table is held", "[layering]") {
  const auto files =
      scree::test::scan_folders(support::source_dir(), {"core", "sdk/include", "contact_models", "plugins"});
  REQUIRE(files.size() > 10);
  std::size_t includes = 0;
  for (const SourceFile& file : files) {
    includes += file.includes.size();
    for (const std::string& violation : violations(file)) FAIL_CHECK(violation);
  }
  CHECK(includes > files.size());
}

TEST_CASE("each kind of layering mistake is seen", "[layering]") {
  CHECK(violations(file_with("core/scene/a.cpp", "#include \"core/world/balls.hpp\"\n")).size() == 1);
  CHECK(violations(file_with("plugins/walls/plane/plane.cpp", "#include \"core/base/error.hpp\"\n")).size() == 1);
  CHECK(violations(file_with("sdk/include/scree/a.hpp", "# include <Eigen/Dense>\n")).size() == 1);
  CHECK(violations(file_with("core/world/a.cpp", "#include <thread>\n")).size() == 1);
  CHECK(violations(file_with("core/cli/a.cpp", "#include <dlfcn.h>\n")).size() == 1);
  CHECK(violations(file_with("core/base/a.cpp", "#include \"../world/a.hpp\"\n")).size() == 1);
  CHECK(violations(file_with("core/novel/a.cpp", "#include \"core/novel/a.hpp\"\n")).size() == 1);
  CHECK(violations(file_with("core/cycle/a.cpp", "#include <vector>\n#include \"core/base/error.hpp\"\n")).empty());
}
