#pragma once
#include <link.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace scree::core::vet {

/// A library that lies in memory, as the dynamic linker tells of it.
struct LoadedObject {
  std::string name;
  std::size_t base = 0;
  std::vector<ElfW(Phdr)> segments;

  bool holds(const void* address) const;
  /// What its code may write: data and bss, without the part that is read-only after relocation.
  std::vector<std::span<const std::byte>> writable() const;
};

std::vector<LoadedObject> loaded_objects();
/// The one that holds an address, as that of a plug-in's function. Throws std::runtime_error when there is none.
LoadedObject object_of(const void* address);

/// The variables of a library as they are now.
class MemoryPicture {
 public:
  explicit MemoryPicture(const LoadedObject& object);
  /// How many bytes differ now.
  std::size_t changed() const;

 private:
  std::vector<std::span<const std::byte>> ranges_;
  std::vector<std::vector<std::byte>> bytes_;
};

}  // namespace scree::core::vet
