#pragma once
#include <string>
#include <utility>
#include <vector>

namespace scree::core {

/// Words of a template and what stands for them: `plugin_name` and the name, ...
using Substitutions = std::vector<std::pair<std::string, std::string>>;

/// The text with each word replaced; what was put in is not looked at again.
std::string substituted(const std::string& text, const Substitutions& words);

/// Makes the folder `to` from the files of `sources`, later ones in place of earlier ones of the same name. Words are
/// replaced in names and texts, and a name that begins with `dot_` gets a dot. Returns the names of the files, sorted.
/// Refuses (exit 6) a folder that exists and what cannot be read or written.
std::vector<std::string> fill_template(const std::vector<std::string>& sources, const std::string& to,
                                       const Substitutions& words);

}  // namespace scree::core
