#include "core/scene/load.hpp"
#include "core/scene/scene.hpp"
#include "support/catch.hpp"

using namespace scree::core;

namespace {

Node load(const std::string& text) {
  Report report;
  auto node = load_yaml(text, "s.yaml", report);
  report.raise();
  REQUIRE(node);
  return *node;
}

std::string refusal(const std::string& text) {
  Report report;
  load_yaml(text, "s.yaml", report);
  try {
    report.raise();
  } catch (const SceneErrors& errors) {
    return errors.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("the loader keeps places and tells quoted from plain") {
  const Node root = load("a: 25 mm\nb:\n  - \"x + 1\"\n  - 'y'\n  - z\n");
  REQUIRE(root.is_map());
  REQUIRE(root.find("a")->text == "25 mm");
  REQUIRE_FALSE(root.find("a")->quoted);
  REQUIRE(root.find("a")->place().text() == "s.yaml:1:4");
  const Node& list = *root.find("b");
  REQUIRE(list.items[0].quoted);
  REQUIRE(list.items[1].quoted);
  REQUIRE_FALSE(list.items[2].quoted);
  REQUIRE(list.items[2].place().text() == "s.yaml:5:5");
  REQUIRE(root.keys[1].spot.place().text() == "s.yaml:2:1");
}

TEST_CASE("an alias is a copy") {
  const Node root = load("a: &one {k: [1, 2]}\nb: *one\n");
  REQUIRE(root.find("b")->find("k")->items[1].text == "2");
  REQUIRE(root.find("b")->place().text() == "s.yaml:2:4");
}

TEST_CASE("hostile YAML is refused at its place") {
  REQUIRE(refusal("a: &a [*a]\n") == "s.yaml:1:8: error: an alias to a value that it is itself part of");
  std::string bomb = "l0: &l0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string before = "*l" + std::to_string(i - 1);
    bomb += "l" + std::to_string(i) + ": &l" + std::to_string(i) + " [";
    for (int k = 0; k < 10; ++k) bomb += (k ? ", " : "") + before;
    bomb += "]\n";
  }
  REQUIRE(refusal(bomb).find("error: aliases that expand to more than 1000000 values") != std::string::npos);
  REQUIRE(refusal(std::string(100, '[') + std::string(100, ']')) == "s.yaml:1:65: error: nested deeper than 64 levels");
  REQUIRE(refusal(std::string(100000, '[')).find("error: ") != std::string::npos);
  REQUIRE(refusal("a: " + std::string((1u << 20) + 1, 'x')) ==
          "s.yaml:1:4: error: a text of 1048577 bytes; the longest allowed is 1 MiB");
  std::string many = "[0";
  for (int i = 0; i < 1000001; ++i) many += ",0";
  REQUIRE(refusal(many + "]").find("error: more than 1000000 values in one file") != std::string::npos);
  REQUIRE(refusal(std::string((64u << 20) + 1, ' ')) ==
          "s.yaml: error: the file has 67108865 bytes; a scene may have 64 MiB");
}

TEST_CASE("depth counts through aliases") {
  const auto nest = [](const std::string& core) { return std::string(40, '[') + core + std::string(40, ']'); };
  REQUIRE(refusal("a: &a " + nest("1") + "\nb: " + nest("*a") + "\n") ==
          "s.yaml:2:44: error: nested deeper than 64 levels");
}

TEST_CASE("duplicate keys, tags, odd keys, second documents and wrong bytes are errors") {
  REQUIRE(refusal("a: 1\nb: 2\na: 3\n") ==
          "s.yaml:3:1: error: duplicate key 'a'; it is already given in line 1: keep one of them");
  REQUIRE(refusal("a: !!float 1\n").find("the tag") != std::string::npos);
  REQUIRE(refusal("[a]: 1\n") == "s.yaml:1:1: error: a key must be a single word or text");
  REQUIRE(refusal("a: 1\n---\nb: 2\n").find("a second document") != std::string::npos);
  REQUIRE(refusal("a: 1\nb: \xff\n") ==
          "s.yaml:2:4: error: a byte that no text holds: save the file as UTF-8 without control characters");
  REQUIRE(refusal(std::string("a: 1\0", 5)).find("a byte that no text holds") != std::string::npos);
  REQUIRE(refusal("a: [1\n").find("not valid YAML") != std::string::npos);
}

TEST_CASE("what is emitted loads to the same text again") {
  const Node root = load(
      "a: 25 mm\nb: [1, [2, 3], \"x \\\"q\\\" + 1\"]\nc:\n  - {k: v, l: [a]}\n  - settle: [run: 0.1 s, save: packed]\n"
      "d: {}\ne: []\nf: ~\ng: plain, with [signs]\nh:\n  - plain, with comma\n\"odd key, here\": 1\n");
  const std::string once = emit(root);
  REQUIRE(emit(load(once)) == once);
  REQUIRE(load(once).find("c")->items[1].find("settle")->items[0].find("run")->text == "0.1 s");
  REQUIRE(load(once).find("b")->items[2].quoted);
  REQUIRE(load(once).find("h")->items[0].text == "plain, with comma");
}
