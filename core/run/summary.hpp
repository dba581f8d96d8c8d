#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"

namespace scree::core {

inline constexpr const char* summary_schema = "scree-summary/1";

struct ExpectationResult {
  std::string text{};  ///< as the scene wrote it
  std::string quantity{};
  double value = 0;
  bool passed = false;
  std::optional<double> low{}, high{}, equals{}, tolerance{}, difference{};
  std::string source{};  ///< where the expected value comes from
};

/// summary.json of a run. What is empty here is absent there: never null, never a zero that means "not asked for".
/// Numbers that JSON lacks are the texts "NaN", "Infinity", "-Infinity"; hashes are 16 hexadecimal digits.
struct Summary {
  using Named = std::vector<std::pair<std::string, double>>;
  struct Timestep {
    double used = 0;                    ///< s
    std::optional<double> certified{};  ///< s
    std::string governed_by{};
  };
  struct Energy {
    std::optional<double> residual{};  ///< share of the energy put in
    Named terms{};                     ///< J
  };
  struct Error {
    std::optional<double> estimate{}, reference{};
    std::string method{};
  };
  struct Plugin {
    std::string kind{}, name{}, version{}, sha256{}, shadowed{};
  };

  Exit exit_code = Exit::done;
  std::string message;  ///< why it ended, unless all went well
  std::string program_version, title, scene;
  std::optional<uint64_t> seed, threads;
  std::string isa;
  std::optional<uint64_t> cycles;
  std::optional<double> model_time, wall_time;  ///< s
  std::optional<double> ball_steps_per_second;
  std::optional<uint64_t> peak_memory_bytes, balls, contacts;
  std::optional<Timestep> timestep;
  std::optional<Energy> energy;
  Named quantities;
  std::vector<ExpectationResult> expectations;
  std::optional<Error> error;
  std::optional<uint64_t> state_hash;
  std::vector<std::string> left_out;
  std::vector<Plugin> plugins;
};

/// One word for an exit code: "done", "interrupted", "numerical_stop" ... [any thread]
std::string status_word(Exit code);

/// Indented JSON with a line end. Doubles are written so that they read back as the same bits. [any thread]
std::string to_json(const Summary& summary);

/// Writes it whole or not at all. Returns 0 or an errno.
int write_summary(const std::string& path, const Summary& summary);

/// The most memory this process held so far, from /proc; absent where there is none. [any thread]
std::optional<uint64_t> peak_memory_bytes();

}  // namespace scree::core
