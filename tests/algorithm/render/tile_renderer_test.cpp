// The tile-centric renderer gives the reference image bit for bit where its boxes reach what is
// visible and its numbers are floats; what each approximation costs by itself.
#include "algorithm/render/tile_renderer.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "algorithm/image/quality.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "testbench/builtin/builtin_scene.h"
#include "tests/algorithm/render/exact_checks.h"
#include "tests/algorithm/render/test_clouds.h"
#include "tests/algorithm/voxel/hard_scenes.h"

using namespace sgs;

namespace {

// Of boxes: with every test and bitmap; and by the square of 3 sigma alone, which is the
// reference's own.
std::vector<TileOrderConfig> lossless_configs() {
  std::vector<TileOrderConfig> configs;
  for (const TileTest test : {TileTest::kBox, TileTest::kOriented}) {
    for (const int across : {1, 2, 4}) {
      configs.push_back(TileOrderConfig::lossless());
      configs.back().rules.test = test;
      configs.back().rules.subtiles_across = across;
    }
  }
  configs.push_back(TileOrderConfig::lossless());
  configs.back().rules = {TileReach::kThreeSigma, TileTest::kBox, 1};
  return configs;
}

void check_lossless(const View<float>& view, const ActivatedCloud& cloud,
                    const TileOrderConfig& config) {
  CAPTURE(static_cast<int>(config.rules.test), config.rules.subtiles_across);
  CHECK(test::first_difference(render_tiles(view, cloud, config).frame,
                               render_reference(view, cloud, config.background)) == "");
}

}  // namespace

TEST_CASE("tile-centric equals the reference: random hard scenes") {
  const std::vector<TileOrderConfig> configs = lossless_configs();
  std::uint64_t contributors = 0, spared = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    test::HardScenes hard(seed);
    constexpr std::size_t kCounts[] = {0, 1, 30, 300, 2000};
    const test::HardScene scene = hard.next(kCounts[hard.pick(5)], hard.pick(20) == 0 ? 1 : 160);
    const ActivatedCloud cloud = activate(scene.cloud);
    const View<float> view = make_view<float>(scene.camera);
    const TileOrderConfig& config =
        configs[static_cast<std::size_t>(hard.pick(static_cast<int>(configs.size())))];
    CAPTURE(seed);
    check_lossless(view, cloud, config);
    const TileStats stats = render_tiles(view, cloud, config).stats;
    contributors += stats.contributors;
    spared += stats.tile_tests - stats.pairs;
  }
  CHECK(contributors > 1000000);
  CHECK(spared > 1000);
}

TEST_CASE("tile-centric equals the reference: needles across the frame") {
  for (unsigned seed = 0; seed < 40; ++seed) {
    GaussianCloud cloud = test::random_cloud(seed, 300, 0, {0, 0, 3}, 3, 0.1F, 1.0F);
    for (auto& scales : cloud.log_scales) {
      scales = {std::log(0.8F), std::log(0.8F) - 0.2F * static_cast<float>(seed), std::log(1e-3F)};
    }
    for (float& logit : cloud.opacity_logits) logit = 3;
    for (const TileOrderConfig& config : lossless_configs()) {
      CAPTURE(seed);
      check_lossless(make_view<float>(test::forward_camera(200, 150, 150)), activate(cloud),
                     config);
    }
  }
}

TEST_CASE("tile-centric equals the reference: extreme clouds") {
  std::vector<GaussianCloud> clouds(2);  // the first is empty
  for (int i = 0; i < 20000; ++i) {      // at one point
    test::add_ball(clouds[1], {0, 0, 2}, 0.1, 0.01, {static_cast<float>(i % 3), 0.5F, 1});
  }
  clouds.emplace_back();  // on the camera, on the near plane, behind
  for (const float z : {0.0F, 0.2F, 0.20001F, -0.2F, -3.0F}) {
    test::add_ball(clouds.back(), {0, 0, z}, 0.05, 0.9, {1, 1, 1});
  }
  clouds.push_back(test::random_cloud(15, 1000, 0, {0, 0, 4}, 3, 0.02F, 0.2F));
  for (const double scale : {1e3, 1e6, 1e12}) {
    test::add_ball(clouds.back(), {0.5F, -0.25F, 1}, scale, 0.2, {0.25F, 0.5F, 1});
  }
  clouds.push_back(test::random_cloud(17, 1000, 0, {0, 0, 5}, 3, 0.02F, 0.2F));  // outliers
  for (std::size_t i = 0; i < 300; ++i) clouds.back().means[i] *= i % 2 == 0 ? 1e18F : 1e37F;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    for (const auto& [width, height] : {std::pair{1, 1}, {70, 50}, {17, 200}}) {
      for (const TileOrderConfig& config : lossless_configs()) {
        CAPTURE(i, width, height);
        check_lossless(make_view<float>(test::forward_camera(width, height, 120)),
                       activate(clouds[i]), config);
      }
    }
  }
}

