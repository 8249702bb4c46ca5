// What ply_reader.h reads: layouts, formats, types. ply_reader_errors_test.cpp has what it refuses.
#include "algorithm/scene/ply_reader.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/algorithm/scene/ply_bytes.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using sgs::test::counting_table;
using sgs::test::PlyTable;

namespace {

// The cloud of counting_table(vertices, 0), written down by hand.
void check_counting_cloud(const GaussianCloud& cloud, std::size_t vertices) {
  REQUIRE(cloud.sh_degree == 0);
  REQUIRE(cloud.size() == vertices);
  REQUIRE(cloud.sh_coeffs.size() == vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    const float base = 1000.0f * static_cast<float>(v);
    CHECK(cloud.means[v] == glm::vec3(base, base + 1, base + 2));
    CHECK(cloud.sh_coeffs[v] == glm::vec3(base + 6, base + 7, base + 8));
    CHECK(cloud.opacity_logits[v] == base + 9);
    CHECK(cloud.log_scales[v] == glm::vec3(10 - base, 11 - base, 12 - base));
    CHECK(cloud.quats[v] == std::array<float, 4>{base + 13, base + 14, base + 15, base + 16});
  }
}

}  // namespace

TEST_CASE("ply reader: f_rest is channel-major in the file, coefficient-major in the cloud") {
  const test::ScratchFolder scratch;
  const std::vector<std::pair<int, int>> rest_counts = {{0, 0}, {9, 1}, {24, 2}, {45, 3}};
  for (const auto& [rest_count, degree] : rest_counts) {
    const PlyTable table = counting_table(3, rest_count);
    const GaussianCloud cloud = read_ply(scratch.write("a.ply", test::bytes_of(table))).cloud;
    REQUIRE(cloud.sh_degree == degree);
    REQUIRE(cloud.size() == 3);
    const int coeffs = sh_coeff_count(degree), per_channel = rest_count / 3;
    // f_rest_0 is column 9; vertex 2 counts from 2000.
    CHECK(cloud.sh_coeffs[2 * coeffs] == glm::vec3(2006, 2007, 2008));
    for (int k = 1; k < coeffs; ++k) {
      const auto red = static_cast<float>(2009 + k - 1);
      const auto step = static_cast<float>(per_channel);
      CHECK(cloud.sh_coeffs[2 * coeffs + k] == glm::vec3(red, red + step, red + 2 * step));
    }
    CHECK(cloud.opacity_logits[2] == static_cast<float>(2009 + rest_count));
    CHECK(cloud.quats[2][3] == static_cast<float>(2009 + rest_count + 7));
  }
}

TEST_CASE("ply reader: every format and line end") {
  const test::ScratchFolder scratch;
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const char* line_end : {"\n", "\r\n"}) {
      CAPTURE(format);
      PlyTable table = counting_table(5, 0);
      table.format = format;
      table.line_end = line_end;
      const SceneContents result = read_ply(scratch.write("a.ply", test::bytes_of(table)));
      check_counting_cloud(result.cloud, 5);
      CHECK(result.dropped_invalid == 0);
    }
  }
}

TEST_CASE("ply reader: every scalar type is converted to float") {
  const test::ScratchFolder scratch;
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const char* type :
         {"char", "uchar", "short", "ushort", "int", "uint", "float", "double", "int8", "uint8",
          "int16", "uint16", "int32", "uint32", "float32", "float64"}) {
      CAPTURE(format, type);
      PlyTable table = counting_table(1, 0);  // values 0 to 16 fit every type
      table.format = format;
      for (auto& column : table.columns) column.type = type;
      check_counting_cloud(read_ply(scratch.write("a.ply", test::bytes_of(table))).cloud, 1);
    }
  }
}

TEST_CASE("ply reader: signs, fractions and large integers survive the conversion") {
  const test::ScratchFolder scratch;
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    PlyTable table = counting_table(1, 0);
    table.format = format;
    const std::vector<std::pair<const char*, double>> values = {
        {"char", -100},    {"short", -30000},      {"int", -2000000000}, {"uchar", 250},
        {"ushort", 65000}, {"uint", 4000000000.0}, {"double", 0.1},      {"float", -2.5}};
    const std::vector<std::size_t> columns = {0, 1, 2, 6, 7, 8, 9, 10};
    for (std::size_t i = 0; i < values.size(); ++i) {
      table.columns[columns[i]].type = values[i].first;
      table.rows[0][columns[i]] = values[i].second;
    }
    const GaussianCloud cloud = read_ply(scratch.write("a.ply", test::bytes_of(table))).cloud;
    CHECK(cloud.means[0] == glm::vec3(-100, -30000, -2000000000.0f));
    CHECK(cloud.sh_coeffs[0] == glm::vec3(250, 65000, 4000000000.0f));
    CHECK(cloud.opacity_logits[0] == 0.1f);
    CHECK(cloud.log_scales[0].x == -2.5f);
  }
}

