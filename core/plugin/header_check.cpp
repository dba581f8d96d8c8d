#include "core/plugin/header_check.hpp"

#include <set>
#include <string_view>

#include "core/plugin/first_size.hpp"

namespace scree::core {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw Refusal(Exit::plugin, file.string() + ": " + why);
}

std::string version(uint32_t major, uint32_t minor) { return std::to_string(major) + "." + std::to_string(minor); }

uint64_t order(uint32_t major, uint32_t minor) { return (uint64_t{major} << 32) | minor; }

bool known_kind(uint32_t kind) { return kind >= SCREE_CONTACT_MODEL && kind <= SCREE_WRITER; }

std::vector<const scree_component*> sound_components(const scree_plugin_header& header,
                                                     const std::filesystem::path& file) {
  std::set<std::pair<uint32_t, std::string_view>> seen;
  std::vector<const scree_component*> list;
  const auto* first = reinterpret_cast<const char*>(header.components);
  if (first == nullptr) refuse(file, "its list of components is empty: name them in SCREE_PLUGIN(...)");
  for (uint32_t k = 0; k < header.component_count; ++k) {
    // The stride is the plug-in's own size: its components may be longer than those known here.
    const auto& c = *reinterpret_cast<const scree_component*>(first + std::size_t{k} * header.component_size);
    if (c.name == nullptr || c.version == nullptr || c.table == nullptr || !known_kind(c.kind))
      refuse(file, "component " + std::to_string(k + 1) +
                       " has no name, version, table or known kind: build it with the SDK's SCREE_PLUGIN");
    if (!seen.insert({c.kind, c.name}).second)
      refuse(file, std::string("it holds two ") + kind_name(static_cast<Kind>(c.kind)) + " components named '" +
                       c.name + "': give each its own name");
    list.push_back(&c);
  }
  return list;
}

}  // namespace

void check_numbers(const HeaderNumbers& n, const std::filesystem::path& file) {
  if (n.magic != SCREE_MAGIC)
    refuse(file,
           "its scree_plugin does not begin with the mark of a scree plug-in: end one source file with SCREE_PLUGIN "
           "and nothing else named scree_plugin");
  const std::string versions = "built for scree ABI " + version(n.abi_major, n.abi_minor) + ", this scree has " +
                               version(SCREE_ABI_MAJOR, SCREE_ABI_MINOR);
  if (n.abi_major != SCREE_ABI_MAJOR || n.abi_minor > SCREE_ABI_MINOR) {
    const bool newer = order(n.abi_major, n.abi_minor) > order(SCREE_ABI_MAJOR, SCREE_ABI_MINOR);
    refuse(file, versions + ": rebuild it with this SDK" + (newer ? ", or use a newer scree" : ""));
  }
  if (n.header_size < first_size<scree_plugin_header>)
    refuse(file, "its header has " + std::to_string(n.header_size) + " bytes, at least " +
                     std::to_string(first_size<scree_plugin_header>) + " are needed: rebuild it with this SDK");
  if (n.component_size < first_size<scree_component>)
    refuse(file, "its components have " + std::to_string(n.component_size) + " bytes, at least " +
                     std::to_string(first_size<scree_component>) + " are needed: rebuild it with this SDK");
  if (n.component_count == 0 || n.component_count > 256)
    refuse(file, "it lists " + std::to_string(n.component_count) +
                     " components, 1 to 256 are allowed: name them in SCREE_PLUGIN(...)");
}

std::vector<std::pair<Kind, std::string>> components_of(const scree_plugin_header& header,
                                                        const std::filesystem::path& file) {
  std::vector<std::pair<Kind, std::string>> list;
  for (const scree_component* c : sound_components(header, file))
    list.emplace_back(static_cast<Kind>(c->kind), c->name);
  return list;
}

const scree_component& find_component(const scree_plugin_header& header, Kind kind, const std::string& name,
                                      const std::filesystem::path& file) {
  const scree_component* wanted = nullptr;
  const scree_component* other_kind = nullptr;
  std::string listed;
  for (const scree_component* c : sound_components(header, file)) {
    listed += (listed.empty() ? "" : ", ") + std::string(kind_name(static_cast<Kind>(c->kind))) + " '" + c->name + "'";
    if (c->name != name) continue;
    (c->kind == static_cast<uint32_t>(kind) ? wanted : other_kind) = c;
  }
  if (wanted) return *wanted;
  if (other_kind) {
    const std::string actual = kind_name(static_cast<Kind>(other_kind->kind));
    refuse(file, "'" + name + "' is a " + actual + ", but it lies in a folder " + kind_name(kind) +
                     "/: move it to a folder " + actual + "/");
  }
  refuse(file, "it holds no " + std::string(kind_name(kind)) + " '" + name + "' (it holds " + listed +
                   "): the file must bear the name of its component");
}

}  // namespace scree::core
