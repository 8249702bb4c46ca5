// Kinds of ply_header.h through read_ply: what changes a picture is honoured or refused by name,
// the rest is noted; filter_3D and infinities.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/scene/ply_header.h"
#include "algorithm/scene/ply_reader.h"
#include "tests/algorithm/scene/ply_bytes.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;
using test::counting_table;
using test::PlyTable;

namespace {

void add_column(PlyTable& table, const std::string& name, double value) {
  table.columns.push_back({name, "float"});
  for (auto& row : table.rows) row.push_back(value);
}

void rename(PlyTable& table, const std::string& from, const std::string& to) {
  for (auto& column : table.columns) {
    if (column.name == from) column.name = to;
  }
}

std::string kind_refusal(const PlyTable& table) {
  const test::ScratchFolder scratch;
  const std::string path = scratch.write("a.ply", test::bytes_of(table));
  return test::input_error_of([&] { read_ply(path); });
}

// Table of one Gaussian with these parameters.
PlyTable one_gaussian(double opacity_logit, const std::array<double, 3>& log_scales) {
  PlyTable table = counting_table(1);
  table.rows[0][9] = opacity_logit;
  std::copy(log_scales.begin(), log_scales.end(), table.rows[0].begin() + 10);
  return table;
}

}  // namespace

TEST_CASE("ply kinds: other kinds of scenes are refused by name") {
  struct Row {
    const char *property, *message;
  };
  for (const Row& row : {Row{"sg_axis_0", "colours of spherical Gaussians (property sg_axis_0)"},
                         {"f_offset_3", "anchors of Scaffold-GS"},
                         {"beta", "Beta kernels"},
                         {"motion_0", "Gaussians that move"},
                         {"t", "Gaussians that move"}}) {
    PlyTable table = counting_table(2);
    add_column(table, row.property, 0.5);
    CHECK_THAT(kind_refusal(table), Contains(row.message));
  }
  PlyTable surfels = counting_table(2);
  rename(surfels, "scale_2", "other");
  CHECK_THAT(kind_refusal(surfels), Contains("got surfels of 2DGS, expected 3D Gaussians"));
  PlyTable marked = counting_table(2);
  marked.header_before = "comment SplatRenderMode: 2dgs\n";
  CHECK_THAT(kind_refusal(marked), Contains("got surfels of 2DGS"));
  PlyTable coloured = counting_table(2);
  for (int i = 0; i < 3; ++i) {
    constexpr const char* kNames[] = {"red", "green", "blue"};
    rename(coloured, "f_dc_" + std::to_string(i), kNames[i]);
  }
  CHECK_THAT(kind_refusal(coloured), Contains("colours as red, green, blue"));
  for (const char* name : {"opacity", "scale_0", "rot_0"})
    rename(coloured, name, std::string("other_") + name);
  CHECK_THAT(kind_refusal(coloured), Contains("a cloud of points without opacity"));
  CHECK_THAT(kind_refusal(counting_table(1, 72)), Contains("72 are SH degree 4"));
}

TEST_CASE("ply kinds: what is skipped is noted, normals are not") {
  const test::ScratchFolder scratch;
  PlyTable table = counting_table(2);
  CHECK(read_ply(scratch.write("a.ply", test::bytes_of(table))).notes.empty());
  add_column(table, "confidence", 1);
  add_column(table, "label", 2);
  table.header_after = "element camera 0\nproperty float fov\n";
  std::vector<std::string> notes = read_ply(scratch.write("a.ply", test::bytes_of(table))).notes;
  REQUIRE(notes.size() == 2);
  CHECK(notes[0] == "2 properties are skipped, since no picture needs them: confidence, label");
  CHECK(notes[1] == "1 element is skipped, since no picture needs it: camera");
  for (const char* comment :
       {"SplatRenderMode: mip", "Antialiased 1", "postshot.anti_aliasing=1"}) {
    PlyTable mip = counting_table(2);
    mip.header_before = std::string("comment ") + comment + "\n";
    notes = read_ply(scratch.write("a.ply", test::bytes_of(mip))).notes;
    CHECK(notes == std::vector<std::string>{kAntialiasedNote});
  }
}

TEST_CASE("ply kinds: filter_3D is baked as Mip-Splatting bakes it") {
  const test::ScratchFolder scratch;
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    PlyTable table = one_gaussian(1.5, {std::log(0.5), std::log(0.25), std::log(2.0)});
    table.format = format;
    add_column(table, "filter_3D", 0.75);
    const SceneContents read = read_ply(scratch.write("a.ply", test::bytes_of(table)));
    CHECK(read.notes == std::vector<std::string>{"filter_3D is baked into scales and opacities",
                                                 kAntialiasedNote});
    double before = 1, after = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double scale[] = {0.5, 0.25, 2.0};
      const double squared = scale[axis] * scale[axis];
      before *= squared;
      after *= squared + 0.5625;
      CHECK(read.cloud.log_scales[0][axis] == Approx(std::log(std::sqrt(squared + 0.5625))));
    }
    const double opacity = 1 / (1 + std::exp(-1.5)) * std::sqrt(before / after);
    CHECK(read.cloud.opacity_logits[0] == Approx(std::log(opacity / (1 - opacity))));
  }
}

TEST_CASE("ply kinds: a filter of 0 changes no bit, one that is no number is refused") {
  const test::ScratchFolder scratch;
  PlyTable table = one_gaussian(0.3, {-1.7, -2.9, 0.1});
  const GaussianCloud plain = read_ply(scratch.write("a.ply", test::bytes_of(table))).cloud;
  add_column(table, "filter_3D", 0);
  const GaussianCloud filtered = read_ply(scratch.write("b.ply", test::bytes_of(table))).cloud;
  CHECK(filtered.log_scales == plain.log_scales);
  CHECK(filtered.opacity_logits == plain.opacity_logits);
  for (const double value : {std::nan(""), double(INFINITY), 1e8}) {
    table.rows[0].back() = value;
    CHECK_THAT(kind_refusal(table), Contains("vertex 0, property filter_3D: got"));
    CHECK(read_ply(scratch.write("c.ply", test::bytes_of(table)), {true}).dropped_invalid == 1);
  }
  table.rows[0][10] = 17;  // too large, filter or not
  table.rows[0].back() = 1;
  CHECK_THAT(kind_refusal(table), Contains("vertex 0, property scale_0: got 17"));
}

TEST_CASE("ply kinds: infinities that activations make numbers of are read") {
  const test::ScratchFolder scratch;
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const double logit : {double(INFINITY), -double(INFINITY)}) {
      PlyTable table = one_gaussian(logit, {-INFINITY, -1, -2});
      table.format = format;
      const SceneContents read = read_ply(scratch.write("a.ply", test::bytes_of(table)), {true});
      CHECK(read.dropped_invalid == 0);
      CHECK(read.cloud.opacity_logits[0] == static_cast<float>(logit));
      CHECK(read.cloud.log_scales[0].x == -INFINITY);
    }
  }
  CHECK_THAT(kind_refusal(one_gaussian(NAN, {0, 0, 0})),
             Contains("property opacity: got nan, expected a number"));
  CHECK_THAT(kind_refusal(one_gaussian(0, {0, INFINITY, 0})),
             Contains("property scale_1: got inf, expected at most 16.1180956"));
}