TEST_CASE("ply reader: any order of properties, others among them, normals or not") {
  const test::ScratchFolder scratch;
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    PlyTable table = counting_table(4, 0);
    table.format = format;
    // Reversed, without normals, with two properties that mean nothing here.
    std::reverse(table.columns.begin(), table.columns.end());
    for (auto& row : table.rows) std::reverse(row.begin(), row.end());
    table.columns.erase(table.columns.begin() + 11, table.columns.begin() + 14);
    REQUIRE(table.columns[10].name == "f_dc_0");
    REQUIRE(table.columns[11].name == "z");
    for (auto& row : table.rows) row.erase(row.begin() + 11, row.begin() + 14);
    table.columns.insert(table.columns.begin() + 2, {"confidence", "double"});
    table.columns.push_back({"label", "uchar"});
    for (auto& row : table.rows) {
      row.insert(row.begin() + 2, -1.5);
      row.push_back(7);
    }
    check_counting_cloud(read_ply(scratch.write("a.ply", test::bytes_of(table))).cloud, 4);
  }
}

TEST_CASE("ply reader: comments and obj_info anywhere in the header") {
  const test::ScratchFolder scratch;
  PlyTable table = counting_table(2, 0);
  table.header_before = "comment element vertex 99\nobj_info made by hand\n\n";
  table.header_after = "comment property float x\n";
  check_counting_cloud(read_ply(scratch.write("a.ply", test::bytes_of(table))).cloud, 2);
}

TEST_CASE("ply reader: other elements, with lists, before and after the vertices") {
  const test::ScratchFolder scratch;
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    CAPTURE(format);
    PlyTable table = counting_table(3, 0);
    table.format = format;
    table.header_before =
        "element camera 2\nproperty double focal\nproperty short id\n"
        "element face 3\nproperty uchar kind\nproperty list uchar int corners\n"
        "property list ushort double weights\n";
    table.header_after = "element edge 1\nproperty list int float parts\n";
    const auto put = [&](std::string& body, const char* type, double value) {
      body += test::encoded(format, type, value);
    };
    const auto end_record = [&](std::string& body) {
      if (table.format == "ascii") body += "\n";
    };
    for (int i = 0; i < 2; ++i) {
      put(table.body_before, "double", 1e9);
      put(table.body_before, "short", i);
      end_record(table.body_before);
    }
    for (int i = 0; i < 3; ++i) {  // lists of 0, 1, 2 and 2, 1, 0 entries
      put(table.body_before, "uchar", 9);
      put(table.body_before, "uchar", i);
      for (int k = 0; k < i; ++k) put(table.body_before, "int", 77);
      put(table.body_before, "ushort", 2 - i);
      for (int k = 0; k < 2 - i; ++k) put(table.body_before, "double", 0.5);
      end_record(table.body_before);
    }
    put(table.body_after, "int", 2);
    for (int k = 0; k < 2; ++k) put(table.body_after, "float", 3);
    end_record(table.body_after);
    check_counting_cloud(read_ply(scratch.write("a.ply", test::bytes_of(table))).cloud, 3);
  }
}

TEST_CASE("ply reader: an element of large lists is skipped without holding it") {
  const test::ScratchFolder scratch;
  PlyTable table = counting_table(2, 0);
  table.header_before = "element face 2\nproperty list uint double corners\n";
  for (int i = 0; i < 2; ++i) {  // each longer than the reader's window of half a megabyte
    table.body_before += test::encoded(table.format, "uint", 100'000);
    table.body_before += std::string(800'000, 'x');
  }
  check_counting_cloud(read_ply(scratch.write("a.ply", test::bytes_of(table))).cloud, 2);
}

TEST_CASE("ply reader: more vertices than a block, in order") {
  const test::ScratchFolder scratch;
  PlyTable table = counting_table(20'000, 0);
  for (std::size_t v = 0; v < table.rows.size(); ++v) table.rows[v][0] = static_cast<double>(v);
  const GaussianCloud cloud = read_ply(scratch.write("a.ply", test::bytes_of(table))).cloud;
  REQUIRE(cloud.size() == 20'000);
  std::size_t wrong = 0;
  for (std::size_t v = 0; v < cloud.size(); ++v) wrong += cloud.means[v].x != static_cast<float>(v);
  CHECK(wrong == 0);
}

TEST_CASE("ply reader: text in every spelling of a number") {
  const test::ScratchFolder scratch;
  PlyTable table = counting_table(0, 0);
  table.format = "ascii";
  const std::string header = test::header_of(table);
  const std::string counted = header.substr(0, header.find("vertex 0")) + "vertex 1" +
                              header.substr(header.find("vertex 0") + 8);
  const std::string line = "\n  +1.5 -2e3\t1E-2 0 0 0 .5 5. -0 1e-50 3 4 5 1 0 0 0  \n\n";
  const GaussianCloud cloud = read_ply(scratch.write("a.ply", counted + line)).cloud;
  CHECK(cloud.means[0] == glm::vec3(1.5f, -2000.0f, 0.01f));
  CHECK(cloud.sh_coeffs[0] == glm::vec3(0.5f, 5.0f, 0.0f));
  CHECK(cloud.opacity_logits[0] == 0.0f);  // 1e-50 is nearest to 0
}
