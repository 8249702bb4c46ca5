// builtin_scene.h: specs, determinism, and that the scenes hold what they promise.
#include "testbench/builtin/builtin_scene.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <iomanip>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "algorithm/scene/describe.h"
#include "tests/support/same_bytes.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;
using sgs::test::same_bytes;

namespace {

bool same_bits(const GaussianCloud& a, const GaussianCloud& b) {
  return a.sh_degree == b.sh_degree && same_bytes(a.means, b.means) &&
         same_bytes(a.log_scales, b.log_scales) && same_bytes(a.quats, b.quats) &&
         same_bytes(a.opacity_logits, b.opacity_logits) && same_bytes(a.sh_coeffs, b.sh_coeffs);
}

void check_usable(const BuiltinScene& scene, std::size_t count, int width, int height) {
  const GaussianCloud& cloud = scene.cloud;
  REQUIRE(cloud.size() == count);
  REQUIRE(cloud.sh_degree == 3);
  REQUIRE(cloud.sh_coeffs.size() == 16 * count);
  std::size_t bad = 0;
  const auto finite = [](const glm::vec3& v) { return std::isfinite(v.x + v.y + v.z); };
  for (std::size_t i = 0; i < count; ++i) {
    const auto& q = cloud.quats[i];
    const float length2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    const bool good = finite(cloud.means[i]) && finite(cloud.log_scales[i]) &&
                      std::isfinite(cloud.opacity_logits[i]) && length2 > 0.2f && length2 < 4.1f;
    bad += good ? 0 : 1;
  }
  for (const glm::vec3& coeff : cloud.sh_coeffs) bad += finite(coeff) ? 0 : 1;
  CHECK(bad == 0);
  REQUIRE(scene.cameras.size() >= 4);
  for (const Camera& camera : scene.cameras) {
    CHECK(camera.width == width);
    CHECK(camera.height == height);
    CHECK(glm::determinant(camera.world_from_camera) == Approx(1.0));
    // Level horizon: the x axis has no vertical part, and the y axis points down.
    CHECK(camera.world_from_camera[0].y == Approx(0.0).margin(1e-12));
    CHECK(camera.world_from_camera[1].y > 0.5);
  }
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double deviation(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / count);
}

// Of values in their order, each with a weight of its own. Logarithmic, so that what lies far away
// does not hide the rest.
class Fingerprint {
 public:
  void add(double value) {
    constexpr double kGoldenRatio = 0.6180339887498949;
    const double turns = static_cast<double>(++count_) * kGoldenRatio;
    const double term = (1 + turns - std::floor(turns)) * std::asinh(value);
    sum_ += term;
    scale_ += std::abs(term);
  }
  void add(const glm::dvec3& v) {
    for (int axis = 0; axis < 3; ++axis) add(v[axis]);
  }
  void add(const Camera& camera) {
    add(camera.focal_x);
    add(camera.focal_y);
    add(camera.position);
    for (int axis = 0; axis < 3; ++axis) add(camera.world_from_camera[axis]);
  }
  double sum() const { return sum_; }
  double scale() const { return scale_; }

 private:
  std::uint64_t count_ = 0;
  double sum_ = 0, scale_ = 0;
};

}  // namespace

