// Compressed PLY: every field, by the formulas of the format.
#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/scene/ply_header.h"
#include "algorithm/scene_files/load_scene.h"
#include "tests/algorithm/scene_files/made_scene_files.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;
using test::code;

TEST_CASE("compressed ply: every field, chunk by chunk") {
  const test::ScratchFolder scratch;
  for (const int degree : {0, 1, 3}) {
    for (const bool bounded : {false, true}) {
      const Scene scene = load_scene(
          scratch.write("a.compressed.ply", test::compressed_ply_bytes(300, degree, bounded)));
      CHECK(scene.name == "a.compressed");
      CHECK(scene.form == "compressed PLY");
      REQUIRE(scene.cloud.size() == 300);
      REQUIRE(scene.cloud.sh_degree == degree);
      for (const std::size_t i : {0, 1, 2, 3, 255, 256, 299}) {
        CAPTURE(i, degree, bounded);
        const double least = i < 256 ? -1 : -2, most = i < 256 ? 3 : 4;
        const double x = 8 * code(i, 0) / 2047.0, y = 4 * code(i, 1) / 1023.0;
        CHECK(scene.cloud.means[i].x == Approx(least + (most - least) * x).epsilon(1e-6));
        CHECK(scene.cloud.means[i].y == Approx(y).epsilon(1e-6));
        CHECK(scene.cloud.log_scales[i].x == Approx(-8 + 7 * x).epsilon(1e-6));
        CHECK(scene.cloud.log_scales[i].y == Approx(-8 + 7 * y).epsilon(1e-6));
        const double opacity = code(i, 9) / 255.0;
        CHECK(scene.cloud.opacity_logits[i] == Approx(std::log(opacity / (1 - opacity))));
        const double red =
            0.5 + 0.28209479177387814 * scene.cloud.sh_coeffs[i * (degree + 1) * (degree + 1)].x;
        CHECK(red * 255 == Approx(code(i, 6)).margin(1e-4));
        // The component that is not stored is the largest, positive, and makes the length 1.
        double squared = 0;
        int stored = 0;
        for (int k = 0; k < 4; ++k) {
          const double part = scene.cloud.quats[i][k];
          squared += part * part;
          if (k == static_cast<int>(i % 4)) continue;
          CHECK(part ==
                Approx((4 * code(i, 3 + stored++) / 1023.0 - 0.5) * std::sqrt(2.0)).margin(1e-7));
        }
        CHECK((squared == Approx(1) || scene.cloud.quats[i][i % 4] == 0));
        if (degree == 0) continue;
        const int coeffs = (degree + 1) * (degree + 1), rest = coeffs - 1;
        for (int channel = 0; channel < 3; ++channel) {
          const std::uint32_t byte = code(i, 10 + channel * rest + 1);
          const double share = byte == 0 ? 0 : byte == 255 ? 1 : (byte + 0.5) / 256;
          CHECK(scene.cloud.sh_coeffs[i * coeffs + 2][channel] ==
                static_cast<float>((share - 0.5) * 8));
        }
      }
    }
  }
}

TEST_CASE("compressed ply: opacities of 0 and 1 are infinite logits, ends of SH are exact") {
  const test::ScratchFolder scratch;
  std::string bytes = test::compressed_ply_bytes(2, 1, false);
  const std::size_t sh = bytes.size() - 2 * 9;
  bytes[sh - 4] = '\0';     // opacity of the last one
  bytes[sh - 20] = '\xff';  // of the first one
  bytes[sh] = '\0';
  bytes[sh + 9] = '\xff';
  const GaussianCloud cloud = load_scene(scratch.write("a.ply", bytes)).cloud;
  CHECK(cloud.opacity_logits[0] == INFINITY);
  CHECK(cloud.opacity_logits[1] == -INFINITY);
  CHECK(cloud.sh_coeffs[1].x == -4);
  CHECK(cloud.sh_coeffs[5].x == 4);
}

TEST_CASE("compressed ply: what is skipped is noted, other kinds are refused") {
  const test::ScratchFolder scratch;
  const auto renamed = [&](const std::string& from, const std::string& to) {
    std::string bytes = test::compressed_ply_bytes(3, 1, true);
    bytes.replace(bytes.find(from), from.size(), to);
    return scratch.write("a.ply", bytes);
  };
  CHECK(load_scene(renamed("min_r", "other")).notes ==
        std::vector<std::string>{"6 properties are skipped, since no picture needs them: other, "
                                 "min_g, min_b, max_r, max_g, max_b"});
  CHECK(load_scene(renamed("end_header", "comment Antialiased 1\nend_header")).notes ==
        std::vector<std::string>{kAntialiasedNote});
  CHECK_THAT(test::input_error_of([&] {
               load_scene(renamed("end_header", "comment SplatRenderMode: 2dgs\nend_header"));
             }),
             Contains("surfels of 2DGS"));
}

TEST_CASE("compressed ply refuses: counts, types and properties that do not fit") {
  const test::ScratchFolder scratch;
  const std::string good = test::compressed_ply_bytes(3, 1, true);
  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::string bytes = good;
    bytes.replace(bytes.find(from), from.size(), to);
    return test::input_error_of([&] { load_scene(scratch.write("a.ply", bytes)); });
  };
  CHECK_THAT(refusal("uint packed_rotation", "uint packed_other"),
             Contains("element vertex: got no property uint packed_rotation"));
  CHECK_THAT(refusal("uint packed_rotation", "float packed_rotation"),
             Contains("got no property uint packed_rotation"));
  CHECK_THAT(refusal("float max_scale_y", "float max_other"),
             Contains("element chunk: got no property float max_scale_y"));
  CHECK_THAT(refusal("f_rest_8", "f_rest_9"), Contains("got no property uchar f_rest_8"));
  CHECK_THAT(refusal("property uchar f_rest_8\n", ""), Contains("3 bytes after the last record"));
  CHECK_THAT(refusal("element vertex 3", "element vertex 2"), Contains("bytes after the last"));
  CHECK_THAT(refusal("element vertex 3", "element vertex 4000000000"), Contains("records of"));
  CHECK_THAT(refusal("element chunk 1", "element chunk 0"), Contains("bytes after the last"));
  CHECK_THAT(refusal("binary_little_endian", "ascii"), Contains("as text, expected a binary one"));
}
