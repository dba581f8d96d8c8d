#include <scree/writer.hpp>

#include <string>
#include <vector>

namespace {

using namespace scree;

/// A cell is quoted when its text would break the row (RFC 4180).
std::string quoted(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string cell = "\"";
  for (const char c : text) cell.append(c == '"' ? 2 : 1, c);
  return cell + '"';
}

/// A history: one row of quantities per frame.
struct Csv {
  static constexpr uint32_t wants = SCREE_WANTS_QUANTITIES;
  std::string file;

  static void describe(Settings<Csv>&) {}
  void open(const std::string& name, const Files&) { file = name + ".csv"; }

  /// `cycle` and `time` lead every row anyway.
  static bool repeats(std::string_view name) { return name == "cycle" || name == "time"; }

  void frame(const scree_frame& frame, const Files& files) const {
    std::string text;
    if (frame.index == 0) {
      text = "cycle,time";
      for (uint32_t k = 0; k < frame.quantity_count; ++k)
        if (!repeats(frame.quantity_names[k])) text += ',' + quoted(frame.quantity_names[k]);
      text += '\n';
    }
    text += std::to_string(frame.cycle) + ',' + shortest(frame.time);
    for (uint32_t k = 0; k < frame.quantity_count; ++k)
      if (!repeats(frame.quantity_names[k])) text += ',' + shortest(frame.quantities[k]);
    files.append(file, text + '\n');
  }
};

}  // namespace

SCREE_PLUGIN(scree::writer<Csv>("csv", "1.0.0", "history of quantities, one row per frame"))
