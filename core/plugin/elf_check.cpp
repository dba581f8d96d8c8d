#include "core/plugin/elf_check.hpp"

#include <elf.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/plugin/first_size.hpp"

namespace scree::core {
namespace {

#if defined(__aarch64__)
constexpr Elf64_Half this_machine = EM_AARCH64;
constexpr const char* machine_name = "AArch64";
#else
constexpr Elf64_Half this_machine = EM_X86_64;
constexpr const char* machine_name = "x86-64";
#endif

/// One library file. Every read is checked against the file's size: the file may be anything.
class ElfFile {
 public:
  ElfFile(std::span<const std::byte> bytes, const std::filesystem::path& file) : bytes_(bytes), file_(file) {}

  HeaderNumbers check() {
    check_header();
    read_segments();
    read_dynamic();
    check_search_paths();
    return check_symbols();
  }
  ElfFacts facts() {
    check_header();
    read_segments();
    read_dynamic();
    ElfFacts facts;
    facts.executable_stack = executable_stack_;
    for (const Elf64_Dyn& e : entries_) {
      if (e.d_tag == DT_RPATH || e.d_tag == DT_RUNPATH) facts.search_paths.emplace_back(text(e.d_un.d_val));
      if (e.d_tag == DT_NEEDED) facts.needed.emplace_back(text(e.d_un.d_val));
      if (e.d_tag == DT_TEXTREL || (e.d_tag == DT_FLAGS && (e.d_un.d_val & DF_TEXTREL) != 0))
        facts.text_relocations = true;
    }
    for_each_export([&](const Elf64_Sym& symbol, const std::string& name) {
      facts.exports.push_back(name);
      if (ELF64_ST_BIND(symbol.st_info) == STB_GNU_UNIQUE) facts.shared.push_back(name);
    });
    return facts;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw Refusal(Exit::plugin, file_.string() + ": " + why); }
  [[noreturn]] void damaged() const { refuse("the file is cut short or damaged: build or install the plug-in again"); }

  template <class T>
  T read(uint64_t offset) const {
    if (offset > bytes_.size() || bytes_.size() - offset < sizeof(T)) damaged();
    T out;
    std::memcpy(&out, bytes_.data() + offset, sizeof out);
    return out;
  }
  /// The place in the file of an address in memory.
  uint64_t offset_of(uint64_t address) const {
    for (const Elf64_Phdr& s : loaded_)
      if (address >= s.p_vaddr && address - s.p_vaddr < s.p_filesz) return s.p_offset + (address - s.p_vaddr);
    damaged();
  }
  std::string_view text(uint64_t index) const {
    if (index >= strings_size_) damaged();
    const uint64_t begin = strings_ + index;
    if (begin >= bytes_.size()) damaged();
    const char* first = reinterpret_cast<const char*>(bytes_.data()) + begin;
    const std::size_t room = std::min<std::size_t>(bytes_.size() - begin, strings_size_ - index);
    const void* end = std::memchr(first, '\0', room);
    if (!end) damaged();
    return {first, static_cast<std::size_t>(static_cast<const char*>(end) - first)};
  }

  void check_header() {
    if (bytes_.size() < SELFMAG || std::memcmp(bytes_.data(), ELFMAG, SELFMAG) != 0)
      refuse("not a shared library (it does not begin as an ELF file): a plug-in is built with scree_add_plugin()");
    header_ = read<Elf64_Ehdr>(0);
    if (header_.e_ident[EI_CLASS] != ELFCLASS64 || header_.e_ident[EI_DATA] != ELFDATA2LSB ||
        header_.e_machine != this_machine)
      refuse(std::string("built for another machine; this scree runs on 64-bit ") + machine_name +
             ": build the plug-in on this machine");
    if (header_.e_type != ET_DYN) refuse("an ELF file, but not a shared library: link it with scree_add_plugin()");
    if (header_.e_phentsize != sizeof(Elf64_Phdr)) damaged();
  }

  void read_segments() {
    for (uint64_t k = 0; k < header_.e_phnum; ++k) {
      const auto segment = read<Elf64_Phdr>(header_.e_phoff + k * sizeof(Elf64_Phdr));
      if (segment.p_type == PT_LOAD) {
        if (segment.p_offset > bytes_.size() || bytes_.size() - segment.p_offset < segment.p_filesz) damaged();
        loaded_.push_back(segment);
      }
      if (segment.p_type == PT_DYNAMIC) dynamic_ = segment;
      if (segment.p_type == PT_GNU_STACK) executable_stack_ = (segment.p_flags & PF_X) != 0;
      if (segment.p_type == PT_INTERP) refuse("a program, not a shared library: link it with scree_add_plugin()");
    }
    if (dynamic_.p_type != PT_DYNAMIC) refuse("it has no dynamic section, so it is not a shared library");
  }

  void read_dynamic() {
    for (uint64_t at = 0; at + sizeof(Elf64_Dyn) <= dynamic_.p_filesz; at += sizeof(Elf64_Dyn)) {
      const auto entry = read<Elf64_Dyn>(dynamic_.p_offset + at);
      if (entry.d_tag == DT_NULL) break;
      entries_.push_back(entry);
    }
    const Elf64_Dyn* strings = entry(DT_STRTAB);
    const Elf64_Dyn* size = entry(DT_STRSZ);
    if (!strings || !size || !entry(DT_SYMTAB)) damaged();
    strings_ = offset_of(strings->d_un.d_ptr);
    strings_size_ = size->d_un.d_val;
  }
  const Elf64_Dyn* entry(Elf64_Sxword tag) const {
    for (const Elf64_Dyn& e : entries_)
      if (e.d_tag == tag) return &e;
    return nullptr;
  }

