#include "core/vet/outcome.hpp"

#include <array>
#include <charconv>

namespace scree::core::vet {

namespace {

constexpr std::array names = {"pass", "note", "info", "skip", "FAIL"};
constexpr char separator = '\x1f';

std::string number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

double number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) throw std::runtime_error("no number");
  return value;
}

}  // namespace

const char* verdict_name(Verdict verdict) { return names[static_cast<std::size_t>(verdict)]; }

std::string Outcome::packed() const {
  std::string out = std::to_string(static_cast<int>(verdict));
  for (const std::string& field : {found, next, number(figure), number(tolerance)}) out += separator + field;
  return out + separator;
}

Outcome Outcome::unpacked(const std::string& bytes) {
  std::array<std::string, 5> field;
  std::size_t at = 0;
  for (std::string& text : field) {
    const std::size_t end = bytes.find(separator, at);
    if (end == std::string::npos) throw std::runtime_error("cut short");
    text = bytes.substr(at, end - at);
    at = end + 1;
  }
  const auto verdict = static_cast<std::size_t>(number(field[0]));
  if (verdict >= names.size()) throw std::runtime_error("no verdict");
  return {static_cast<Verdict>(verdict), field[1], field[2], number(field[3]), number(field[4])};
}

Outcome Worst::judged(double tolerance, const std::string& next) const {
  if (seen_ == 0) throw Skipped("no case of the law's inputs reached what this check looks at");
  const bool good = figure_ <= tolerance;
  return {good ? Verdict::pass : Verdict::fail, good ? "" : where_, good ? "" : next, figure_, tolerance};
}

}  // namespace scree::core::vet
