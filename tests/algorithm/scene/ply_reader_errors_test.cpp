// What ply_reader.h refuses, and how it says so.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/scene/ply_reader.h"
#include "tests/algorithm/scene/ply_bytes.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;
using sgs::test::counting_table;
using sgs::test::PlyTable;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// What reading these bytes says.
std::string ply_refusal(const std::string& bytes, const SceneReadOptions& options = {}) {
  const test::ScratchFolder scratch;
  const std::string path = scratch.write("bad.ply", bytes);
  const std::string message = test::input_error_of([&] { read_ply(path, options); });
  CHECK_THAT(message, Contains("bad.ply"));
  return message;
}

std::string ply_refusal(const PlyTable& table) { return ply_refusal(test::bytes_of(table)); }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("ply reader refuses: files that are missing, folders, devices") {
  const test::ScratchFolder scratch;
  CHECK_THAT(test::input_error_of([&] { read_ply(scratch.path("none.ply")); }),
             Contains("none.ply: cannot be opened"));
  CHECK_THAT(test::input_error_of([&] { read_ply(scratch.path("")); }), Contains("not a regular"));
  CHECK_THAT(test::input_error_of([&] { read_ply("/dev/null"); }), Contains("not a regular"));
}

TEST_CASE("ply reader refuses: what is not a PLY") {
  for (const char* bytes : {"", "p", "ply", "PLY\n", "plyformat\n", "\nply\n", "solid cube\n"}) {
    CHECK_THAT(ply_refusal(bytes), Contains("byte 0: not a PLY file"));
  }
}

TEST_CASE("ply reader refuses: header lines, by number") {
  const std::string good = test::bytes_of(counting_table(1));
  const auto with = [&good](const std::string& from, const std::string& to) {
    return ply_refusal(replaced(good, from, to));
  };
  CHECK_THAT(with("binary_little_endian", "binary_middle_endian"),
             Contains("line 2: got \"format binary_middle_endian 1.0\""));
  CHECK_THAT(with("endian 1.0", "endian 2.0"), Contains("line 2:"));
  CHECK_THAT(with("format binary_little_endian 1.0\n", ""), Contains("a format line before it"));
  CHECK_THAT(with("element vertex 1", "element vertex -1"),
             Contains("line 3: got \"element vertex -1\", expected a count"));
  CHECK_THAT(with("element vertex 1", "element vertex 99999999999999999999"), Contains("a count"));
  CHECK_THAT(with("element vertex 1", "element vertex"), Contains("line 3:"));
  CHECK_THAT(with("element vertex 1\n", ""),
             Contains("line 3: got \"property float x\", expected an element"));
  CHECK_THAT(with("property float x", "property half x"),
             Contains("line 4: got \"property half x\", expected a type"));
  CHECK_THAT(with("property float x", "property float"), Contains("line 4:"));
  CHECK_THAT(with("property float x", "propertyfloat x"), Contains("line 4:"));
  CHECK_THAT(with("property float x", "property list float int x"), Contains("integer list count"));
  CHECK_THAT(with("property float nx", "property float x"),
             Contains("line 7: got \"property float x\", expected each property"));
  CHECK_THAT(with("element vertex 1\n", "element vertex 0\nproperty float x\nelement vertex 1\n"),
             Contains("line 5: got \"element vertex 1\", expected each element once"));
  CHECK_THAT(with("element vertex 1", "element point 1"), Contains("no element vertex"));
  CHECK_THAT(with("element vertex 1\n", "element empty 5\nelement vertex 1\n"),
             Contains("element empty has no properties"));
  CHECK_THAT(with("end_header", "end_haeder"), Contains("end_haeder"));
}

TEST_CASE("ply reader refuses: a header without end") {
  CHECK_THAT(ply_refusal("ply\nformat ascii 1.0\n"),
             Contains("line 3: the header ends after 21 bytes"));
  std::string endless = "ply\nformat ascii 1.0\n";
  while (endless.size() < (2u << 20)) endless += "comment and so on\n";
  CHECK_THAT(ply_refusal(endless), Contains("end_header within 1 MiB"));
}

TEST_CASE("ply reader refuses: missing properties, each by name") {
  const PlyTable good = counting_table(1);
  for (const char* name : {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0",
                           "scale_1", "rot_0", "rot_1", "rot_2", "rot_3"}) {
    PlyTable table = good;
    for (auto& column : table.columns) {
      if (column.name == name) column.name = "other";
    }
    CHECK_THAT(ply_refusal(table), Contains(std::string("got no property ") + name + ","));
  }
}

TEST_CASE("ply reader refuses: counts of f_rest that no degree has, and gaps in them") {
  for (const int rest : {1, 3, 8, 10, 44, 46, 72}) {
    CHECK_THAT(ply_refusal(counting_table(1, rest)),
               Contains("got " + std::to_string(rest) + " properties f_rest_*"));
  }
  CHECK_THAT(ply_refusal(replaced(test::bytes_of(counting_table(1, 9)), "f_rest_4", "f_rest_9")),
             Contains("got no property f_rest_4"));
}

