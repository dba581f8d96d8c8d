#include "core/run/summary.hpp"

#include <cerrno>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scree::core;

TEST_CASE("what a run does not have is absent from its summary") {
  const auto json = nlohmann::json::parse(to_json(Summary{}));
  CHECK(json == nlohmann::json{{"schema", "scree-summary/1"}, {"status", "done"}, {"exit_code", 0}});
}

TEST_CASE("a summary holds what the run said, doubles to the last bit") {
  Summary s;
  s.exit_code = Exit::expectation;
  s.message = "1 of 2 expectations failed";
  s.seed = 18446744073709551615u;
  s.cycles = 1u << 31;
  s.model_time = 0.1 + 0.2;
  s.balls = 0;
  s.timestep = Summary::Timestep{.used = 1.234567e-6, .certified = 1.3e-6, .governed_by = "contact 3-9"};
  s.energy = Summary::Energy{.residual = 5e-324, .terms = {{"kinetic", 1.0 / 3}}};
  s.quantities = {{"z", 1.7976931348623157e308},
                  {"a", std::numeric_limits<double>::quiet_NaN()},
                  {"m", -std::numeric_limits<double>::infinity()}};
  s.expectations.push_back(
      {.text = "stress.peak", .quantity = "stress", .value = 2, .passed = false, .low = 3, .source = "B1"});
  s.error = Summary::Error{.estimate = 0.01, .reference = {}, .method = "expect"};
  s.state_hash = 0x00ab;
  s.left_out = {"spin"};
  s.plugins.push_back({.kind = "contact_model", .name = "linear", .version = "1.0.0", .sha256 = "ff", .shadowed = ""});
  const std::string text = to_json(s);
  const auto json = nlohmann::ordered_json::parse(text);
  CHECK(json["status"] == "expectation_failed");
  CHECK(json["exit_code"] == 7);
  CHECK(json["seed"].get<uint64_t>() == 18446744073709551615u);
  CHECK(json["model_time"].get<double>() == 0.1 + 0.2);
  CHECK(text.find("0.30000000000000004") != std::string::npos);
  CHECK(json["balls"] == 0);
  CHECK_FALSE(json.contains("contacts"));
  CHECK(json["timestep"]["used"].get<double>() == 1.234567e-6);
  CHECK(json["energy"]["residual"].get<double>() == 5e-324);
  CHECK(json["energy"]["terms"]["kinetic"].get<double>() == 1.0 / 3);
  CHECK(json["quantities"].begin().key() == "z");
  CHECK(json["quantities"]["z"].get<double>() == 1.7976931348623157e308);
  CHECK(json["quantities"]["a"] == "NaN");
  CHECK(json["quantities"]["m"] == "-Infinity");
  CHECK(json["expectations"][0]["low"] == 3);
  CHECK_FALSE(json["expectations"][0].contains("high"));
  CHECK_FALSE(json["error"].contains("reference"));
  CHECK(json["state_hash"] == "00000000000000ab");
  CHECK(json["plugins"][0]["sha256"] == "ff");
  CHECK_FALSE(json["plugins"][0].contains("shadowed"));
  CHECK(text.find("null") == std::string::npos);
}

TEST_CASE("a summary is written whole, whatever the bytes of a name") {
  const TemporaryFolder folder;
  Summary s;
  s.title = "caf\xe9";
  REQUIRE(write_summary(folder / "summary.json", s) == 0);
  CHECK(nlohmann::json::parse(read_text(folder / "summary.json"))["title"] == "caf\xef\xbf\xbd");
  CHECK(write_summary(folder / "no/summary.json", s) == ENOENT);
}

TEST_CASE("the peak memory follows what was held") {
  const auto before = peak_memory_bytes();
  REQUIRE(before);
  std::vector<char> held(256u << 20, 1);
  CHECK(*peak_memory_bytes() >= (200u << 20));
  CHECK(held[12345] == 1);
}
