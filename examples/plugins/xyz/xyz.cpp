// Frames as text in the extended XYZ format, which OVITO and ASE read: a line with the number of balls, a line that
// says what the columns are, and a line per ball.
#include <scree/writer.hpp>

namespace {
using namespace scree;

struct Xyz {
  /// What a frame must hold; the kernel makes nothing else ready.
  static constexpr uint32_t wants = SCREE_WANTS_BALLS;

  std::string folder;

  /// This writer has no keys of its own.
  static void describe(Settings<Xyz>&) {}

  /// Once. `name` is that of the recorder in the scene.
  void open(const std::string& name, const Files&) { folder = name; }

  /// `shortest` writes a number with as many digits as it takes to read it back, without asking the locale.
  void frame(const scree_frame& frame, const Files& files) const {
    std::string text =
        std::to_string(frame.ball_count) + "\nTime=" + shortest(frame.time) + " Properties=id:I:1:pos:R:3:radius:R:1";
    for (uint32_t k = 0; k < frame.ball_array_count; ++k) {
      const scree_array& array = frame.ball_arrays[k];
      text += std::string(":") + array.name + ":R:" + std::to_string(array.components);
    }
    for (uint64_t row = 0; row < frame.ball_count; ++row) {
      text += "\n" + std::to_string(frame.ball_id[row]);
      for (const double* column : {frame.x, frame.y, frame.z, frame.radius}) text += " " + shortest(column[row]);
      for (uint32_t k = 0; k < frame.ball_array_count; ++k)
        for (uint32_t c = 0; c < frame.ball_arrays[k].components; ++c)
          text += " " + shortest(frame.ball_arrays[k].component[c][row]);
    }
    files.replace(folder + "/" + std::to_string(frame.index) + ".xyz", text + "\n");
  }
};

}  // namespace

SCREE_PLUGIN(scree::writer<Xyz>("xyz", "1.0.0", "frames in the extended XYZ format"))
