#pragma once
#include "core/scene/read.hpp"

namespace scree::core {

/// Property tables like those of the built-in plug-ins, so that the scene reader is tested without opening a library:
/// contact model linear; walls plane, box; generators random, file; processes gravity, local_damping; writers csv, vtk.
const OpenComponent& fake_components();

/// Reads a scene given as text, with the components above.
Scene read_text_scene(const std::string& text, std::vector<std::pair<std::string, std::string>> set = {});

/// The messages of a scene that is refused, joined by newlines; "" when it is accepted.
std::string refusal_of(const std::string& text);

}  // namespace scree::core
