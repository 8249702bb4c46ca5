// SOG: every field, by the formulas of the format; folders, zips, levels.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "algorithm/scene/ply_header.h"
#include "algorithm/scene_files/load_scene.h"
#include "tests/algorithm/scene_files/made_scene_files.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;
using test::code;

namespace {

void write_parts(const test::ScratchFolder& scratch, const std::string& folder,
                 const std::vector<test::Part>& parts) {
  std::filesystem::create_directories(scratch.path(folder));
  for (const test::Part& part : parts) scratch.write(folder + "/" + part.name, part.bytes);
}

void check_gaussian(const GaussianCloud& cloud, std::size_t i) {
  const int coeffs = sh_coeff_count(cloud.sh_degree);
  for (int axis = 0; axis < 3; ++axis) {
    const double value = -2 + 4 * (code(i, axis) + 256 * code(i, 3 + axis)) / 65535.0;
    const double place = std::copysign(std::exp(std::abs(value)) - 1, value);
    CHECK(cloud.means[i][axis] == Approx(place).epsilon(1e-6));
    CHECK(cloud.log_scales[i][axis] == static_cast<float>(code(i, 9 + axis) / 64.0 - 5));
    CHECK(cloud.sh_coeffs[i * coeffs][axis] == static_cast<float>(code(i, 12 + axis) / 128.0 - 1));
    for (int k = 1; k < coeffs; ++k) {
      CHECK(cloud.sh_coeffs[i * coeffs + k][axis] ==
            static_cast<float>(code(i % 3, 20 + 3 * (k - 1) + axis) / 256.0 - 0.5));
    }
  }
  const double opacity = std::clamp(code(i, 15) / 255.0, 1e-6, 1 - 1e-6);
  CHECK(cloud.opacity_logits[i] == Approx(std::log(opacity / (1 - opacity))));
  int stored = 0;
  for (int k = 0; k < 4; ++k) {
    if (k == static_cast<int>(i % 4)) continue;
    const double part = (code(i, 6 + stored++) / 127.5 - 1) / std::sqrt(2.0);
    CHECK(cloud.quats[i][k] == Approx(part).margin(1e-7));
  }
  CHECK(cloud.quats[i][i % 4] >= 0);
}

// That the scene cannot be read without any of its files, and that there are so many.
void check_files(const std::string& path, const SceneReadOptions& options, std::size_t count) {
  const std::vector<std::string> files = files_of_scene(path, options);
  CHECK(files.size() == count);
  for (const std::string& file : files) {
    CAPTURE(file);
    std::filesystem::rename(file, file + ".away");
    CHECK_THROWS_AS(load_scene(path, options), InputError);
    std::filesystem::rename(file + ".away", file);
  }
  load_scene(path, options);
}

// Of three levels of 5, 3 and 2 Gaussians, the first in two files.
std::string lod_meta() {
  return R"({"version": 1, "lodLevels": 3, "counts": [5, 3, 2], "environment": "sky/meta.json",
"filenames": ["0_0/meta.json", "0_1/meta.json", "1_0/meta.json", "2_0/meta.json"],
"tree": {"children": [
 {"lods": {"0": {"file": 1, "offset": 0, "count": 1}, "1": {"file": 2, "offset": 0, "count": 3}}},
 {"lods": {"0": {"file": 0, "offset": 0, "count": 4}, "2": {"file": 3, "offset": 0, "count": 2}}}]}})";
}

}  // namespace

TEST_CASE("sog: every field, in a folder, by its meta.json and in a zip") {
  const test::ScratchFolder scratch;
  for (const int degree : {0, 1, 2, 3}) {
    const std::vector<test::Part> parts = test::sog_parts(10, degree);
    write_parts(scratch, "room", parts);
    scratch.write("house.sog", test::zip_bytes(parts));
    for (const char* path : {"room", "room/", "room/meta.json", "house.sog"}) {
      CAPTURE(degree, path);
      const Scene scene = load_scene(scratch.path(path));
      CHECK(scene.form == "SOG");
      CHECK(scene.name == (path[0] == 'h' ? "house" : "room"));
      REQUIRE(scene.cloud.size() == 10);
      REQUIRE(scene.cloud.sh_degree == degree);
      for (std::size_t i = 0; i < 10; ++i) check_gaussian(scene.cloud, i);
    }
    std::filesystem::remove_all(scratch.path("room"));
  }
}

TEST_CASE("sog: a level of a streamed scene") {
  const test::ScratchFolder scratch;
  write_parts(scratch, "town/0_0", test::sog_parts(4, 1));
  write_parts(scratch, "town/0_1", test::sog_parts(1, 1));
  write_parts(scratch, "town/1_0", test::sog_parts(3, 1));
  write_parts(scratch, "town/2_0", test::sog_parts(2, 1));
  const std::string meta = scratch.write("town/lod-meta.json", lod_meta());
  const Scene finest = load_scene(scratch.path("town"));
  CHECK(finest.name == "town");
  CHECK(finest.form == "streamed SOG");
  REQUIRE(finest.cloud.size() == 5);
  CHECK(finest.cloud.means[4] == finest.cloud.means[0]);  // files in the order of their numbers
  REQUIRE(finest.notes.size() == 2);
  CHECK(finest.notes[0] == "level 0 of 0 to 2, 0 the finest");
  CHECK_THAT(finest.notes[1], Contains("sky/meta.json"));
  for (const auto& [level, count] : {std::pair{1U, 3U}, {2U, 2U}}) {
    CHECK(load_scene(meta, {false, level}).cloud.size() == count);
  }
  CHECK_THAT(test::input_error_of([&] {
               load_scene(meta, {false, 3});
             }),
             Contains("got level 3, expected one of its 3 levels"));
  SceneReadOptions coarsest;
  coarsest.level = 2;
  check_files(meta, coarsest, 8 + 1);
  CHECK(files_of_scene(meta).size() == 2 * 8 + 1);
  write_parts(scratch, "town/2_0", test::sog_parts(3, 1));
  CHECK_THAT(test::input_error_of([&] {
               load_scene(meta, {false, 2});
             }),
             Contains("got 3 Gaussians, expected 2"));
}

