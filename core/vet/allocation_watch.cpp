#include "core/vet/allocation_watch.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string_view>

#include "core/vet/loaded_object.hpp"
#include "core/vet/outcome.hpp"

namespace scree::core::vet {

namespace {

volatile bool watching = false;
volatile std::size_t calls = 0;
void count() {
  if (watching) calls = calls + 1;
}

void* counted_malloc(std::size_t size) { return count(), std::malloc(size); }
void* counted_calloc(std::size_t n, std::size_t size) { return count(), std::calloc(n, size); }
void* counted_realloc(void* old, std::size_t size) { return count(), std::realloc(old, size); }
void* counted_aligned(std::size_t align, std::size_t size) { return count(), std::aligned_alloc(align, size); }
int counted_memalign(void** out, std::size_t align, std::size_t size) {
  return count(), ::posix_memalign(out, align, size);
}
void counted_free(void* old) { count(), std::free(old); }
void* counted_new(std::size_t size) { return count(), ::operator new(size); }
void* counted_new_nothrow(std::size_t size, const std::nothrow_t& no) { return count(), ::operator new(size, no); }
void* counted_new_aligned(std::size_t size, std::align_val_t align) { return count(), ::operator new(size, align); }
void counted_delete(void* old) { count(), ::operator delete(old); }
void counted_delete_sized(void* old, std::size_t) { count(), ::operator delete(old); }
void counted_delete_aligned(void* old, std::align_val_t align) { count(), ::operator delete(old, align); }

struct Substitute {
  std::string_view name;
  void* function;
};
template <class F>
void* address(F* f) {
  return reinterpret_cast<void*>(f);
}
const Substitute substitutes[] = {
    {"malloc", address(counted_malloc)},
    {"calloc", address(counted_calloc)},
    {"realloc", address(counted_realloc)},
    {"aligned_alloc", address(counted_aligned)},
    {"posix_memalign", address(counted_memalign)},
    {"free", address(counted_free)},
    {"_Znwm", address(counted_new)},
    {"_Znam", address(counted_new)},
    {"_ZnwmRKSt9nothrow_t", address(counted_new_nothrow)},
    {"_ZnamRKSt9nothrow_t", address(counted_new_nothrow)},
    {"_ZnwmSt11align_val_t", address(counted_new_aligned)},
    {"_ZnamSt11align_val_t", address(counted_new_aligned)},
    {"_ZdlPv", address(counted_delete)},
    {"_ZdaPv", address(counted_delete)},
    {"_ZdlPvm", address(counted_delete_sized)},
    {"_ZdaPvm", address(counted_delete_sized)},
    {"_ZdlPvSt11align_val_t", address(counted_delete_aligned)},
    {"_ZdaPvSt11align_val_t", address(counted_delete_aligned)},
};

void write_slot(std::size_t at, void* function) {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  void* begin = reinterpret_cast<void*>(at / page * page);
  if (::mprotect(begin, page, PROT_READ | PROT_WRITE) != 0)
    throw Skipped("this system does not let a table of the linker be changed");
  std::memcpy(reinterpret_cast<void*>(at), &function, sizeof function);
}

/// The dynamic section of a loaded object; addresses in it are absolute on glibc, relative on others.
struct Dynamic {
  explicit Dynamic(const LoadedObject& object) : base(object.base) {
    for (const auto& s : object.segments)
      if (s.p_type == PT_DYNAMIC) first = reinterpret_cast<const ElfW(Dyn)*>(base + s.p_vaddr);
  }
  std::size_t value(ElfW(Sxword) tag) const {
    for (const ElfW(Dyn)* d = first; d != nullptr && d->d_tag != DT_NULL; ++d)
      if (d->d_tag == tag) return d->d_un.d_val;
    return 0;
  }
  std::size_t pointer(ElfW(Sxword) tag) const {
    const std::size_t v = value(tag);
    return v == 0 || v >= base ? v : base + v;
  }
  std::size_t base;
  const ElfW(Dyn) * first = nullptr;
};

void substitute_in(const Dynamic& d, std::size_t table, std::size_t bytes) {
  const auto* symbols = reinterpret_cast<const ElfW(Sym)*>(d.pointer(DT_SYMTAB));
  const auto* strings = reinterpret_cast<const char*>(d.pointer(DT_STRTAB));
  if (symbols == nullptr || strings == nullptr || table == 0) return;
  const auto* entries = reinterpret_cast<const ElfW(Rela)*>(table);
  for (std::size_t k = 0; k < bytes / sizeof(ElfW(Rela)); ++k) {
    const auto type = ELF64_R_TYPE(entries[k].r_info);
#if defined(__aarch64__)
    if (type != R_AARCH64_JUMP_SLOT && type != R_AARCH64_GLOB_DAT) continue;
#else
    if (type != R_X86_64_JUMP_SLOT && type != R_X86_64_GLOB_DAT) continue;
#endif
    const std::string_view name = strings + symbols[ELF64_R_SYM(entries[k].r_info)].st_name;
    for (const Substitute& s : substitutes)
      if (name == s.name) write_slot(d.base + entries[k].r_offset, s.function);
  }
}

void watch_object(const LoadedObject& object) {
  const Dynamic d(object);
  if (d.first == nullptr) return;
  substitute_in(d, d.pointer(DT_JMPREL), d.value(DT_PLTRELSZ));
  substitute_in(d, d.pointer(DT_RELA), d.value(DT_RELASZ));
}

}  // namespace

AllocationWatch::AllocationWatch(const void* inside) {
  for (const LoadedObject& object : loaded_objects()) {
    const bool library =
        object.name.find("libstdc++") != std::string::npos || object.name.find("libc++") != std::string::npos;
    if (library || object.holds(inside)) watch_object(object);
  }
}

void AllocationWatch::begin() {
  calls = 0;
  watching = true;
}

std::size_t AllocationWatch::end() {
  watching = false;
  return calls;
}

}  // namespace scree::core::vet
