// .spz: every field of every version, by the formulas of the format.
#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/scene/ply_header.h"
#include "algorithm/scene_files/load_scene.h"
#include "tests/algorithm/scene_files/made_scene_files.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;
using test::code;

namespace {

void check_gaussian(const GaussianCloud& cloud, std::size_t i, std::uint32_t version) {
  const double unit = version == 1 ? 1 : 256 / 4096.0, first = version == 1 ? 0 : -20000 / 4096.0;
  const int coeffs = sh_coeff_count(cloud.sh_degree);
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(cloud.means[i][axis] == static_cast<float>(first + unit * code(i, axis)));
    CHECK(cloud.log_scales[i][axis] == static_cast<float>(code(i, 7 + axis) / 16.0 - 10));
    CHECK(cloud.sh_coeffs[i * coeffs][axis] ==
          static_cast<float>((code(i, 4 + axis) / 255.0 - 0.5) / 0.15));
    for (int k = 1; k < coeffs; ++k) {
      const double byte = code(i, 13 + 3 * (k - 1) + axis);
      CHECK(cloud.sh_coeffs[i * coeffs + k][axis] == static_cast<float>(byte / 128 - 1));
    }
  }
  const double opacity = code(i, 3) / 255.0;
  CHECK(cloud.opacity_logits[i] == static_cast<float>(std::log(opacity / (1 - opacity))));
  // x y z w in the file, w x y z in the cloud.
  const auto at = [&](std::size_t xyzw) { return cloud.quats[i][(xyzw + 1) % 4]; };
  if (version < 3) {
    for (int k = 0; k < 3; ++k) {
      CHECK(at(k) == static_cast<float>(code(i, 10 + k) / 127.5 - 1));
    }
    CHECK(at(3) >= 0);
    return;
  }
  int stored = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (k == i % 4) continue;
    // code << 1: nine bits of magnitude and the sign.
    const double magnitude = code(i, 10 + stored++) * 2 % 512 / 511.0;
    CHECK(at(k) == Approx(magnitude * std::sqrt(0.5)).margin(1e-7));
  }
  CHECK(at(i % 4) >= 0);
}

}  // namespace

TEST_CASE("spz: every field of every version and degree") {
  const test::ScratchFolder scratch;
  for (const std::uint32_t version : {1U, 2U, 3U, 4U}) {
    for (const int degree : {0, 1, 2, 3}) {
      CAPTURE(version, degree);
      const Scene scene = load_scene(scratch.write("a.spz", test::spz_bytes(version, 9, degree)));
      CHECK(scene.form == "SPZ");
      REQUIRE(scene.notes.size() == 1);
      CHECK_THAT(scene.notes[0], Contains("needs --scene-axes rub"));
      REQUIRE(scene.cloud.size() == 9);
      REQUIRE(scene.cloud.sh_degree == degree);
      for (std::size_t i = 0; i < 9; ++i) check_gaussian(scene.cloud, i, version);
    }
  }
}

TEST_CASE("spz: whatever it is called, and without gzip") {
  const test::ScratchFolder scratch;
  CHECK(load_scene(scratch.write("phone.bin", test::spz_bytes(2, 3, 1))).cloud.size() == 3);
  const std::string bare = test::bare_spz_bytes(3, 3, 1);
  CHECK(load_scene(scratch.write("bare.spz", bare)).cloud.quats ==
        load_scene(scratch.write("a.spz", test::spz_bytes(3, 3, 1))).cloud.quats);
}

TEST_CASE("spz: a scene for anti-aliased rasterisers is noted") {
  const test::ScratchFolder scratch;
  std::string bytes = test::spz_bytes(4, 3, 1);
  bytes[14] = 1;
  const Scene scene = load_scene(scratch.write("a.spz", bytes));
  REQUIRE(scene.notes.size() == 2);
  CHECK(scene.notes[0] == kAntialiasedNote);
}

namespace {

std::string record(std::uint32_t type, const std::string& body) {
  std::string bytes;
  test::put(bytes, type);
  test::put(bytes, static_cast<std::uint32_t>(body.size()));
  return bytes + body;
}

std::string axes_record(std::uint32_t system) {
  std::string body;
  test::put(body, system);
  return record(0xadbe0003, body);
}

// Three Gaussians of degree 1 with extensions: behind the header from version 4 on, else at the
// end.
std::string extended(std::uint32_t version, const std::string& records) {
  if (version < 4) {
    std::string bytes = test::bare_spz_bytes(version, 3, 1);
    bytes[14] = 2;
    return test::gzip_bytes(bytes + records);
  }
  std::string bytes = test::spz_bytes(version, 3, 1);
  bytes[14] = 2;
  test::put_at(bytes, 16, static_cast<std::uint32_t>(32 + records.size()));
  return bytes.insert(32, records);
}

}  // namespace