TEST_CASE("tile-centric: what each approximation costs by itself on built-in scenes") {
  struct Approximation {
    const char* name;
    std::function<void(TileOrderConfig&)> make;
    double at_least_db;
  };
  const Approximation approximations[] = {
      {"oriented boxes of 3 sigma",
       [](TileOrderConfig& c) {
         c.rules = {TileReach::kThreeSigma, TileTest::kOriented, 1};
       },
       70},
      {"parts of tiles by boxes of 3 sigma",
       [](TileOrderConfig& c) {
         c.rules = {TileReach::kThreeSigma, TileTest::kBox, 2};
       },
       70},
      {"features in half", [](TileOrderConfig& c) { c.features = NumberFormat::kHalf; }, 65},
      {"keys in half", [](TileOrderConfig& c) { c.keys = NumberFormat::kHalf; }, 43},
      {"blending in half", [](TileOrderConfig& c) { c.precision = BlendPrecision::kHalf; }, 57},
      {"pixels in fixed point", [](TileOrderConfig& c) { c.precision = BlendPrecision::kFixed; },
       67},
      {"all of them", [](TileOrderConfig& c) { c = TileOrderConfig{}; }, 43},
  };
  for (const std::string spec : {"builtin:object?n=20000", "builtin:outdoor?n=40000"}) {
    const BuiltinScene scene = make_builtin_scene(spec);
    const ActivatedCloud cloud = activate(scene.cloud);
    const View<float> view = make_view<float>(scene.cameras[0]);
    const Image reference = render_reference(view, cloud, glm::vec3(0)).image;
    for (const TileOrderConfig& config : lossless_configs()) check_lossless(view, cloud, config);
    for (const Approximation& approximation : approximations) {
      TileOrderConfig config = TileOrderConfig::lossless();
      approximation.make(config);
      const double db = psnr_db(render_tiles(view, cloud, config).frame.image, reference);
      UNSCOPED_INFO(fmt::format("{}: {} {:.2f} dB", spec, approximation.name, db));
      CHECK(db > approximation.at_least_db);
      CHECK(std::isfinite(db));  // it does change something
    }
  }
}

TEST_CASE("tile-centric: counts add up, the same with one thread and with many") {
  const BuiltinScene scene = make_builtin_scene("builtin:object?n=10000");
  const ActivatedCloud cloud = activate(scene.cloud);
  const View<float> view = make_view<float>(scene.cameras[1]);
  const TileResult many = render_tiles(view, cloud, {});
  const TileStats& s = many.stats;
  CHECK(s.gaussians == cloud.size());
  CHECK(s.culled + s.projected <= s.gaussians);
  CHECK(s.projected <= s.pairs);
  CHECK(s.pairs <= s.tile_tests);
  CHECK(s.subtile_tests == 4 * s.tile_tests);
  CHECK(s.pairs <= s.parts);
  CHECK(s.parts <= 4 * s.pairs);
  CHECK(s.entries_taken <= s.pairs);
  CHECK(s.chunks_taken <= s.chunks);
  CHECK(s.contributing <= s.projected);
  CHECK(s.contributors <= 16 * s.subtile_blends);
  std::uint64_t contributors = 0;
  for (const std::uint32_t count : many.frame.contributors) contributors += count;
  CHECK(s.contributors == contributors);

  // A box along the ellipse spares tiles, a bitmap spares parts of them.
  TileOrderConfig config;
  config.rules.test = TileTest::kBox;
  CHECK(render_tiles(view, cloud, config).stats.pairs > s.pairs);
  config.rules = {TileReach::kThreeSigma, TileTest::kOriented, 1};
  const TileStats whole = render_tiles(view, cloud, config).stats;
  CHECK(whole.subtile_blends > s.subtile_blends);

  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const TileResult alone = render_tiles(view, cloud, {});
  CHECK(test::first_difference(alone.frame, many.frame) == "");
  CHECK(alone.stats.pairs == s.pairs);
  CHECK(alone.stats.misordered == s.misordered);
}