  void check_search_paths() const {
    for (const Elf64_Dyn& e : entries_) {
      if (e.d_tag == DT_RPATH || e.d_tag == DT_RUNPATH)
        refuse("it carries its own search path for libraries (" + std::string(text(e.d_un.d_val)) +
               "), through which other code could come in: link without -rpath, as scree_add_plugin() does");
      if (e.d_tag == DT_NEEDED && text(e.d_un.d_val).find('/') != std::string_view::npos)
        refuse("it asks for a library by path (" + std::string(text(e.d_un.d_val)) +
               "): link against an installed library by name");
    }
  }

  uint64_t symbol_count() const {
    if (const Elf64_Dyn* hash = entry(DT_HASH)) return read<uint32_t>(offset_of(hash->d_un.d_ptr) + 4);
    const Elf64_Dyn* hash = entry(DT_GNU_HASH);
    if (!hash) damaged();
    const uint64_t at = offset_of(hash->d_un.d_ptr);
    const uint64_t buckets = read<uint32_t>(at), first = read<uint32_t>(at + 4), filters = read<uint32_t>(at + 8);
    const uint64_t bucket_at = at + 16 + 8 * filters, chain_at = bucket_at + 4 * buckets;
    uint64_t last = 0;
    for (uint64_t k = 0; k < buckets; ++k) last = std::max<uint64_t>(last, read<uint32_t>(bucket_at + 4 * k));
    if (last < first) return first;
    while ((read<uint32_t>(chain_at + 4 * (last - first)) & 1u) == 0) ++last;
    return last + 1;
  }

  template <class F>
  void for_each_export(F f) const {
    const uint64_t table = offset_of(entry(DT_SYMTAB)->d_un.d_ptr), count = symbol_count();
    for (uint64_t k = 1; k < count; ++k) {
      const auto symbol = read<Elf64_Sym>(table + k * sizeof(Elf64_Sym));
      if (symbol.st_shndx == SHN_UNDEF || ELF64_ST_BIND(symbol.st_info) == STB_LOCAL) continue;
      const std::string name(text(symbol.st_name));
      // A library built for the address sanitizer marks each symbol it exports.
      if (name.starts_with("__odr_asan.")) continue;
      f(symbol, name);
    }
  }

  HeaderNumbers check_symbols() const {
    bool found = false;
    Elf64_Sym plugin{};
    for_each_export([&](const Elf64_Sym& symbol, const std::string& name) {
      if (ELF64_ST_BIND(symbol.st_info) == STB_GNU_UNIQUE)
        refuse("the variable '" + name +
               "' would be shared with other plug-ins (unique binding): build with hidden visibility, as "
               "scree_add_plugin() does");
      if (name != "scree_plugin")
        refuse("it exports '" + name +
               "' besides scree_plugin, which could replace code of other libraries: build with hidden visibility, as "
               "scree_add_plugin() does");
      found = true;
      plugin = symbol;
    });
    if (!found)
      refuse(
          "it does not export scree_plugin, so it is not a scree plug-in: end one source file with SCREE_CONTACT_MODEL "
          "or SCREE_PLUGIN");
    return read_numbers(plugin);
  }

  HeaderNumbers read_numbers(const Elf64_Sym& symbol) const {
    if (ELF64_ST_TYPE(symbol.st_info) != STT_OBJECT || symbol.st_size < 16)
      refuse("its scree_plugin is not the data that SCREE_PLUGIN writes: end one source file with SCREE_PLUGIN");
    const uint64_t at = offset_of(symbol.st_value);
    HeaderNumbers n{};
    n.magic = read<uint32_t>(at);
    n.header_size = read<uint32_t>(at + offsetof(scree_plugin_header, header_size));
    n.abi_major = read<uint32_t>(at + offsetof(scree_plugin_header, abi_major));
    n.abi_minor = read<uint32_t>(at + offsetof(scree_plugin_header, abi_minor));
    // A header of another version may be shorter; its version is reported, not its counts.
    if (symbol.st_size >= first_size<scree_plugin_header>) {
      n.component_count = read<uint32_t>(at + offsetof(scree_plugin_header, component_count));
      n.component_size = read<uint32_t>(at + offsetof(scree_plugin_header, component_size));
    }
    return n;
  }

  std::span<const std::byte> bytes_;
  const std::filesystem::path& file_;
  Elf64_Ehdr header_{};
  Elf64_Phdr dynamic_{};
  std::vector<Elf64_Phdr> loaded_;
  std::vector<Elf64_Dyn> entries_;
  uint64_t strings_ = 0, strings_size_ = 0;
  bool executable_stack_ = false;
};

}  // namespace

ElfFacts read_elf(std::span<const std::byte> bytes, const std::filesystem::path& file) {
  return ElfFile(bytes, file).facts();
}

HeaderNumbers check_elf(std::span<const std::byte> bytes, const std::filesystem::path& file) {
  return ElfFile(bytes, file).check();
}

}  // namespace scree::core
