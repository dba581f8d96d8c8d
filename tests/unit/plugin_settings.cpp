#include <scree/object.hpp>

#include "support/catch.hpp"
#include "support/opened.hpp"

namespace {

using scree::Columns;
using scree::Settings;
using scree::Vec3;

struct Fraction {
  std::array<double, 2> diameter{};
  double share = 0;
};

struct Everything {
  double plain = 2.5, share = 0.25;
  std::optional<double> maybe;
  int whole = 3;
  bool flag = true;
  Vec3 arrow{1, 2, 3};
  std::string word = "one";
  std::vector<double> list;
  std::vector<Vec3> arrows;
  std::vector<std::string> words;
  std::vector<Fraction> table;
  std::array<Vec3, 2> box{};

  static void describe(Settings<Everything>& s) {
    s.number("plain", &Everything::plain, "m", "a length").above(0);
    s.number("share", &Everything::share, "1", "a share").at_least(0).at_most(1).fallback(0.5);
    s.number("maybe", &Everything::maybe, "s", "a time").below(10).infinite();
    s.integer("whole", &Everything::whole, "1", "a count");
    s.boolean("flag", &Everything::flag, "a switch");
    s.vector("arrow", &Everything::arrow, "m/s", "a velocity");
    s.text("word", &Everything::word, "a word").choices("one two").required();
    s.numbers("list", &Everything::list, "m", "lengths").at_least(0);
    s.vectors("arrows", &Everything::arrows, "m", "points");
    s.texts("words", &Everything::words, "words").choices("red green");
    s.table("table", &Everything::table, "fractions", [](Columns<Fraction>& c) {
      c.interval("diameter", &Fraction::diameter, "m", "from, to").above(0);
      c.number("share", &Fraction::share, "1", "share").at_most(1);
    });
    s.box("box", &Everything::box, "m", "corners");
  }
};

struct Fixture {
  scree_object table = scree::object_table<Everything>();
  support::Object object{table};
  const Everything& value() const { return *static_cast<const Everything*>(object.self()); }
};

}  // namespace

TEST_CASE("settings: values arrive in their members", "[sdk]") {
  Fixture f;
  CHECK(f.object.number("plain", 7) == "");
  CHECK(f.object.number("maybe", 4) == "");
  CHECK(f.object.number("whole", -2) == "");
  CHECK(f.object.number("flag", 0) == "");
  CHECK(f.object.vector("arrow", {4, 5, 6}) == "");
  CHECK(f.object.text("word", "two") == "");
  CHECK(f.object.list("list", {1, 2, 3, 4}) == "");
  CHECK(f.object.box("arrows", {1, 2, 3}, {4, 5, 6}) == "");
  CHECK(f.object.texts("words", {"green", "red"}) == "");
  CHECK(f.object.numbers("table", {0.1, 0.2, 0.3, 0.2, 0.4, 0.7}, 2, 3) == "");
  CHECK(f.object.box("box", {0, 0, 0}, {1, 2, 3}) == "");
  const Everything& v = f.value();
  CHECK(v.plain == 7);
  CHECK(v.maybe == 4.0);
  CHECK(v.whole == -2);
  CHECK_FALSE(v.flag);
  CHECK(v.arrow.z == 6);
  CHECK(v.word == "two");
  CHECK(v.list == std::vector<double>{1, 2, 3, 4});
  REQUIRE(v.arrows.size() == 2);
  CHECK(v.arrows[1].x == 4);
  CHECK(v.words == std::vector<std::string>{"green", "red"});
  REQUIRE(v.table.size() == 2);
  CHECK(v.table[1].diameter[1] == 0.4);
  CHECK(v.table[1].share == 0.7);
  CHECK(v.box[1].y == 2);
}

TEST_CASE("settings: a member's initial value is the default that the table shows", "[sdk]") {
  Fixture f;
  CHECK(f.object.property("plain").fallback == 2.5);
  CHECK((f.object.property("plain").flags & SCREE_HAS_FALLBACK) != 0);
  CHECK(f.object.property("flag").fallback == 1);
  CHECK(f.object.property("whole").fallback == 3);
  CHECK(f.value().share == 0.5);  // an explicit fallback wins over the initial value
  CHECK((f.object.property("maybe").flags & SCREE_HAS_FALLBACK) == 0);
  CHECK_FALSE(f.value().maybe.has_value());
  const scree_property& table = f.object.property("table");
  REQUIRE(table.column_count == 2);
  CHECK(table.words == 3);
  CHECK(table.columns[0].words == 2);
  CHECK(table.columns[1].word == 2);
}

TEST_CASE("settings: what does not fit is refused and leaves the member alone", "[sdk]") {
  Fixture f;
  CHECK(f.object.number("plain", 0) == "'plain' is 0, but must be above 0");
  CHECK(f.object.number("plain", std::numeric_limits<double>::quiet_NaN()) ==
        "'plain' is nan, but must be a finite number");
  CHECK(f.object.number("plain", std::numeric_limits<double>::infinity()) ==
        "'plain' is inf, but must be a finite number");
  CHECK(f.object.number("maybe", std::numeric_limits<double>::infinity()) == "'maybe' is inf, but must be below 10");
  CHECK(f.object.number("share", 1.5) == "'share' is 1.5, but must be at most 1");
  CHECK(f.object.number("share", 1) == "");
  CHECK(f.object.number("whole", 1.5) == "'whole' wants an integer from -2147483648 to 2147483647, not 1.5");
  CHECK(f.object.text("word", "three") == "'word' is 'three', but must be one of: one two");
  CHECK(f.object.text("word", "on") != "");
  CHECK(f.object.texts("words", {"red", "blue"}) == "'words' is 'blue', but must be one of: red green");
  CHECK(f.object.list("list", {1, -1}) == "'list' is -1, but must be at least 0");
  CHECK(f.object.numbers("table", {0.1, 0.2, 2}, 1, 3) == "'share' is 2, but must be at most 1");
  CHECK(f.object.numbers("table", {0.1, 0.2}, 1, 2) == "'table' has a value of another type or length");
  CHECK(f.object.numbers("box", {0, 0, 0}, 1, 3) == "'box' has a value of another type or length");
  CHECK(f.object.box("box", {0, 0, 0}, {1, 0, 1}) == "'box' wants its lower corner first: y goes from 0 to 0");
  CHECK(f.value().plain == 2.5);
  CHECK(f.value().word == "one");
}

TEST_CASE("settings: a long refusal is cut between two characters", "[sdk]") {
  char text[6];
  const scree_refusal refusal{sizeof(scree_refusal), sizeof text, text};
  scree::write_refusal(&refusal, "abcd\xC3\xA9");  // five bytes of room, the last character takes two
  CHECK(std::string(text) == "abcd");
  scree::write_refusal(&refusal, "abcde");
  CHECK(std::string(text) == "abcde");
}
