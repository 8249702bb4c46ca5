// Exact order gives the reference image bit for bit, whatever the groups, chunks, buffers and
// queues; blend_early gives it where the buffer suffices and a finite loss elsewhere.
#include "algorithm/render/exact_renderer.h"

#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "algorithm/image/quality.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "testbench/builtin/builtin_scene.h"
#include "tests/algorithm/render/exact_checks.h"
#include "tests/algorithm/render/test_clouds.h"
#include "tests/algorithm/voxel/stored_clouds.h"

using namespace sgs;
using test::difference_from_reference;

namespace {

struct Ready {
  ActivatedCloud cloud;
  View<float> view;
};

Ready cloud_before_camera(const GaussianCloud& cloud, int width_px, int height_px) {
  return {activate(cloud), make_view<float>(test::forward_camera(width_px, height_px, 120))};
}

ExactOrderConfig with_group(const PixelSize& group) {
  ExactOrderConfig config;
  config.group = group;
  return config;
}

bool same_picture(const StreamingResult& a, const StreamingResult& b) {
  return std::memcmp(a.frame.image.pixels.data(), b.frame.image.pixels.data(),
                     a.frame.image.pixels.size() * sizeof(glm::vec3)) == 0;
}

}  // namespace

TEST_CASE("exact order equals the reference: random hard scenes and configurations") {
  test::fuzz_exact_order(0, 500);
}

TEST_CASE("exact order equals the reference: principal points at every border of the frame") {
  const auto cloud = activate(test::random_cloud(7, 2000, 0, {0, 0, 4}, 5, 0.02F, 0.5F));
  const auto stored = test::by_chunks(cloud, 16);
  for (const glm::dvec2 offset : {glm::dvec2(-50, 0), {50, 23.5}, {0.25, -23}, {-31.75, 10}}) {
    Camera camera = test::forward_camera(100, 47, 90);
    camera.principal_offset = offset;
    for (const PixelSize group : {PixelSize{12, 4}, {16, 16}, {160, 120}}) {
      CAPTURE(offset.x, offset.y, group.width);
      CHECK(difference_from_reference(make_view<float>(camera), stored.cloud, stored.table,
                                      with_group(group)) == "");
    }
  }
}

TEST_CASE("exact order equals the reference: SH degrees 0 to 3, odd frames, every group size") {
  for (const int degree : {0, 1, 2, 3}) {
    const auto cloud = test::random_cloud(20 + static_cast<unsigned>(degree), 1500, degree,
                                          {0, 0, 4}, 4, 0.02F, 0.5F);
    for (const auto& [width, height] : {std::pair{1, 1}, {17, 1}, {1, 33}, {101, 47}}) {
      const Ready ready = cloud_before_camera(cloud, width, height);
      const auto stored = test::by_chunks(ready.cloud, 16);
      for (const PixelSize group :
           {PixelSize{4, 4}, {12, 4}, {4, 64}, {16, 16}, {160, 120}, {320, 180}}) {
        CAPTURE(degree, width, height, group.width, group.height);
        CHECK(difference_from_reference(ready.view, stored.cloud, stored.table,
                                        with_group(group)) == "");
      }
    }
  }
}