// The scenes are test data: measurements quote them by name, and a scene that has changed is
// another one. So these numbers are the program's own; who means to change a scene changes them,
// and measures again. A last bit that another compiler or library rounds otherwise is 1e-7 of one
// value.
TEST_CASE("built-in scenes: they are the ones that measurements were made with") {
  struct Row {
    const char* spec;
    double means, log_scales, quats, opacities, colours, cameras, path;
  };
  for (const Row& row : {Row{"builtin:capture?n=20000", -42817.2381, -103303.8848, 23380.0823,
                             -21854.7001, -64383.1109, 87.53034386, 778.32853244},
                         Row{"builtin:object?n=20000", -18000.7857, -189141.3029, 20749.5507,
                             36594.6909, -30234.4444, 107.18005882, 758.58498},
                         Row{"builtin:outdoor?n=20000", -36023.5788, -73104.8493, 21869.0594,
                             30450.7138, -52603.3623, 110.49658125, 518.13965}}) {
    INFO(row.spec);
    const BuiltinScene scene = make_builtin_scene(row.spec);
    Fingerprint means, log_scales, quats, opacities, colours, cameras, path;
    for (const glm::vec3& v : scene.cloud.means) means.add(glm::dvec3(v));
    for (const glm::vec3& v : scene.cloud.log_scales) log_scales.add(glm::dvec3(v));
    for (const auto& quat : scene.cloud.quats) {
      for (const float q : quat) quats.add(q);
    }
    for (const float logit : scene.cloud.opacity_logits) opacities.add(logit);
    for (const glm::vec3& v : scene.cloud.sh_coeffs) colours.add(glm::dvec3(v));
    for (const Camera& camera : scene.cameras) cameras.add(camera);
    for (const Camera& camera : builtin_path(row.spec).keys) path.add(camera);
    const auto check = [](const char* what, const Fingerprint& got, double wanted) {
      INFO(what << std::setprecision(12) << ": got " << got.sum() << ", expected " << wanted);
      CHECK(std::abs(got.sum() - wanted) <= 1e-6 * got.scale());
    };
    check("means", means, row.means);
    check("log scales", log_scales, row.log_scales);
    check("quaternions", quats, row.quats);
    check("opacities", opacities, row.opacities);
    check("colours", colours, row.colours);
    check("cameras", cameras, row.cameras);
    check("path", path, row.path);
  }
}

TEST_CASE("built-in scenes: any count from one on is usable") {
  for (const std::string name : {"capture", "object", "outdoor"}) {
    for (const std::size_t count : {1u, 2u, 3u, 10u, 257u, 5000u}) {
      CAPTURE(name, count);
      const BuiltinScene scene =
          make_builtin_scene("builtin:" + name + "?n=" + std::to_string(count));
      if (name == "capture") {
        check_usable(scene, count, 980, 545);
      } else {
        check_usable(scene, count, 640, 360);
      }
    }
  }
}

