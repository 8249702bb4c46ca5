// glTF: attributes, nodes, SPZ within.
#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/scene_files/load_scene.h"
#include "tests/algorithm/scene_files/made_scene_files.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;
using test::code;

namespace {

constexpr const char* kOrderNote =
    "it asks for an order by distance from the camera; Gaussians are drawn by depth, as the "
    "original draws them";

void replace(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("gltf: attributes, turned half about z") {
  const test::ScratchFolder scratch;
  for (const int degree : {0, 1, 2, 3}) {
    const Scene scene = load_scene(scratch.write("a.glb", test::glb_bytes(5, degree)));
    CHECK(scene.form == "glTF");
    CHECK(scene.notes == std::vector<std::string>{kOrderNote});
    REQUIRE(scene.cloud.size() == 5);
    REQUIRE(scene.cloud.sh_degree == degree);
    const int coeffs = sh_coeff_count(degree);
    for (std::size_t i = 0; i < 5; ++i) {
      const auto x = static_cast<float>(i);
      CHECK(scene.cloud.means[i] == glm::vec3(-x, -2 * x, 3 * x));
      CHECK(scene.cloud.log_scales[i].y == static_cast<float>(std::log(0.25)));
      // (0, 0, 0, -1) times (0.5, 0.5, 0.5, -0.5), w first.
      CHECK(scene.cloud.quats[i] == std::array<float, 4>{-0.5f, 0.5f, -0.5f, -0.5f});
      const double opacity = static_cast<float>(code(i, 0) / 255.0);
      CHECK(scene.cloud.opacity_logits[i] == static_cast<float>(std::log(opacity / (1 - opacity))));
      for (int k = 0; k < coeffs; ++k) {
        const int band = k < 1 ? 0 : k < 4 ? 1 : k < 9 ? 2 : 3;
        const float sign = (k - band * band - band) % 2 == 0 ? 1.0F : -1.0F;  // (-1)^m
        CHECK(scene.cloud.sh_coeffs[i * coeffs + k].y ==
              sign * (x + static_cast<float>(k) + 0.25F));
      }
    }
  }
}

TEST_CASE("gltf: nodes move, turn and scale") {
  const test::ScratchFolder scratch;
  const std::string node =
      R"(, "translation": [10, 20, 30], "rotation": [1, 0, 0, 0], "scale": [2, 2, 2])";
  const GaussianCloud cloud = load_scene(scratch.write("a.glb", test::glb_bytes(5, 1, node))).cloud;
  // (x, 2 x, 3 x), doubled, half about x, moved, half about z.
  CHECK(cloud.means[1] == glm::vec3(-12, -16, 24));
  CHECK(cloud.log_scales[1].x == Approx(0).margin(1e-7));
}

TEST_CASE("gltf: a .gltf with its buffer within or beside it") {
  const test::ScratchFolder scratch;
  const std::string glb = test::glb_bytes(2, 0);
  std::uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, &glb[12], sizeof json_bytes);
  std::string json = glb.substr(20, json_bytes);
  scratch.write("a.bin", glb.substr(28 + json_bytes));
  replace(json, "\"byteLength\"", "\"uri\": \"a.bin\", \"byteLength\"");
  const GaussianCloud beside = load_scene(scratch.write("a.gltf", json)).cloud;
  CHECK(beside.means[1] == glm::vec3(-1, -2, 3));
  scratch.write("other.bin", "x");
  CHECK(files_of_scene(scratch.path("a.gltf")) ==
        std::vector<std::string>{scratch.path("a.bin"), scratch.path("a.gltf")});
  replace(json, "a.bin", "data:application/octet-stream;base64,AAAA");
  CHECK_THAT(test::input_error_of([&] { load_scene(scratch.write("b.gltf", json)); }),
             Contains("expected at most the 3 bytes that are there"));
  replace(json, "AAAA", "AA*A");
  CHECK_THAT(test::input_error_of([&] { load_scene(scratch.write("b.gltf", json)); }),
             Contains("got \"*\" in base64"));
}

TEST_CASE("gltf: nodes may be nested as deep as one likes") {
  // To read a list of objects takes the square of their number: few, on a stack as small.
  constexpr int kNodes = 12'500;
  rlimit stack{};
  REQUIRE(getrlimit(RLIMIT_STACK, &stack) == 0);
  const rlimit small{1 << 20, stack.rlim_max};
  REQUIRE(setrlimit(RLIMIT_STACK, &small) == 0);
  std::string children = R"("children": [1]})";
  for (int i = 2; i < kNodes; ++i) children += ", {\"children\": [" + std::to_string(i) + "]}";
  std::string glb = test::glb_bytes(2, 0);
  std::uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, &glb[12], sizeof json_bytes);
  std::string json = glb.substr(20, json_bytes);
  replace(json, R"("nodes": [{)", R"("nodes": [{)" + children + ", {");
  const test::ScratchFolder scratch;
  const std::string deep = test::glb_of(json, glb.substr(28 + json_bytes));
  CHECK(load_scene(scratch.write("a.glb", deep)).cloud.means[1] == glm::vec3(-1, -2, 3));
  REQUIRE(setrlimit(RLIMIT_STACK, &stack) == 0);
}

