#include "core/cli/template.hpp"

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "core/base/error.hpp"
#include "core/base/file.hpp"

namespace scree::core {

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw Refusal(Exit::io, file.string() + ": cannot be read: install scree again");
  return text.str();
}

std::string name_of(const fs::path& file, const Substitutions& words) {
  std::string name = substituted(file.filename().string(), words);
  if (name.starts_with("dot_")) name.replace(0, 4, ".");
  return name;
}

}  // namespace

std::string substituted(const std::string& text, const Substitutions& words) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t taken = 0;
    for (const auto& [word, value] : words) {
      if (text.compare(at, word.size(), word) != 0) continue;
      out += value;
      taken = word.size();
      break;
    }
    if (taken == 0) out += text[at];
    at += std::max<std::size_t>(taken, 1);
  }
  return out;
}

std::vector<std::string> fill_template(const std::vector<std::string>& sources, const std::string& to,
                                       const Substitutions& words) {
  if (fs::exists(fs::symlink_status(to)))
    throw Refusal(Exit::io, to + ": exists already and is left alone: choose another name, or another place with -o");
  std::map<std::string, std::string> files;
  for (const std::string& source : sources) {
    if (!fs::is_directory(source))
      throw Refusal(Exit::io, source + ": the templates are not installed: install scree again");
    for (const auto& entry : fs::directory_iterator(source))
      files[name_of(entry.path(), words)] = substituted(text_of(entry.path()), words);
  }
  std::error_code error;
  fs::create_directories(to, error);
  if (error) throw Refusal(Exit::io, to + ": cannot make the folder: " + error.message() + ": choose another with -o");
  std::vector<std::string> names;
  for (const auto& [name, text] : files) {
    const std::string path = (fs::path(to) / name).string();
    if (const int failure = write_atomically(path, text); failure != 0)
      throw Refusal(Exit::io, path + ": cannot write it: " + errno_text(failure) + ": remove " + to +
                                  ", or choose another place with -o");
    names.push_back(name);
  }
  return names;
}

}  // namespace scree::core
