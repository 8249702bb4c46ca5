// Lines of a text file, and JSON of one.
#include "algorithm/files/input_file.h"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "algorithm/files/input_json.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;

namespace {

std::vector<std::string> lines_of(const std::string& path) {
  LineReader reader(path);
  std::vector<std::string> lines;
  for (std::string_view line; reader.next(line);) lines.emplace_back(line);
  CHECK(reader.line_number() == lines.size() + 1);
  return lines;
}

// `depth` times the text, `core` in the middle.
std::string nested(std::size_t depth, const std::string& open, const std::string& core,
                   const std::string& close) {
  std::string text;
  for (std::size_t i = 0; i < depth; ++i) text += open;
  text += core;
  for (std::size_t i = 0; i < depth; ++i) text += close;
  return text;
}

}  // namespace

TEST_CASE("line reader: lines with and without an end, empty ones, over blocks") {
  const test::ScratchFolder scratch;
  using Lines = std::vector<std::string>;
  CHECK(lines_of(scratch.write("a", "")) == Lines{});
  CHECK(lines_of(scratch.write("a", "\n")) == Lines{""});
  CHECK(lines_of(scratch.write("a", "one\n\ntwo")) == Lines{"one", "", "two"});
  Lines many;
  std::string text;
  for (int i = 0; i < 20000; ++i) {
    many.push_back(std::string(static_cast<std::size_t>(i % 97), 'x') + std::to_string(i));
    text += many.back() + "\n";
  }
  CHECK(lines_of(scratch.write("a", text)) == many);
  const std::string longest(kMostLineBytes, 'y');
  CHECK(lines_of(scratch.write("a", longest + "\n" + longest)) == Lines{longest, longest});
  CHECK_THAT(test::input_error_of([&] { lines_of(scratch.write("a", "\n" + longest + "y\n")); }),
             Contains("line 2: longer than 4096 bytes"));
  CHECK_THAT(
      test::input_error_of([&] { lines_of(scratch.write("a", std::string(1 << 20, '\0'))); }),
      Contains("line 1: longer than 4096 bytes"));
}

TEST_CASE("input files: what is no regular file is refused at once") {
  const test::ScratchFolder scratch;
  REQUIRE(::mkfifo(scratch.path("pipe").c_str(), 0600) == 0);
  std::filesystem::create_symlink("/dev/zero", scratch.path("zeros"));
  for (const std::string& path : {scratch.path("pipe"), scratch.path("zeros"), scratch.path(""),
                                  scratch.path("none"), std::string("/dev/zero")}) {
    INFO(path);
    test::input_error_of([&] { LineReader{path}; });
    test::input_error_of([&] { read_json(path); });
  }
}

TEST_CASE("json: refused with the origin, whatever it is full of") {
  CHECK(parse_json("{\"a\": [1, 2] /* why */}", "file")["a"][1] == 2);
  const std::string deepest = nested(kMostJsonDepth, "[", "1", "]");
  CHECK(shown(parse_json(deepest, "file")) == deepest);
  struct Row {
    std::string text, message;
  };
  for (const Row& row : std::vector<Row>{
           {"", "file: line 1, column 1: not JSON: unexpected end of input"},
           {"{\"a\": 1,}", "file: line 1, column 9: not JSON: unexpected '}'"},
           {"{\n  \"a\": 1\n  \"b\": 2}", "file: line 3, column 5: not JSON: unexpected string"},
           {"[1e999]", "file: not JSON: number overflow parsing '1e999'"},
           {"[1] 2", "file: line 1, column 5: not JSON"},
           {"[\"\xff\"]", "file: line 1, column 3: not JSON: invalid string"},
           {"{\"a\": 1, \"a\": 2}", "file: key 'a' twice in one object"},
           {"[{\"b\": {\"a\": 1, \"\\u0061\": 2}}]", "file: key 'a' twice in one object"},
           {"[" + deepest + "]", "file: objects and arrays in each other more than 64 deep"},
           {nested(17000, "{\"a\":", "1", "}"), "more than 64 deep"},
           {nested(88000, "[", "", "]"), "more than 64 deep"},
           {nested(1000000, "[", "", ""), "more than 64 deep"}}) {
    CHECK_THAT(test::input_error_of([&] { parse_json(row.text, "file"); }), Contains(row.message));
  }
  std::string keys = "{\"0\": 0";
  for (int i = 1; i < 200000; ++i) keys += ", \"" + std::to_string(i) + "\": 0";
  CHECK_THAT(test::input_error_of([&] { parse_json(keys + "}", "file"); }),
             Contains("more than 10000 keys in one object"));
}