TEST_CASE("gltf: an SPZ in a buffer view") {
  const test::ScratchFolder scratch;
  const std::string spz = test::spz_bytes(3, 6, 1);
  const GaussianCloud in_gltf = load_scene(scratch.write("a.glb", test::spz_glb_bytes(spz))).cloud;
  const GaussianCloud alone = load_scene(scratch.write("a.spz", spz)).cloud;
  REQUIRE(in_gltf.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(in_gltf.means[i] == alone.means[i] * glm::vec3(-1, -1, 1));
    CHECK(in_gltf.log_scales[i] == alone.log_scales[i]);
    CHECK(in_gltf.quats[i][3] == -alone.quats[i][0]);
    CHECK(in_gltf.sh_coeffs[4 * i + 1] == -alone.sh_coeffs[4 * i + 1]);
    CHECK(in_gltf.sh_coeffs[4 * i + 2] == alone.sh_coeffs[4 * i + 2]);
  }
}

TEST_CASE("gltf refuses: other kinds, and what does not fit its buffer") {
  const test::ScratchFolder scratch;
  const auto refusal = [&](const std::string& from, const std::string& to) {
    const std::string glb = test::glb_bytes(3, 1);
    std::uint32_t json_bytes = 0;
    std::memcpy(&json_bytes, &glb[12], sizeof json_bytes);
    std::string json = glb.substr(20, json_bytes);
    replace(json, from, to);
    const std::string bytes = test::glb_of(json, glb.substr(28 + json_bytes));
    return test::input_error_of([&] { load_scene(scratch.write("a.glb", bytes)); });
  };
  CHECK_THAT(refusal("srgb_rec709_display", "lin_rec709_display"),
             Contains("colorSpace: got \"lin_rec709_display\", expected \"srgb_rec709_display\""));
  CHECK_THAT(refusal("ellipse", "triangle"), Contains("kernel: got \"triangle\""));
  CHECK_THAT(refusal("\"KHR_gaussian_splatting\"", "\"KHR_other\""),
             Contains("no primitive with KHR_gaussian_splatting, expected Gaussians; it holds"));
  CHECK_THAT(refusal("\"kernel\"", "\"extensions\": {\"other\": 1}, \"kernel\""),
             Contains("expected none, or KHR_gaussian_splatting_compression_spz_2"));
  CHECK_THAT(refusal("\"mesh\": 0", "\"mesh\": 0, \"scale\": [1, 2, 1]"),
             Contains("does more than turn, move and scale alike"));
  CHECK_THAT(refusal("\"mesh\": 0", "\"children\": [0]"), Contains("got it twice in the tree"));
  CHECK_THAT(refusal("\"mesh\": 0", "\"mesh\": 1"), Contains("got meshes 1, expected at most 0"));
  CHECK_THAT(refusal("\"count\": 3", "\"count\": 4"), Contains("count: got 4"));
  CHECK_THAT(refusal("\"count\": 3", "\"count\": 4000000000"), Contains("count: got 4000000000"));
  CHECK_THAT(refusal("\"count\": 3", "\"count\": 2"), Contains("an accessor of 2 as POSITION"));
  CHECK_THAT(refusal("\"byteOffset\": 0", "\"byteOffset\": 9000"), Contains("byteLength"));
  for (const char* coefficient : {"SH_DEGREE_1_COEF_0", "SH_DEGREE_1_COEF_2"}) {
    CHECK_THAT(refusal(coefficient, "SH_DEGREE_1_COEF_9"), Contains(coefficient));
  }
  CHECK_THAT(refusal("\"kernel\"", R"("sortingMethod": "other", "kernel")"),
             Contains("sortingMethod: got \"other\", expected \"cameraDistance\""));
  CHECK_THAT(refusal("\"2.0\"", "\"1.0\""), Contains("version: got \"1.0\""));
  CHECK_THAT(refusal("\"scene\": 0", R"("extensionsRequired": ["EXT_other"], "scene": 0)"),
             Contains("extensionsRequired: got EXT_other, expected none but KHR_gaussian_spl"));
}

TEST_CASE("gltf refuses: logarithms in place of scales, also where faulty Gaussians are left out") {
  constexpr std::size_t kScales = 2 * (12 + 16);  // behind centres and quaternions
  const test::ScratchFolder scratch;
  std::string glb = test::glb_bytes(2, 0);
  std::uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, &glb[12], sizeof json_bytes);
  test::put_at(glb, 28 + json_bytes + kScales + 16, -4.5F);  // of Gaussian 1, along y
  const std::string path = scratch.write("a.glb", glb);
  for (const bool drop_invalid : {false, true}) {
    CHECK_THAT(test::input_error_of([&] { load_scene(path, {drop_invalid}); }),
               Contains("SCALE: got a scale of -4.5 of Gaussian 1, expected none below 0"));
  }
}
