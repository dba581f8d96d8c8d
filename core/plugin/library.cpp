#include "core/plugin/library.hpp"

#include <dlfcn.h>

#include <cstddef>
#include <fstream>
#include <vector>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "core/plugin/elf_check.hpp"
#include "core/plugin/header_check.hpp"
#include "core/plugin/sha256.hpp"
#include "core/plugin/stdout_catch.hpp"
#include "core/plugin/table_check.hpp"
#include "core/plugin/trust.hpp"

namespace scree::core {
namespace {

namespace fs = std::filesystem;
constexpr std::uintmax_t largest_library = std::uintmax_t{1} << 30;

/// Puts the floating-point mode back: code built with -ffast-math switches denormal numbers off for the whole thread
/// when it is loaded.
class FloatMode {
 public:
  ~FloatMode() { restore(); }
  bool restore() {
#if defined(__SSE__)
    constexpr unsigned exceptions = 0x3f;  // sticky bits say what happened, not how to compute
    const bool changed = ((_mm_getcsr() ^ mode_) & ~exceptions) != 0;
    _mm_setcsr(mode_);
    return changed;
#else
    return false;
#endif
  }

 private:
#if defined(__SSE__)
  unsigned mode_ = _mm_getcsr();
#endif
};

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
  throw Refusal(Exit::plugin, file.string() + ": " + why);
}

void* open_library(const fs::path& file) {
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle) return handle;
  const char* reason = dlerror();
  std::string why = reason ? reason : "unknown reason";
  if (const std::string prefix = file.string() + ": "; why.rfind(prefix, 0) == 0) why.erase(0, prefix.size());
  refuse(file, "the system cannot load it: " + why +
                   ": link every library it uses in scree_add_plugin(... LIBRARIES ...), and install them");
}

/// A library that passed the checks of its file and is open.
struct Opened {
  fs::path real;
  std::string sha256;
  const scree_plugin_header* header = nullptr;
  bool changed_float_mode = false;
};

Opened open_checked(const fs::path& file) {
  std::error_code error;
  Opened opened;
  opened.real = fs::canonical(file, error);
  const fs::path& real = opened.real;
  if (error) refuse(file, "cannot be read: " + error.message() + ": check the file and its permissions");
  for (const fs::path& path : {file.parent_path().parent_path(), file.parent_path(), real.parent_path(), real})
    require_trusted(path);
  const std::vector<std::byte> bytes = read_library(real);
  check_numbers(check_elf(bytes, real), real);
  opened.sha256 = sha256(bytes);

  FloatMode mode;
  void* handle = open_library(real);
  opened.changed_float_mode = mode.restore();
  opened.header = static_cast<const scree_plugin_header*>(dlsym(handle, "scree_plugin"));
  if (opened.header == nullptr)
    refuse(real, "the system does not find scree_plugin in it: build it with scree_add_plugin()");
  return opened;
}

}  // namespace

std::vector<std::byte> read_library(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) refuse(file, "not a file: a plug-in is a shared library");
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) refuse(file, "cannot be read: " + error.message() + ": check its permissions");
  if (size > largest_library) refuse(file, "larger than 1 GiB, which no plug-in is: check what lies there");
  std::vector<std::byte> bytes(size);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!in) refuse(file, "cannot be read: check its permissions");
  return bytes;
}

Loaded load_component(Kind kind, const std::string& name, const fs::path& file) {
  StdoutCatch said;
  const Opened opened = open_checked(file);
  const fs::path& real = opened.real;
  const scree_component& entry = find_component(*opened.header, kind, name, real);
  FloatMode mode;
  const void* theirs = entry.table();
  const bool changed = mode.restore() || opened.changed_float_mode;
  const std::shared_ptr<const void> table = checked_table(kind, name, theirs, real);

  Loaded loaded;
  loaded.changed_float_mode = changed;
  if (changed)
    loaded.remarks.push_back(
        "changed the floating-point mode when it was loaded, which was put back: build it without -ffast-math");
  if (const std::string text = said.take(); !text.empty())
    loaded.remarks.push_back("wrote to stdout when it was loaded, which was kept out of the results ('" + text +
                             "'): remove what writes there");
  loaded.component = {kind, entry.name,    entry.version, entry.doc ? entry.doc : "",
                      real, opened.sha256, table.get(),   table};
  return loaded;
}

std::vector<std::pair<Kind, std::string>> list_components(const fs::path& file) {
  const Opened opened = open_checked(file);
  return components_of(*opened.header, opened.real);
}

}  // namespace scree::core