TEST_CASE("ply reader refuses: lists among the vertex properties") {
  CHECK_THAT(ply_refusal(replaced(test::bytes_of(counting_table(1)), "property float nx",
                                  "property list uchar float nx")),
             Contains("property nx: got a list"));
}

TEST_CASE("ply reader refuses: counts that the file cannot hold, before allocating") {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    PlyTable table = counting_table(2);
    table.format = format;
    const std::string good = test::bytes_of(table);
    for (const char* count : {"3", "1000000000000", "18446744073709551615"}) {
      const std::string bytes = replaced(good, "vertex 2", std::string("vertex ") + count);
      const std::string message = ply_refusal(bytes);
      // Two records of text leave room for more of the shortest kind.
      if (table.format != "ascii" || count[1] != '\0') {
        CHECK_THAT(message, Contains(std::string("expected ") + count + " records of"));
      }
    }
  }
  PlyTable table = counting_table(2);
  table.header_before = "element face 4000000000\nproperty list uint double corners\n";
  CHECK_THAT(ply_refusal(table), Contains("records of element face, expected 4000000000 records"));
}

TEST_CASE("ply reader refuses: a list longer than the file, or of negative length") {
  PlyTable table = counting_table(2);
  table.header_before = "element face 1\nproperty list uint double corners\n";
  table.body_before = test::encoded(table.format, "uint", 4294967295.0);
  CHECK_THAT(ply_refusal(table), Contains("expected 4294967295 values of 8 bytes"));
  table.header_before = "element face 1\nproperty list char double corners\n";
  table.body_before = test::encoded(table.format, "char", -1);
  CHECK_THAT(ply_refusal(table), Contains("list corners: got length -1"));
}

TEST_CASE("ply reader refuses: bytes behind the last record") {
  struct Row {
    const char *format, *header_after, *body_after, *message;
  };
  for (const Row& row : std::vector<Row>{
           {"binary_little_endian", "", "\n",
            "got 1 bytes after the last record, expected the end"},
           {"binary_big_endian", "", "a record more", "got 13 bytes after the last record"},
           {"binary_little_endian", "element e 1\nproperty uchar a\n", "12", "got 1 bytes after"},
           {"binary_little_endian", "element e 1\nproperty list uchar uchar a\n", "\1ab",
            "got 1 bytes after the last record"},
           {"ascii", "", "more\n", "got \"more\" after the last record, expected the end"},
           {"ascii", "element e 1\nproperty uchar a\n", "1\n2\n", "got \"2\" after"}}) {
    PlyTable table = counting_table(3);
    table.format = row.format;
    table.header_after = row.header_after;
    table.body_after = row.body_after;
    CHECK_THAT(ply_refusal(table), Contains(row.message));
  }
  PlyTable blank = counting_table(3);
  blank.format = "ascii";
  blank.body_after = "\n  \n";
  const test::ScratchFolder scratch;
  CHECK(read_ply(scratch.write("blank.ply", test::bytes_of(blank))).cloud.size() == 3);
}

TEST_CASE("ply reader refuses: values that are not finite, by vertex and property") {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const double value : {std::nan(""), kInfinity, -kInfinity}) {
      PlyTable table = counting_table(40);
      table.format = format;
      table.rows[17][13] = value;  // rot_0
      table.rows[23][0] = value;
      CHECK_THAT(ply_refusal(table), Contains("vertex 17, property rot_0: got"));
      CHECK_THAT(ply_refusal(table), Contains("expected a finite number"));
    }
  }
  PlyTable wide = counting_table(3, 45);
  wide.rows[2][9 + 30] = kInfinity;
  CHECK_THAT(ply_refusal(wide), Contains("vertex 2, property f_rest_30: got inf"));
  // A double that no float can hold.
  PlyTable large = counting_table(3);
  large.columns[2].type = "double";
  large.rows[1][2] = 1e300;
  CHECK_THAT(ply_refusal(large), Contains("vertex 1, property z: got inf"));
}

TEST_CASE("ply reader: values too large to be drawn are refused, or dropped and counted") {
  struct Case {
    std::size_t column;  // of a degree-2 table
    const char* property;
    double limit;
    const char* expected;
  };
  const char *coordinate = "expected a magnitude of at most 1e+18",
             *scale = "expected at most 16.1180956, the logarithm of 10000000";
  const test::ScratchFolder scratch;
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const Case& c : {Case{0, "x", kMaxCoordinate, coordinate},
                          {1, "y", -kMaxCoordinate, coordinate},
                          {2, "z", kMaxCoordinate, coordinate},
                          {6, "f_dc_0", kMaxCoefficient, coordinate},
                          {8, "f_dc_2", -kMaxCoefficient, coordinate},
                          {9, "f_rest_0", -kMaxCoefficient, coordinate},
                          {32, "f_rest_23", kMaxCoefficient, coordinate},
                          {34, "scale_0", kMaxLogScale, scale},
                          {36, "scale_2", kMaxLogScale, scale}}) {
      CAPTURE(format, c.property);
      PlyTable table = counting_table(7, 24);
      table.format = format;
      table.rows[4][c.column] = c.limit;
      const std::string path = scratch.write("a.ply", test::bytes_of(table));
      CHECK(read_ply(path).cloud.size() == 7);
      for (const double factor : {1.000001, 1e10, 3e38 / std::abs(c.limit)}) {
        table.rows[4][c.column] = c.limit * factor;
        const std::string message = ply_refusal(table);
        CHECK_THAT(message, Contains("vertex 4, property " + std::string(c.property) + ": got "));
        CHECK_THAT(message, Contains(c.expected));
        const SceneContents kept = read_ply(scratch.write("b.ply", test::bytes_of(table)), {true});
        CHECK(kept.dropped_invalid == 1);
        REQUIRE(kept.cloud.size() == 6);
        CHECK(kept.cloud.means[4].x == 5000);
      }
    }
  }
}

