#pragma once
#include <memory>
#include <string>

#include "core/run/simulation.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

namespace support {

/// A scene from its text, with the plug-ins of this build, set up and ready to run. `balls` is the text of balls.csv
/// beside the scene.
class Simulated {
 public:
  explicit Simulated(const std::string& scene, const std::string& balls = "", unsigned threads = 1)
      : catalogue_(scree::core::SearchPath{{support::plugin_dir()}, {}}) {
    write_text(folder_ / "scene.yaml", scene);
    if (!balls.empty()) write_text(folder_ / "balls.csv", balls);
    scree::core::ReadOptions options;
    options.file = folder_ / "scene.yaml";
    simulation_ = std::make_unique<scree::core::Simulation>(read_scene(options, catalogue_), catalogue_, threads, 0);
    simulation_->set_up();
    simulation_->prepare();
  }
  scree::core::Simulation& operator*() { return *simulation_; }
  scree::core::Simulation* operator->() { return simulation_.get(); }
  const TemporaryFolder& folder() const { return folder_; }

 private:
  TemporaryFolder folder_;
  scree::core::Catalogue catalogue_;
  std::unique_ptr<scree::core::Simulation> simulation_;
};

}  // namespace support
