#include "core/run/plugin_state.hpp"

#include "core/run/packing.hpp"

namespace scree::core {

void save_plugins(const Catalogue& catalogue, ArchiveWriter& out) {
  const auto opened = catalogue.opened();
  Packer packer;
  packer.u64(opened.size());
  for (const Component* component : opened) {
    packer.u64(static_cast<uint64_t>(component->kind));
    packer.text(component->name);
    packer.text(component->version);
    packer.text(component->sha256);
  }
  out.put("plugins", packer.bytes());
}

std::vector<std::string> check_plugins(const ArchiveReader& archive, Catalogue& catalogue, bool allow_change) {
  Unpacker in(archive, "plugins");
  std::vector<std::string> changed;
  for (uint64_t left = in.count(32); left > 0; --left) {
    const uint64_t kind = in.u64();
    const std::string name = in.text(), version = in.text(), sha = in.text();
    if (kind < SCREE_CONTACT_MODEL || kind > SCREE_WRITER) in.refuse("a plug-in of no known kind");
    const Component& now = catalogue.open(static_cast<Kind>(kind), name);
    if (now.sha256 == sha) continue;
    const std::string what = std::string(kind_name(now.kind)) + " '" + name + "'";
    if (!allow_change)
      throw Refusal(Exit::plugin, archive.path() + ": " + what + " is not the one that was saved with (version " +
                                      version + ", now " + now.version + " in " + now.file.string() +
                                      "): install the earlier one, or allow the change with --allow-plugin-change");
    changed.push_back(what);
  }
  in.finish();
  return changed;
}

}  // namespace scree::core
