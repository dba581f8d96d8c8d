// Where plug-ins are looked for, which file wins, and who may have written it.
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

#include "core/base/nearest.hpp"
#include "loader/plugin_folder.hpp"
#include "support/catch.hpp"

namespace {
using namespace scree::test;
using scree::core::Catalogue;
using scree::core::Exit;
using scree::core::Kind;
using scree::core::Refusal;
using scree::core::SearchPath;
namespace fs = std::filesystem;

/// Sets an environment variable for the length of a test.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    const char* old = std::getenv(name);
    had_ = old != nullptr;
    if (had_) old_ = old;
    setenv(name, value.c_str(), 1);
  }
  ~Environment() { had_ ? setenv(name_, old_.c_str(), 1) : unsetenv(name_); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  bool had_ = false;
  std::string old_;
};

}  // namespace

TEST_CASE("the standard path: command line, SCREE_PLUGIN_PATH, the user's data, the installation") {
  Environment listed("SCREE_PLUGIN_PATH", "/opt/a::/opt/b");
  Environment data("XDG_DATA_HOME", "/home/anna/.data");
  const SearchPath path = SearchPath::standard({"mine"});
  REQUIRE(path.command_line.size() == 1);
  REQUIRE(path.others.size() == 4);
  CHECK(path.others[0] == "/opt/a");
  CHECK(path.others[1] == "/opt/b");
  CHECK(path.others[2] == "/home/anna/.data/scree/plugins");
  CHECK(fs::exists(path.others[3] / "contact_model" / "linear.so"));
  {
    Environment relative("XDG_DATA_HOME", "data"), home("HOME", "/home/anna");
    CHECK(SearchPath::standard({}).others[2] == "/home/anna/.local/share/scree/plugins");
  }
  Environment relative("SCREE_PLUGIN_PATH", "/opt/a:plugins");
  CHECK_THROWS_WITH(SearchPath::standard({}),
                    "SCREE_PLUGIN_PATH: 'plugins' depends on the working directory, from which plug-ins are never "
                    "loaded: write an absolute path");
}

TEST_CASE("a library in the working directory or reached by a path is not opened") {
  PluginFolder here, empty;
  here.put("good.so");
  fs::copy_file(here.file(), here.path() / "spring.so");
  const fs::path before = fs::current_path();
  fs::current_path(here.path());
  Catalogue catalogue = empty.catalogue();
  CHECK(refusal(empty, catalogue) ==
        "no contact_model 'spring' is installed. Looked in DIR/contact_model: put spring.so into one of them, or give "
        "its folder with --plugins");
  for (const char* name : {"../contact_model/spring", "./spring", ".spring", "", "a/b"})
    CHECK(refusal(empty, catalogue, name) ==
          std::string("'") + name +
              "' is not the name of a contact_model: plug-ins are named by letters, digits, _, - and ., never by a "
              "path");
  fs::current_path(before);
}

TEST_CASE("a missing plug-in: where it was looked for, and what was meant") {
  PluginFolder folder, other;
  folder.put("good.so");
  Catalogue catalogue(SearchPath{{}, {folder.path(), other.path(), "/nowhere/scree"}});
  CHECK(refusal(folder, catalogue, "sprign") ==
        "no contact_model 'sprign' is installed; did you mean 'spring'? Looked in DIR/contact_model, " +
            other.path().string() +
            "/contact_model, /nowhere/scree/contact_model: put sprign.so into one of them, or give its folder with "
            "--plugins");
  try {
    catalogue.open(Kind::wall, "spring");
    FAIL("a wall was found");
  } catch (const Refusal& refused) {
    CHECK(std::string(refused.what()).find("no wall 'spring' is installed; there is a contact_model of that name") ==
          0);
  }
  CHECK(catalogue.exists(Kind::contact_model, "spring"));
  CHECK(!catalogue.exists(Kind::wall, "spring"));
  CHECK(catalogue.names(Kind::contact_model) == std::vector<std::string>{"spring"});
}

TEST_CASE("two files of one name are an error that names both") {
  PluginFolder first, second;
  first.put("good.so");
  second.put("good.so");
  Catalogue catalogue(SearchPath{{}, {first.path(), second.path()}});
  CHECK(refusal(first, catalogue) == "two files hold the contact_model 'spring': DIR/contact_model/spring.so and " +
                                         second.file().string() +
                                         ": remove one, or choose one by giving its folder with --plugins");
  // The same folder met twice is one folder.
  Catalogue twice(SearchPath{{}, {first.path(), first.path()}});
  CHECK(refusal(first, twice) == "");
}

