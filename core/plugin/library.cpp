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

void* open_library(const fs::path& file) {
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle) return handle;
  const char* reason = dlerror();
  std::string why = reason ? reason : "unknown reason";
  if (const std::string prefix = file.string() + ": "; why.rfind(prefix, 0) == 0) why.erase(0, prefix.size());
  refuse(file, "the system cannot load it: " + why +
                   ": link every library it uses in scree_add_plugin(... LIBRARIES ...), and install them");
}

}  // namespace

Loaded load_component(Kind kind, const std::string& name, const fs::path& file) {
  std::error_code error;
  const fs::path real = fs::canonical(file, error);
  if (error) refuse(file, "cannot be read: " + error.message() + ": check the file and its permissions");
  for (const fs::path& path : {file.parent_path().parent_path(), file.parent_path(), real.parent_path(), real})
    require_trusted(path);
  const std::vector<std::byte> bytes = read_library(real);
  check_numbers(check_elf(bytes, real), real);

  FloatMode mode;
  void* handle = open_library(real);
  bool changed = mode.restore();
  const auto* header = static_cast<const scree_plugin_header*>(dlsym(handle, "scree_plugin"));
  if (header == nullptr) refuse(real, "the system does not find scree_plugin in it: build it with scree_add_plugin()");
  const scree_component& entry = find_component(*header, kind, name, real);
  const void* theirs = entry.table();
  changed = mode.restore() || changed;
  const std::shared_ptr<const void> table = checked_table(kind, name, theirs, real);

  Loaded loaded;
  loaded.changed_float_mode = changed;
  loaded.component = {kind, entry.name,    entry.version, entry.doc ? entry.doc : "",
                      real, sha256(bytes), table.get(),   table};
  return loaded;
}

}  // namespace scree::core