TEST_CASE("spz: extensions state axes, or are noted") {
  const test::ScratchFolder scratch;
  for (const std::uint32_t version : {2U, 3U, 4U}) {
    CAPTURE(version);
    const GaussianCloud plain =
        load_scene(scratch.write("a.spz", test::spz_bytes(version, 3, 1))).cloud;
    const std::string path = scratch.write(
        "b.spz", extended(version, record(0xadbe0002, "0123456789ab") +
                                       record(0x12340001, "secret") + axes_record(4)));
    const Scene turned = load_scene(path);
    CHECK(turned.axes == "rub");
    REQUIRE(turned.notes.size() == 3);
    CHECK_THAT(turned.notes[0], Contains("limits for a viewer's camera are skipped"));
    CHECK_THAT(turned.notes[1], Contains("extension 0x12340001 of 6 bytes is not known here"));
    CHECK(turned.notes[2] == "turned from axes rub to right, down, forward");
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(turned.cloud.means[i] == plain.means[i] * glm::vec3(1, -1, -1));
      // (0, -1, 0, 0), half a turn about x, times the quaternion.
      CHECK(turned.cloud.quats[i][0] == plain.quats[i][1]);
      CHECK(turned.cloud.quats[i][1] == -plain.quats[i][0]);
      CHECK(turned.cloud.quats[i][2] == plain.quats[i][3]);
      CHECK(turned.cloud.quats[i][3] == -plain.quats[i][2]);
      // Coefficients go with y, z and x.
      CHECK(turned.cloud.sh_coeffs[4 * i + 1] == -plain.sh_coeffs[4 * i + 1]);
      CHECK(turned.cloud.sh_coeffs[4 * i + 2] == -plain.sh_coeffs[4 * i + 2]);
      CHECK(turned.cloud.sh_coeffs[4 * i + 3] == plain.sh_coeffs[4 * i + 3]);
    }
    SceneReadOptions as_stored;
    as_stored.axes = "rdf";
    const Scene other = load_scene(path, as_stored);
    CHECK(other.axes.empty());
    CHECK(other.cloud.means == plain.means);
    CHECK(load_scene(scratch.write("c.spz", extended(version, axes_record(6)))).cloud.quats ==
          plain.quats);
  }
}

TEST_CASE("spz refuses: damaged extensions, axes that mirror, extensions without their flag") {
  const test::ScratchFolder scratch;
  const auto refusal = [&](const std::string& bytes) {
    return test::input_error_of([&] { load_scene(scratch.write("a.spz", bytes)); });
  };
  for (const std::uint32_t version : {3U, 4U}) {
    CHECK_THAT(refusal(extended(version, axes_record(8))), Contains("got the axes ruf, expected"));
    CHECK_THAT(refusal(extended(version, axes_record(17))), Contains("coordinate system 17"));
    CHECK_THAT(refusal(extended(version, record(0xadbe0003, "x"))), Contains("in 1 bytes"));
    CHECK_THAT(refusal(extended(version, axes_record(4).substr(0, 11))),
               Contains("an extension of 4 bytes in 11"));
  }
  std::string unmarked = extended(4, axes_record(4));
  unmarked[14] = 0;
  CHECK_THAT(refusal(unmarked), Contains("12 bytes before the table of streams"));
}

TEST_CASE("spz refuses: what it cannot be, by name") {
  const test::ScratchFolder scratch;
  const auto refusal = [&](const std::string& bytes) {
    return test::input_error_of([&] { load_scene(scratch.write("a.spz", bytes)); });
  };
  const auto changed = [&](std::string bytes, std::size_t at, int byte) {
    bytes[at] = static_cast<char>(byte);
    return bytes;
  };
  const std::string bare = test::bare_spz_bytes(2, 3, 1), zstd = test::spz_bytes(4, 3, 1);
  CHECK_THAT(refusal(changed(bare, 4, 5)), Contains("got version 5 of .spz, expected 1 to 4"));
  CHECK_THAT(refusal(changed(bare, 14, 0x80)), Contains("got the flags 0x80, expected 0x01"));
  CHECK_THAT(refusal(changed(bare, 12, 4)), Contains("got SH degree 4, expected 0 to 3"));
  CHECK_THAT(refusal(changed(bare, 13, 31)), Contains("31 fractional bits"));
  CHECK_THAT(refusal(test::gzip_bytes("solid cube, more than sixteen bytes")),
             Contains("expected NGSP"));
  CHECK_THAT(refusal(bare + "x"), Contains("for 3 Gaussians"));
  CHECK_THAT(refusal(test::gzip_bytes(bare + "x")), Contains("the gzip stream"));
  CHECK_THAT(refusal(test::gzip_bytes(bare) + "x"), Contains("1 bytes behind the gzip stream"));
  CHECK_THAT(refusal(test::gzip_bytes(bare.substr(0, 40))), Contains("out of gzip, expected"));
  CHECK_THAT(refusal(test::gzip_bytes(changed(bare, 11, 0x7f))),
             Contains("compressed bytes, expected more for"));
  CHECK_THAT(refusal(changed(zstd, 11, 0x7f)), Contains("stream 0 of 27 bytes"));
  CHECK_THAT(refusal(changed(zstd, 15, 5)), Contains("got 5 streams, expected 6"));
  CHECK_THAT(refusal(changed(zstd, 17, 9)), Contains("a table of streams at byte"));
  CHECK_THAT(refusal(zstd + "x"), Contains("1 bytes behind the last stream"));
  CHECK_THAT(refusal(test::gzip_bytes(zstd)), Contains("in gzip, expected it bare"));
}
