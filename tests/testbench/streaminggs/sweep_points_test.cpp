// sweep_points.h: grids, lists, JSON lines; and lines that come in pieces.
#include "testbench/streaminggs/sweep/sweep_points.h"

#include <fcntl.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "testbench/streaminggs/sweep/sweep.h"
#include "tests/support/scratch_folder.h"

namespace sgs {
namespace {

using Words = std::vector<std::string>;

std::vector<Words> overrides_of(const std::vector<SweepPoint>& points) {
  std::vector<Words> all;
  for (const SweepPoint& point : points) all.push_back(point.overrides);
  return all;
}

TEST_CASE("sweep points: a grid has every combination once, the last axis fastest") {
  CHECK(
      (overrides_of(grid_of({"a=1,2", "b.c=x,y"})) ==
       std::vector<Words>{{"a=1", "b.c=x"}, {"a=1", "b.c=y"}, {"a=2", "b.c=x"}, {"a=2", "b.c=y"}}));
  const std::string axis = "a=1,2,3,4,5,6,7,8,9,10";
  CHECK(test::input_error_of([&] {
          Words axes;
          for (const char key : std::string("abcdef")) axes.push_back(key + axis.substr(1));
          grid_of(axes);
        }).find("100000") != std::string::npos);
}

TEST_CASE("sweep points: a list has words, JSON, comments and empty lines") {
  const test::ScratchFolder scratch;
  const std::string path = scratch.write(
      "points",
      "# which\n\n  a=1  b=x#1 # why\r\n"
      "{\"id\": {\"n\": 1}, \"set\": {\"a.b\": [1, 2], \"c\": \"t#\", \"d\": true}, \"view\": 3,"
      " \"size\": \"4x4\", \"stereo\": \"ipd=1\", \"scene\": \"s.ply\", \"cameras\": \"c.json\", "
      "\"config\": \"paper\","
      " \"fit_memories\": true}");
  const std::vector<SweepPoint> points = read_points(path);
  REQUIRE(points.size() == 2);
  CHECK((points[0].overrides == Words{"a=1", "b=x#1"}));
  CHECK((points[1].overrides == Words{"a.b=[1,2]", "c=\"t#\"", "d=true"}));
  CHECK(points[1].id == "{\"n\":1}");
  CHECK(points[1].view == "3");
  CHECK(points[1].size == "4x4");
  CHECK(points[1].stereo == "ipd=1");
  CHECK(points[1].scene == "s.ply");
  CHECK(points[1].cameras == "c.json");
  CHECK(points[1].config == "paper");
  CHECK(points[1].fit_memories == true);
  CHECK_FALSE(points[0].fit_memories.has_value());
}

TEST_CASE("sweep points: a line that is no point says where and what was expected") {
  for (const auto& [line, words] : std::vector<std::pair<std::string, std::string>>{
           {"=1", "f:3: got '=1', expected KEY=VALUE"},
           {"a=1 b=2 a=3", "f:3: got a twice, expected once"},
           {"{\"sets\": {}}", "f:3: sets: unknown key, expected one of id, scene, cameras, view"},
           {"{\"view\": -1}", "f:3: view: got -1, expected a text"},
           {"{\"view\": \"\"}", "f:3: view: got \"\", expected a text"},
           {"{\"set\": [1]}", "f:3: set: got [1], expected {\"key.path\""},
           {"{\"a\": 1, \"a\": 2}", "f:3: key 'a' twice"},
           {"{", "f:3: line 1, column 2: not JSON: "}}) {
    const std::string got = test::input_error_of([&, text = line] { parse_point(text, "f:3"); });
    INFO(got);
    CHECK(got.rfind(words, 0) == 0);
  }
}

TEST_CASE("sweep points: lines of a stream are points when they are complete") {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  PointStream stream(ends[0]);
  const auto write = [&](const std::string& text) {
    REQUIRE(::write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size()));
    return stream.receive();
  };
  CHECK(write("a=1\nb=").size() == 1);
  CHECK((overrides_of(write("2\n\n")) == std::vector<Words>{{"b=2"}}));
  const std::vector<SweepPoint> bad = write("x\nc=3");
  REQUIRE(bad.size() == 1);
  CHECK(bad[0].refused.rfind("standard input, line 4: got 'x'", 0) == 0);
  CHECK_FALSE(stream.ended());
  ::close(ends[1]);
  CHECK((overrides_of(stream.receive()) == std::vector<Words>{{"c=3"}}));
  CHECK(stream.ended());
  ::close(ends[0]);
}

TEST_CASE("sweep points: a line without end is refused once, and the next one taken") {
  // How many bytes come before the newline, and whether that many are a line.
  const std::pair<std::size_t, bool> rows[] = {
      {kLongestLineBytes, true}, {kLongestLineBytes + 1, false}, {3 * kLongestLineBytes, false}};
  for (const auto& [bytes, taken] : rows) {
    INFO(bytes);
    const test::ScratchFolder scratch;
    const std::string path =
        scratch.write("points", "a=1\nb=" + std::string(bytes - 2, '2') + "\nx\nc=3\n");
    const int file = ::open(path.c_str(), O_RDONLY);
    REQUIRE(file >= 0);
    PointStream stream(file);
    std::vector<SweepPoint> points;
    while (!stream.ended()) {
      for (SweepPoint& point : stream.receive()) points.push_back(std::move(point));
    }
    ::close(file);
    REQUIRE(points.size() == 4);
    CHECK(points[0].overrides == Words{"a=1"});
    CHECK(points[1].overrides.size() == (taken ? 1 : 0));
    CHECK(points[1].refused ==
          (taken ? ""
                 : "standard input, line 2: got more than 1000000 B, expected KEY=VALUE ..., or a "
                   "JSON object"));
    CHECK(points[2].refused.rfind("standard input, line 3: got 'x'", 0) == 0);
    CHECK(points[3].overrides == Words{"c=3"});
  }
}

}  // namespace
}  // namespace sgs