TEST_CASE("ply reader: what may be of any size") {
  const test::ScratchFolder scratch;
  PlyTable table = counting_table(1);
  table.rows[0][9] = 3e38;    // opacity: a sigmoid
  table.rows[0][10] = -3e38;  // the logarithm of a scale of nothing
  for (std::size_t k = 13; k < 17; ++k) table.rows[0][k] = -3e38;  // a rotation, to be normalised
  table.rows[0][3] = 3e38;                                         // a normal
  CHECK(read_ply(scratch.write("a.ply", test::bytes_of(table))).cloud.size() == 1);
}

TEST_CASE("ply reader: values that are not finite do not matter in properties it ignores") {
  const test::ScratchFolder scratch;
  PlyTable table = counting_table(2);
  table.rows[1][4] = std::nan("");  // ny
  CHECK(read_ply(scratch.write("a.ply", test::bytes_of(table))).cloud.size() == 2);
}

TEST_CASE("ply reader refuses: quaternions of length zero") {
  PlyTable table = counting_table(5);
  for (int i = 0; i < 4; ++i) table.rows[3][13 + i] = i % 2 ? 0.0 : -0.0;
  CHECK_THAT(ply_refusal(table),
             Contains("vertex 3, properties rot_0..3: got the quaternion 0 0 0 0"));
  table.rows[3][15] = 1e-30;  // tiny is not zero
  const test::ScratchFolder scratch;
  CHECK(read_ply(scratch.write("a.ply", test::bytes_of(table))).cloud.quats[3][2] == 1e-30f);
}

TEST_CASE("ply reader: drop_invalid leaves out and counts what it would refuse") {
  const test::ScratchFolder scratch;
  for (const char* format : {"ascii", "binary_little_endian"}) {
    PlyTable table = counting_table(6, 24);
    table.format = format;
    table.rows[0][0] = std::nan("");
    table.rows[3][9 + 5] = kInfinity;
    table.rows[3][1] = kInfinity;  // two faults, one vertex
    for (std::size_t i = 0; i < 4; ++i) table.rows[5][table.columns.size() - 1 - i] = 0;
    const std::string path = scratch.write("a.ply", test::bytes_of(table));
    const SceneContents result = read_ply(path, {true});
    CHECK(result.dropped_invalid == 3);
    REQUIRE(result.cloud.size() == 3);
    REQUIRE(result.cloud.sh_coeffs.size() == 27);
    const std::vector<float> kept = {1000, 2000, 4000};
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(result.cloud.means[i].x == kept[i]);
      CHECK(result.cloud.sh_coeffs[9 * i + 8].z == kept[i] + 9 + 23);
      CHECK(result.cloud.quats[i][3] == kept[i] + 9 + 24 + 7);
    }
  }
  PlyTable table = counting_table(2);
  for (auto& row : table.rows) row[0] = kInfinity;
  const SceneContents none = read_ply(scratch.write("b.ply", test::bytes_of(table)), {true});
  CHECK(none.cloud.size() == 0);
  CHECK(none.dropped_invalid == 2);
}

TEST_CASE("ply reader refuses: text that is no number, by line") {
  PlyTable table = counting_table(3);
  table.format = "ascii";
  const std::string good = test::bytes_of(table);
  const auto line_of = [&](std::size_t vertex) {
    return "line " + std::to_string(3 + table.columns.size() + 1 + vertex + 1) + ":";
  };
  for (const char* word : {"1.0.0", "12abc", "--3", "1,5", "0x10", "one", "+", "1e", "+-1"}) {
    const std::string bytes = replaced(good, "-990 ", std::string(word) + " ");
    CHECK_THAT(ply_refusal(bytes), Contains(line_of(1) + " got \"" + word + "\" for scale_0"));
  }
  CHECK_THAT(ply_refusal(replaced(good, "-990 ", "")),
             Contains(line_of(1) + " got 16 values, expected 17"));
  CHECK_THAT(ply_refusal(replaced(good, "-990 ", "-990 1 ")),
             Contains("got 18 values, expected 17"));
  CHECK_THAT(ply_refusal(replaced(good, "-990 ", "1e99 ")),
             Contains("vertex 1, property scale_0: got inf"));
}
