#include "core/base/nearest.hpp"

#include <algorithm>
#include <cstddef>

namespace scree::core {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// Edits between two words; a swap of neighbours counts once (optimal string alignment).
std::size_t edits(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, now);
  }
  return last[b.size()];
}

std::size_t shared_start(const std::string& a, const std::string& b) {
  std::size_t k = 0;
  while (k < a.size() && k < b.size() && a[k] == b[k]) ++k;
  return k;
}

}  // namespace

std::string nearest_name(std::string_view text, const std::vector<std::string>& candidates) {
  // A wrong word can be as long as the scene's author likes; the table of edits must not be.
  if (text.empty() || text.size() > 64) return "";
  const std::string wanted = lower(text);
  std::string best;
  std::size_t best_distance = 0;
  for (const std::string& candidate : candidates) {
    if (candidate.empty() || candidate.size() > 64) continue;
    const std::string name = lower(candidate);
    std::size_t distance = edits(wanted, name);
    const std::size_t shorter = std::min(wanted.size(), name.size());
    const std::size_t tolerated = std::max<std::size_t>(1, std::max(wanted.size(), name.size()) / 3);
    if (distance > tolerated || distance >= shorter) {
      if (shorter < 3 || shared_start(wanted, name) < shorter) continue;
      distance = tolerated;
    }
    if (best.empty() || distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

}  // namespace scree::core
