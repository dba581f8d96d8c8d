#include <scree/writer.hpp>

namespace {

using namespace scree;

/// A writer: all frames in one file in the XYZ format that many viewers read: the number of balls, a line of comment,
/// then name and position of each ball.
struct PluginName {
  // What a frame must hold; what no writer wants is not gathered.
  static constexpr uint32_t wants = SCREE_WANTS_BALLS;

  // What a scene gives. A key that it leaves out keeps the value written here.
  std::string label = "ball";
  double unit = 1;

  static void describe(Settings<PluginName>& s) {
    s.text("label", &PluginName::label, "name of every ball; 'ball' when absent");
    s.number("unit", &PluginName::unit, "m", "what positions are divided by").above(0);
  }

  // `name` is what the scene calls the record. Files are written through `files` only, below the output folder: the
  // program can then cut them back when a run goes on from a checkpoint.
  void open(const std::string& name, const Files&) { file_ = name + ".xyz"; }

  void frame(const scree_frame& frame, const Files& files) const {
    std::string text = std::to_string(frame.ball_count) + "\ntime " + shortest(frame.time) + " s\n";
    for (uint64_t k = 0; k < frame.ball_count; ++k)
      text += label + " " + shortest(frame.x[k] / unit) + " " + shortest(frame.y[k] / unit) + " " +
              shortest(frame.z[k] / unit) + "\n";
    files.append(file_, text);
  }

 private:
  std::string file_;
};

}  // namespace

SCREE_PLUGIN(scree::writer<PluginName>("plugin_name", "0.1.0", "positions of balls in the XYZ format"))