TEST_CASE("exact order equals the reference: extreme clouds") {
  std::vector<GaussianCloud> clouds;
  clouds.emplace_back();  // empty
  clouds.emplace_back();
  test::add_ball(clouds.back(), {0.1F, 0, 2}, 0.1, 0.8, {0.9F, 0.5F, 0.1F});
  clouds.emplace_back();  // 20,000 at one point
  for (int i = 0; i < 20000; ++i) {
    test::add_ball(clouds.back(), {0, 0, 2}, 0.1, 0.01, {static_cast<float>(i % 3), 0.5F, 1});
  }
  clouds.emplace_back();  // on the camera, on the near plane, behind
  for (const float z : {0.0F, 0.2F, 0.20001F, -0.2F, -3.0F}) {
    test::add_ball(clouds.back(), {0, 0, z}, 0.05, 0.9, {1, 1, 1});
  }
  clouds.push_back(test::random_cloud(15, 1000, 0, {0, 0, 4}, 3, 0.02F, 0.2F));
  for (const double scale : {1e3, 1e6, 1e12}) {
    test::add_ball(clouds.back(), {0.5F, -0.25F, 1}, scale, 0.2, {0.25F, 0.5F, 1});
  }
  clouds.push_back(test::random_cloud(16, 1000, 0, {0, 0, 0}, 3, 0.02F, 0.2F));  // camera inside
  clouds.push_back(test::random_cloud(14, 400, 0, {0, 0, 5}, 3, 0.3F, 0.5F));    // needles
  for (auto& scales : clouds.back().log_scales) {
    scales = {std::log(0.3F), std::log(0.3e-10F), std::log(0.3e-10F)};
  }
  clouds.push_back(test::random_cloud(17, 1000, 0, {0, 0, 5}, 3, 0.02F, 0.2F));  // outliers
  for (std::size_t i = 0; i < 300; ++i) clouds.back().means[i] *= i % 2 == 0 ? 1e18F : 1e37F;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    CAPTURE(i);
    const Ready ready = cloud_before_camera(clouds[i], 70, 50);
    const auto stored = test::by_chunks(ready.cloud, 16);
    CHECK(difference_from_reference(ready.view, stored.cloud, stored.table,
                                    with_group(square_of(32))) == "");
  }
}

TEST_CASE("exact order equals the reference: chunks that only the slack of their test keeps") {
  // Found by a search for the least margin between what rounding does to a Gaussian's place on the
  // screen and to the four sides of a group: one step of float is several px at these focal
  // lengths. Without the slack of chunk_tree.cpp each frame loses pixels.
  struct Case {
    int side_px;
    float focal_px;
    glm::vec3 axes[3];   // of the camera, in the world
    glm::vec3 near_one;  // seen, on a corner of the chunk's box
    glm::vec3 far_one;   // the corner opposite, out of sight
  };
  const std::vector<Case> cases = {
      {153,
       79908184.0F,
       {{-0.0055040484F, -0.42841977F, -0.9035631F},
        {0.9869963F, -0.14748801F, 0.0639184F},
        {-0.16064861F, -0.8914616F, 0.4236605F}},
       {-3.4898784F, -19.365927F, 9.203494F},
       {1.0101216F, 17.884073F, 9.203494F}},
      {246,
       7.75144e+07F,
       {{-0.041985568F, -0.8975949F, -0.43881717F},
        {-0.998973F, 0.030226495F, 0.033752784F},
        {-0.017032424F, 0.43978366F, -0.89794225F}},
       {-0.02276908F, 0.5879012F, -1.2003647F},
       {0.034552634F, 0.5879012F, 1.1787447F}},
      {257,
       1.569909e+08F,
       {{-0.428783F, -0.8978644F, -0.09992335F},
        {0.06923658F, -0.14294189F, 0.9873064F},
        {-0.90075046F, 0.41642183F, 0.12345611F}},
       {-2.5481422F, 1.1780188F, 0.349247F},
       {1.5834248F, 1.1780188F, 0.349247F}},
  };
  for (const Case& c : cases) {
    CAPTURE(c.side_px);
    Camera camera = test::forward_camera(c.side_px, c.side_px, static_cast<double>(c.focal_px));
    for (int k = 0; k < 3; ++k) camera.world_from_camera[k] = glm::dvec3(c.axes[k]);
    const View<float> view = make_view<float>(camera);
    GaussianCloud cloud;
    for (const glm::vec3& mean : {c.near_one, c.far_one}) {
      test::add_ball(cloud, mean, 1e-30, 0.5, {1, 1, 1});
      cloud.opacity_logits.back() = 100;  // the widest reach
    }
    const auto [points, tree] = test::by_chunks(activate(cloud), 2);
    REQUIRE(tree.chunk_count == 1);
    CHECK(difference_from_reference(view, points, tree, with_group(square_of(4))) == "");
    CHECK(render_exact_order(view, points, tree, with_group(square_of(4))).stats.contributors > 5);
  }
}