TEST_CASE("a folder given with --plugins shadows the others, with a warning") {
  PluginFolder mine, installed;
  mine.put("good.so");
  installed.put("bad_magic.so");
  Catalogue catalogue(SearchPath{{mine.path()}, {installed.path()}});
  CHECK(refusal(mine, catalogue) == "");
  CHECK(catalogue.open(Kind::contact_model, "spring").file == mine.file());
  REQUIRE(catalogue.found().size() == 2);
  CHECK(!catalogue.found()[0].shadowed);
  CHECK(catalogue.found()[1].shadowed);
  CHECK(catalogue.warnings() ==
        std::vector<std::string>{mine.file().string() + ": shadows " + installed.file().string() +
                                 ", because its folder was given with --plugins"});
  try {
    Catalogue none(SearchPath{{"/nowhere/scree"}, {}});
    FAIL("a folder that does not exist was accepted");
  } catch (const Refusal& refused) {
    CHECK(refused.code() == Exit::usage);
    CHECK(std::string(refused.what()) ==
          "--plugins /nowhere/scree: no such folder: give the folder that holds contact_model/, wall/, ...");
  }
}

TEST_CASE("files and folders that others could change are refused") {
  const std::string why = ", so anybody could change the code that would run here: chmod o-w ";
  PluginFolder folder;
  folder.put("good.so");
  chmod(folder.file().c_str(), 0666);
  Catalogue catalogue = folder.catalogue();
  CHECK(refusal(folder, catalogue) ==
        "DIR/contact_model/spring.so: everybody may write to this file" + why + "DIR/contact_model/spring.so");
  chmod(folder.file().c_str(), 0644);
  chmod((folder.path() / "contact_model").c_str(), 0777);
  CHECK(refusal(folder, catalogue) ==
        "DIR/contact_model: everybody may write to this folder" + why + "DIR/contact_model");
  chmod((folder.path() / "contact_model").c_str(), 0755);
  chmod(folder.path().c_str(), 0777);
  CHECK(refusal(folder, catalogue) == "DIR: everybody may write to this folder" + why + "DIR");
  chmod(folder.path().c_str(), 0700);
  CHECK(refusal(folder, catalogue) == "");
}

TEST_CASE("a link leads to the checks of the file it points to") {
  PluginFolder folder, target;
  target.put("good.so", "real");
  fs::create_symlink(target.file("real"), folder.file());
  chmod((target.path() / "contact_model").c_str(), 0777);
  Catalogue catalogue = folder.catalogue();
  CHECK(refusal(folder, catalogue) == (target.path() / "contact_model").string() +
                                          ": everybody may write to this folder, so anybody could change the code that "
                                          "would run here: chmod o-w " +
                                          (target.path() / "contact_model").string());
  chmod((target.path() / "contact_model").c_str(), 0755);
  CHECK(refusal(folder, catalogue) == "");
}

TEST_CASE("a library of another user is refused") {
  if (geteuid() != 0) {
    WARN("skipped: only root can give a file away");
    return;
  }
  PluginFolder folder;
  folder.put("good.so");
  REQUIRE(chown(folder.file().c_str(), 12345, 12345) == 0);
  Catalogue catalogue = folder.catalogue();
  CHECK(refusal(folder, catalogue) ==
        "DIR/contact_model/spring.so: this file belongs to another user, who could change the code that would run "
        "here: copy it to a folder of your own and check it");
}

TEST_CASE("the nearest name") {
  using scree::core::nearest_name;
  const std::vector<std::string> names = {"kn", "ks", "fric", "dp_nratio", "dp_sratio", "emod"};
  CHECK(nearest_name("frictoin", names) == "fric");
  CHECK(nearest_name("firc", names) == "fric");
  CHECK(nearest_name("dp_nratoi", names) == "dp_nratio");
  CHECK(nearest_name("DP_SRATIO", names) == "dp_sratio");
  CHECK(nearest_name("kt", names) == "kn");
  CHECK(nearest_name("temperature", names) == "");
  CHECK(nearest_name("", names) == "");
  CHECK(nearest_name(std::string(100000, 'k'), names) == "");
}
