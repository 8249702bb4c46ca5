// Exact order gives the reference image bit for bit, whatever the groups, chunks, buffers and
// queues.
#include "algorithm/render/exact_renderer.h"

#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cstring>

#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
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

}  // namespace

TEST_CASE("exact order equals the reference: random hard scenes and configurations") {
  test::fuzz_exact_order(0, 500);
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

TEST_CASE("exact order equals the reference: truck") { test::check_exact_on_shared("truck"); }
TEST_CASE("exact order equals the reference: playbot") { test::check_exact_on_shared("playbot"); }