TEST_CASE("exact order equals the reference: built-in scenes, all views") {
  for (const std::string spec : {"builtin:object?n=20000", "builtin:outdoor?n=40000"}) {
    const BuiltinScene scene = make_builtin_scene(spec);
    const auto [cloud, tree] = test::by_chunks(activate(scene.cloud), 16);
    for (const Camera& camera : scene.cameras) {
      CAPTURE(spec, camera.id);
      CHECK(difference_from_reference(make_view<float>(camera), cloud, tree,
                                      with_group(square_of(128))) == "");
    }
  }
}

TEST_CASE("blend_early: a small buffer costs quality, one that suffices costs nothing") {
  const BuiltinScene scene = make_builtin_scene("builtin:outdoor?n=20000");
  const auto [cloud, tree] = test::by_chunks(activate(scene.cloud), 64);
  const View<float> view = make_view<float>(scene.cameras[0]);

  ExactOrderConfig config = with_group(square_of(64));
  const StreamingResult exact = render_exact_order(view, cloud, tree, config);

  config.on_overflow = OnOverflow::kBlendEarly;
  config.merge_entries = static_cast<std::uint32_t>(exact.stats.pending_keys_max);
  const StreamingResult enough = render_exact_order(view, cloud, tree, config);
  CHECK(enough.stats.forced_early == 0);
  CHECK(same_picture(enough, exact));

  double last_psnr = 0;
  for (const std::uint32_t entries : {2U, 16U, 64U}) {
    CAPTURE(entries);
    config.merge_entries = entries;
    const StreamingResult early = render_exact_order(view, cloud, tree, config);
    const double psnr = psnr_db(early.frame.image, exact.frame.image);
    CHECK(early.stats.forced_early > 0);
    CHECK(early.stats.misordered > 0);
    CHECK(std::isfinite(psnr));
    CHECK(psnr > last_psnr);  // each is four times larger or more
    last_psnr = psnr;
  }
  CHECK(last_psnr > 25);
}

TEST_CASE("exact order: counts add up, the same with one thread and with many") {
  const BuiltinScene scene = make_builtin_scene("builtin:object?n=10000");
  const auto [cloud, tree] = test::by_chunks(activate(scene.cloud), 16);
  const View<float> view = make_view<float>(scene.cameras[1]);

  const StreamingResult many = render_exact_order(view, cloud, tree, with_group(square_of(64)));
  const StreamingStats& s = many.stats;
  CHECK(s.groups == 60);
  CHECK(s.first_halves <= 16 * s.visits);
  CHECK(s.coarse_passed <= s.first_halves);
  CHECK(s.second_halves <= s.coarse_passed);
  CHECK(s.splats <= s.second_halves);
  CHECK(s.contributing <= cloud.size());
  CHECK(s.blocks_reached <= tree.chunk_count);
  CHECK(s.misordered == 0);
  std::uint64_t contributors = 0;
  for (const std::uint32_t count : many.frame.contributors) contributors += count;
  CHECK(s.contributors == contributors);

  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const StreamingResult alone = render_exact_order(view, cloud, tree, with_group(square_of(64)));
  CHECK(same_picture(many, alone));
  CHECK(alone.stats.visits == s.visits);
  CHECK(alone.stats.nodes_read == s.nodes_read);
  CHECK(alone.stats.contributing == s.contributing);
}

TEST_CASE("exact order equals the reference: truck") { test::check_exact_on_shared("truck"); }
TEST_CASE("exact order equals the reference: playbot") { test::check_exact_on_shared("playbot"); }
