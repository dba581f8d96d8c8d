#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "support/ball_sink.hpp"
#include "support/catch.hpp"
#include "support/opened.hpp"

namespace {

using support::BallSink;
using support::Object;
using support::opened;

/// Writes the text, reads it with the generator; returns the refusal with the path cut off.
std::string read(const std::string& text, BallSink& sink) {
  const auto path = std::filesystem::temp_directory_path() / ("scree_plugin_file_" + std::to_string(getpid()) + ".csv");
  std::ofstream(path, std::ios::binary) << text;
  const auto& generator = opened<scree_generator>("generator", "file");
  Object object(generator.object);
  REQUIRE(object.text("path", path.string()) == "");
  support::Refused refused;
  const int result = generator.generate(object.self(), sink.table(), &refused.table);
  std::filesystem::remove(path);
  if (result == 0) return "";
  std::string why = refused.text;
  if (why.rfind(path.string(), 0) == 0) why = why.substr(path.string().size());
  return why;
}
std::string refusal(const std::string& text) {
  BallSink sink;
  const std::string why = read(text, sink);
  CHECK(sink.balls.empty());  // a file with an error places nothing
  return why;
}

}  // namespace

TEST_CASE("file: all columns, in any order", "[plugin]") {
  BallSink sink;
  REQUIRE(read("id,type,radius,x,y,z,density,vx,vy,vz,wx,wy,wz\n"
               "7,fine,0.25,1,2,3,2650,4,5,6,7,8,9\n"
               " 3 , coarse ,5e-1, -1 ,+2,0.1,1000,0,0,0,0,0,-1e-3\n",
               sink) == "");
  REQUIRE(sink.balls.size() == 2);
  const scree_ball& a = sink.balls[0].ball;
  CHECK(a.given == (SCREE_BALL_DENSITY | SCREE_BALL_VELOCITY | SCREE_BALL_SPIN | SCREE_BALL_ID | SCREE_BALL_GROUP));
  CHECK(a.id == 7);
  CHECK(a.radius == 0.25);
  CHECK(a.position[2] == 3);
  CHECK(a.density == 2650);
  CHECK(a.velocity[1] == 5);
  CHECK(a.spin[0] == 7);
  CHECK(sink.balls[0].group == "fine");
  const scree_ball& b = sink.balls[1].ball;
  CHECK(b.id == 3);
  CHECK(b.position[0] == -1);
  CHECK(b.position[2] == 0.1);
  CHECK(b.spin[2] == -1e-3);
  CHECK(sink.balls[1].group == "coarse");
}

TEST_CASE("file: CRLF, byte order mark, comments, blank lines and no last line end", "[plugin]") {
  BallSink sink;
  REQUIRE(read("\xEF\xBB\xBF# packed\r\nx,y,z,r,group\r\n\r\n1,2,3,0.5,\r\n#1,2,3,0.5,\r\n4,5,6,0.5,b", sink) == "");
  REQUIRE(sink.balls.size() == 2);
  CHECK(sink.balls[0].ball.given == 0);
  CHECK(sink.balls[1].group == "b");
}

TEST_CASE("file: errors name the line", "[plugin]") {
  const std::string head = "x,y,z,radius\n";
  CHECK(refusal("") == ":1: the file is empty; it must begin with a header such as x,y,z,radius");
  CHECK(refusal("x,y,z\n1,2,3\n") == ":1: column 'radius' is missing");
  CHECK(refusal("x,y,z,radius,mass\n").find(":1: unknown column 'mass'; known are: x y z") == 0);
  CHECK(refusal("x,y,z,radius,r\n") == ":1: column 'r' says 'radius' a second time");
  CHECK(refusal("x,y,z,r,vx,vy\n") == ":1: columns 'vx' to 'vz' must be given together");
  CHECK(refusal(head + "1,2,3,4\n1,2,3\n") == ":3: has 3 cells, the header has 4");
  CHECK(refusal(head + "1,2,3,4\n\n1,2,3,4,5\n") == ":4: has 5 cells, the header has 4");
  CHECK(refusal(head + "1,two,3,4\n") == ":2: y 'two' is not a finite number");
  CHECK(refusal(head + "1,2.5mm,3,4\n") == ":2: y '2.5mm' is not a finite number");
  CHECK(refusal(head + "1,,3,4\n") == ":2: y '' is not a finite number");
  CHECK(refusal(head + "nan,2,3,4\n") == ":2: x 'nan' is not a finite number");
  CHECK(refusal(head + "inf,2,3,4\n") == ":2: x 'inf' is not a finite number");
  CHECK(refusal(head + "1e999,2,3,4\n") == ":2: x '1e999' is not a finite number");
  CHECK(refusal(head + "1,2,3,4\n1,2,3,-0.1\n") == ":3: radius '-0.1' must be above 0");
  CHECK(refusal(head + "1,2,3,0\n") == ":2: radius '0' must be above 0");
  CHECK(refusal("x,y,z,r,density\n1,2,3,1,-5\n") == ":2: density '-5' must be above 0");
  CHECK(refusal("x,y,z,r,id\n1,2,3,1,5\n1,2,3,1,6\n1,2,3,1,5\n") == ":4: id '5' is already the id of line 2");
  CHECK(refusal("x,y,z,r,id\n1,2,3,1,0\n") == ":2: id '0' must be an integer of at least 1");
  CHECK(refusal("x,y,z,r,id\n1,2,3,1,1.5\n") == ":2: id '1.5' must be an integer of at least 1");
  CHECK(refusal("x,y,z,r,type\n1,2,3,1,a b\n") == ":2: group 'a b' may hold letters, digits, '_' and '-' only");
}

TEST_CASE("file: a header alone is an empty set, a missing file a refusal", "[plugin]") {
  BallSink sink;
  CHECK(read("x,y,z,radius\n", sink) == "");
  CHECK(sink.balls.empty());
  const auto& generator = opened<scree_generator>("generator", "file");
  Object object(generator.object);
  REQUIRE(object.text("path", "/nowhere/at/all.csv") == "");
  support::Refused refused;
  CHECK(generator.generate(object.self(), sink.table(), &refused.table) != 0);
  CHECK(std::string(refused.text) == "cannot read '/nowhere/at/all.csv': No such file or directory");
  REQUIRE(object.text("path", "/tmp") == "");
  CHECK(generator.generate(object.self(), sink.table(), &refused.table) != 0);
  CHECK(std::string(refused.text) == "cannot read '/tmp': Is a directory");
}