TEST_CASE("built-in scenes: default counts") {
  check_usable(make_builtin_scene("builtin:object"), 60'000, 640, 360);
  check_usable(make_builtin_scene("builtin:outdoor"), 200'000, 640, 360);
}

TEST_CASE("built-in scenes: the same bits again, on one thread too") {
  for (const char* spec :
       {"builtin:capture?n=20000", "builtin:object?n=20000", "builtin:outdoor?n=20000"}) {
    const BuiltinScene scene = make_builtin_scene(spec);
    CHECK(same_bits(scene.cloud, make_builtin_scene(spec).cloud));
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    CHECK(same_bits(scene.cloud, make_builtin_scene(spec).cloud));
  }
}

TEST_CASE("built-in scenes: the landscape has the extremes of a trained capture") {
  const SceneSummary summary = summarise(make_builtin_scene("builtin:outdoor").cloud);
  const float reach =
      glm::length(glm::max(glm::abs(summary.extent.min), glm::abs(summary.extent.max)));
  CHECK(reach > 15'000.0f);
  CHECK(reach < 40'000.0f);
  CHECK(summary.max_scale_ratio > 0.9e6);
  CHECK(summary.max_scale_ratio < 1e7);
  CHECK(summary.invisible_count > 500);
  CHECK(summary.invisible_count < 10'000);
  CHECK(summary.median_opacity > 0.6);
}

// Bounds are around what trained files of this kind hold: logarithms of scales, opacities, voxels.
TEST_CASE("built-in scenes: the capture is spread as training spreads, in COLMAP's unit") {
  for (const std::size_t count : {30'000u, 120'000u}) {
    CAPTURE(count);
    const BuiltinScene scene = make_builtin_scene("builtin:capture?n=" + std::to_string(count));
    const GaussianCloud& cloud = scene.cloud;
    std::vector<double> largest, opacities, aspects, flatness;
    std::set<std::array<int, 3>> voxels;
    std::size_t near = 0, on_screen = 0;
    const Camera& camera = scene.cameras.front();
    for (std::size_t i = 0; i < count; ++i) {
      glm::vec3 logs = cloud.log_scales[i];
      std::sort(&logs[0], &logs[0] + 3);
      largest.push_back(logs[2]);
      aspects.push_back(logs[2] - logs[1]);
      flatness.push_back(logs[1] - logs[0]);
      opacities.push_back(1 / (1 + std::exp(-cloud.opacity_logits[i])));
      const glm::dvec3 mean(cloud.means[i]);
      const glm::dvec3 cell = glm::floor(mean / 2.0);
      voxels.insert({static_cast<int>(cell.x), static_cast<int>(cell.y), static_cast<int>(cell.z)});
      near += glm::length(mean) < 8.0 ? 1 : 0;
      const glm::dvec3 seen = (mean - camera.position) * camera.world_from_camera;
      on_screen += seen.z > 0 && std::abs(seen.x) * camera.focal_x < 490 * seen.z &&
                           std::abs(seen.y) * camera.focal_y < 272 * seen.z
                       ? 1
                       : 0;
    }
    const auto check = [](const char* what, double value, double least, double most) {
      INFO(what << ": got " << value << ", expected " << least << " to " << most);
      CHECK(value >= least);
      CHECK(value <= most);
    };
    const auto share = [count](std::size_t of) {
      return static_cast<double>(of) / static_cast<double>(count);
    };
    const auto below = [&](double opacity) {
      return share(static_cast<std::size_t>(std::count_if(opacities.begin(), opacities.end(),
                                                          [=](double o) { return o < opacity; })));
    };
    check("deviation of the largest scale's logarithm", deviation(largest), 0.8, 1.2);
    check("largest over middle scale, median logarithm", median(aspects), 0.7, 1.3);
    check("middle over smallest scale, median logarithm", median(flatness), 1.2, 2.2);
    check("median opacity", median(opacities), 0.06, 0.4);
    check("opacity below 1/255", below(1.0 / 255), 0.05, 0.15);
    check("opacity above 0.8", 1 - below(0.8), 0.05, 0.3);
    check("voxels of 2", static_cast<double>(voxels.size()), 500, 3000);
    check("within 8 units", share(near), 0.1, 0.4);
    check("on the screen of a camera", share(on_screen), 0.15, 0.3);
    for (const Camera& each : scene.cameras)
      check("way of a camera from the rocket",
            glm::length(glm::dvec2(each.position.x, each.position.z)), 3.5, 4.5);
  }
}

TEST_CASE("built-in scenes: what a spec may not say") {
  CHECK(is_builtin_scene("builtin:object"));
  CHECK(is_builtin_scene("builtin:nonsense"));
  CHECK_FALSE(is_builtin_scene("object"));
  CHECK_FALSE(is_builtin_scene("scene.ply"));
  CHECK_FALSE(is_builtin_scene(""));
  const auto refusal = [](const std::string& spec) {
    return test::input_error_of([&] { make_builtin_scene(spec); });
  };
  for (const char* spec : {"builtin:teapot", "builtin:", "builtin:?n=5", "object", ""}) {
    CHECK_THAT(refusal(spec),
               Contains("xpected one of builtin:capture builtin:object builtin:outdoor"));
  }
  for (const char* query : {"", "n", "n=", "n=0", "n=-1", "n=20000001", "n=1e5", "n=5 ", "n=5&n=6",
                            "m=5", "N=5", "n=99999999999999999999999"}) {
    CHECK_THAT(refusal(std::string("builtin:object?") + query),
               Contains("expected n=1 to n=20000000"));
  }
}