TEST_CASE("sog: its files are those that it is read from, whatever else the folder holds") {
  const test::ScratchFolder scratch;
  write_parts(scratch, "room", test::sog_parts(3, 1));
  write_parts(scratch, "room/out", {{"report.json", "{}"}});
  check_files(scratch.path("room"), {}, 8);
  scratch.write("a.sog", test::zip_bytes(test::sog_parts(3, 1)));
  check_files(scratch.path("a.sog"), {}, 1);
}

TEST_CASE("sog: Gaussians without a label or a rotation are counted") {
  const test::ScratchFolder scratch;
  std::vector<test::Part> parts = test::sog_parts(10, 1);
  std::string& meta = parts[0].bytes;
  meta.replace(meta.find("\"count\": 3"), 10, "\"count\": 2");
  for (test::Part& part : parts) {
    if (part.name != "quats.webp") continue;
    std::vector<std::uint8_t> rgba(12 * 4, 251);
    rgba[3] = 252;
    part.bytes = test::webp_bytes(rgba, 4);
  }
  const Scene scene = load_scene(scratch.write("a.sog", test::zip_bytes(parts)));
  CHECK(scene.notes ==
        std::vector<std::string>{"9 Gaussians have no rotation and are not turned",
                                 "3 Gaussians have labels beyond the palette of 2 and look alike "
                                 "from all sides"});
  CHECK(scene.cloud.quats[1] == std::array<float, 4>{1, 0, 0, 0});
  CHECK(scene.cloud.sh_coeffs[2 * 4 + 1] == glm::vec3(0));
  CHECK(scene.cloud.sh_coeffs[3 * 4 + 1] != glm::vec3(0));
}

TEST_CASE("sog: training for an anti-aliased rasteriser is noted, however it is said") {
  const test::ScratchFolder scratch;
  const auto notes_with = [&](const std::string& member) {
    std::vector<test::Part> parts = test::sog_parts(4, 0);
    parts[0].bytes.replace(0, 1, "{" + member + ", ");
    return load_scene(scratch.write("a.sog", test::zip_bytes(parts))).notes;
  };
  const std::vector<std::string> noted = {kAntialiasedNote};
  CHECK(notes_with(R"("model": "antialiased")") == noted);
  CHECK(notes_with(R"("antialias": true)") == noted);
  CHECK(notes_with(R"("antialias": false)").empty());
}

TEST_CASE("sog: a folder whose meta.json is of something else is no scene") {
  const test::ScratchFolder scratch;
  write_parts(scratch, "photographs", {{"meta.json", R"({"camera": "phone"})"}});
  CHECK_FALSE(is_scene_file(scratch.path("photographs")));
}

TEST_CASE("sog refuses: other versions, missing parts, small pictures, names that lead elsewhere") {
  const test::ScratchFolder scratch;
  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::vector<test::Part> parts = test::sog_parts(10, 1);
    std::string& meta = parts[0].bytes;
    const std::size_t at = meta.find(from);
    REQUIRE(at != std::string::npos);
    meta.replace(at, from.size(), to);
    const std::string path = scratch.write("a.sog", test::zip_bytes(parts));
    const std::string in_zip = test::input_error_of([&] { load_scene(path); });
    write_parts(scratch, "a", parts);
    test::input_error_of([&] { load_scene(scratch.path("a")); });
    return in_zip;
  };
  CHECK_THAT(refusal("\"version\": 2, ", ""),
             Contains("splat-transform makes it of a SOG of version 1"));
  CHECK_THAT(refusal("\"version\": 2", "\"version\": 3"), Contains("version: got 3, expected 2"));
  CHECK_THAT(refusal("\"count\": 10", "\"count\": 4000000000"),
             Contains("px, expected at least 4000000000 px"));
  CHECK_THAT(refusal("\"count\": 10", "\"count\": -1"), Contains("count: got -1"));
  CHECK_THAT(refusal("quats.webp", "other.webp"), Contains("other.webp"));
  CHECK_THAT(refusal("quats.webp", "../quats.webp"), Contains("expected one below this place"));
  CHECK_THAT(refusal("quats.webp", "meta.json"), Contains("expected a WebP image"));
  CHECK_THAT(refusal("\"bands\": 1", "\"bands\": 2"), Contains("shN_centroids.webp"));
  CHECK_THAT(refusal("\"bands\": 1", "\"bands\": 4"), Contains("bands: got 4, expected 1 to 3"));
  CHECK_THAT(refusal("\"count\": 3", "\"count\": 65"), Contains("shN_centroids.webp"));
  CHECK_THAT(refusal("\"mins\": [-2, -2, -2]", "\"mins\": [-2, -2]"), Contains("3 numbers"));
  CHECK_THAT(refusal("\"version\": 2", "\"model\": \"2dgs\", \"version\": 2"), Contains("2dgs"));
}
