#include "core/plugin/catalogue.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "core/base/nearest.hpp"
#include "core/plugin/library.hpp"

namespace scree::core {
namespace {

namespace fs = std::filesystem;
constexpr std::array all_kinds = {Kind::contact_model, Kind::wall, Kind::generator, Kind::process, Kind::writer};

/// Names come from scenes, so nothing that could lead out of a folder is a name.
bool good_name(const std::string& name) {
  if (name.empty() || name.size() > 64 || name.front() == '.') return false;
  return std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.';
  });
}

}  // namespace

const char* kind_name(Kind kind) {
  switch (kind) {
    case Kind::contact_model:
      return "contact_model";
    case Kind::wall:
      return "wall";
    case Kind::generator:
      return "generator";
    case Kind::process:
      return "process";
    case Kind::writer:
      return "writer";
  }
  return "component";
}

const scree_property* Component::properties() const {
  switch (kind) {
    case Kind::contact_model:
      return contact_model().properties;
    case Kind::wall:
      return wall().object.properties;
    case Kind::generator:
      return generator().object.properties;
    case Kind::process:
      return process().object.properties;
    case Kind::writer:
      return writer().object.properties;
  }
  return nullptr;
}

uint32_t Component::property_count() const {
  switch (kind) {
    case Kind::contact_model:
      return contact_model().property_count;
    case Kind::wall:
      return wall().object.property_count;
    case Kind::generator:
      return generator().object.property_count;
    case Kind::process:
      return process().object.property_count;
    case Kind::writer:
      return writer().object.property_count;
  }
  return 0;
}

struct Catalogue::Impl {
  std::vector<fs::path> folders;  // as searched, absolute
  std::vector<Found> found;
  std::map<std::pair<Kind, std::string>, std::vector<fs::path>>
      rivals;  // second files of a name, an error if asked for
  std::map<std::pair<Kind, std::string>, const Component*> by_name;
  std::vector<std::unique_ptr<Component>> opened;
  std::vector<std::string> warnings;
  std::set<fs::path> seen;

  void search(const fs::path& folder, bool from_command_line);
  void meet(Kind kind, const fs::path& file);
  const Found* winner(Kind kind, const std::string& name) const;
  [[noreturn]] void missing(Kind kind, const std::string& name) const;

  std::set<fs::path> commanded;  // folders from --plugins
};

void Catalogue::Impl::search(const fs::path& folder, bool from_command_line) {
  std::error_code error;
  const fs::path real = fs::canonical(folder, error);
  if (error || !fs::is_directory(real)) {
    if (from_command_line)
      throw Refusal(Exit::usage, "--plugins " + folder.string() +
                                     ": no such folder: give the folder that holds contact_model/, wall/, ...");
    folders.push_back(folder);
    return;
  }
  if (!seen.insert(real).second) return;
  folders.push_back(real);
  if (from_command_line) commanded.insert(real);
  for (const Kind kind : all_kinds) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(real / kind_name(kind), error))
      if (entry.path().extension() == ".so" && good_name(entry.path().stem().string())) files.push_back(entry.path());
    // The order in which a file system lists a folder is not defined.
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) meet(kind, file);
  }
}

void Catalogue::Impl::meet(Kind kind, const fs::path& file) {
  const std::string name = file.stem().string();
  const Found* first = winner(kind, name);
  Found now{kind, name, file, false};
  if (first != nullptr) {
    const bool shadows = commanded.count(first->file.parent_path().parent_path()) > 0;
    now.shadowed = shadows;
    if (shadows)
      warnings.push_back(first->file.string() + ": shadows " + file.string() +
                         ", because its folder was given with --plugins");
    else
      rivals[{kind, name}].push_back(file);
  }
  found.push_back(std::move(now));
}

const Found* Catalogue::Impl::winner(Kind kind, const std::string& name) const {
  for (const Found& f : found)
    if (f.kind == kind && f.name == name) return &f;
  return nullptr;
}

void Catalogue::Impl::missing(Kind kind, const std::string& name) const {
  std::vector<std::string> same_kind;
  std::string elsewhere;
  for (const Found& f : found) {
    if (f.kind == kind) same_kind.push_back(f.name);
    if (f.kind != kind && f.name == name) elsewhere = kind_name(f.kind);
  }
  std::string text = std::string("no ") + kind_name(kind) + " '" + name + "' is installed";
  if (const std::string near = nearest_name(name, same_kind); !near.empty())
    text += "; did you mean '" + near + "'?";
  else if (!elsewhere.empty())
    text += "; there is a " + elsewhere + " of that name.";
  else
    text += ".";
  text += " Looked in";
  for (std::size_t k = 0; k < folders.size(); ++k)
    text += (k == 0 ? " " : ", ") + (folders[k] / kind_name(kind)).string();
  if (folders.empty()) text += " no folder at all";
  text += ": put " + name + ".so into one of them, or give its folder with --plugins";
  throw Refusal(Exit::plugin, text);
}

Catalogue::Catalogue(SearchPath path) : impl_(std::make_unique<Impl>()) {
  for (const fs::path& folder : path.command_line) impl_->search(fs::absolute(folder), true);
  for (const fs::path& folder : path.others) impl_->search(folder, false);
}
Catalogue::~Catalogue() = default;

const Component& Catalogue::open(Kind kind, const std::string& name) {
  const std::pair<Kind, std::string> key{kind, name};
  if (const auto known = impl_->by_name.find(key); known != impl_->by_name.end()) return *known->second;
  if (!good_name(name))
    throw Refusal(Exit::plugin, "'" + name + "' is not the name of a " + kind_name(kind) +
                                    ": plug-ins are named by letters, digits, _, - and ., never by a path");
  const Found* first = impl_->winner(kind, name);
  if (first == nullptr) impl_->missing(kind, name);
  if (const auto rival = impl_->rivals.find(key); rival != impl_->rivals.end())
    throw Refusal(Exit::plugin, "two files hold the " + std::string(kind_name(kind)) + " '" + name +
                                    "': " + first->file.string() + " and " + rival->second.front().string() +
                                    ": remove one, or choose one by giving its folder with --plugins");
  Loaded loaded = load_component(kind, name, first->file);
  for (const std::string& remark : loaded.remarks) {
    impl_->warnings.push_back(first->file.string() + ": " + remark);
    if (warn) warn(impl_->warnings.back());
  }
  impl_->opened.push_back(std::make_unique<Component>(std::move(loaded.component)));
  return *(impl_->by_name[key] = impl_->opened.back().get());
}

bool Catalogue::exists(Kind kind, const std::string& name) const { return impl_->winner(kind, name) != nullptr; }
const std::vector<Found>& Catalogue::found() const { return impl_->found; }
std::vector<std::string> Catalogue::names(Kind kind) const {
  std::set<std::string> unique;
  for (const Found& f : impl_->found)
    if (f.kind == kind) unique.insert(f.name);
  return {unique.begin(), unique.end()};
}
std::vector<const Component*> Catalogue::opened() const {
  std::vector<const Component*> out;
  for (const auto& component : impl_->opened) out.push_back(component.get());
  return out;
}
std::vector<std::string> Catalogue::warnings() const { return impl_->warnings; }

}  // namespace scree::core
