#pragma once
#include <array>
#include <optional>
#include <string>

#include "core/plugin/catalogue.hpp"

namespace scree::core {

inline constexpr std::array all_kinds = {Kind::contact_model, Kind::wall, Kind::generator, Kind::process, Kind::writer};

/// "contact_model, wall, generator, process, writer"
std::string kind_words();

/// Nothing for "". Throws Refusal(Exit::usage) for a word that is no kind, with the nearest one.
std::optional<Kind> parse_kind(const std::string& word);

}  // namespace scree::core
