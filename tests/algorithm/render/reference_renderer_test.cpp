// The reference renderer: equal to its definition bit for bit, whatever the threads.
#include "algorithm/render/reference_renderer.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>

#include "algorithm/splat/activate.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/make_splat.h"
#include "testbench/builtin/builtin_scene.h"
#include "tests/algorithm/render/against_double.h"
#include "tests/algorithm/render/test_clouds.h"
#include "tests/support/same_bytes.h"

using namespace sgs;
using sgs::test::same_bytes;

namespace {

bool same_bits(const RenderResult& a, const RenderResult& b) {
  return same_bytes(a.image.pixels, b.image.pixels) &&
         same_bytes(a.transmittance, b.transmittance) && same_bytes(a.contributors, b.contributors);
}

// The definition: for each sub-tile all splats whose footprint holds it, by (depth, index).
RenderResult render_by_definition(const View<float>& view, const ActivatedCloud& cloud,
                                  const glm::vec3& background) {
  std::vector<Splat> splats;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Splat splat{};
    if (!make_geometry(view, cloud.gaussians[i], splat)) continue;
    add_colour(view, cloud.sh_degree, cloud.gaussians[i].mean, cloud.sh(i), splat);
    splat.index = static_cast<std::uint32_t>(i);
    splats.push_back(splat);
  }
  std::sort(splats.begin(), splats.end(), in_front);
  RenderResult out(view.width, view.height);
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const int sub_x = x / kSubtilePx, sub_y = y / kSubtilePx;
      SubtileState state = make_subtile(sub_x, sub_y, view.width, view.height);
      for (const Splat& s : splats) {
        const bool holds = s.footprint.x0 <= sub_x && sub_x < s.footprint.x1 &&
                           s.footprint.y0 <= sub_y && sub_y < s.footprint.y1;
        if (holds) blend(state, sub_x, sub_y, s);
      }
      const int lane = y % kSubtilePx * kSubtilePx + x % kSubtilePx;
      const auto at = static_cast<std::size_t>(y) * view.width + x;
      const float t = state.transmittance[lane];
      out.image.pixels[at] =
          glm::vec3(state.red[lane], state.green[lane], state.blue[lane]) + t * background;
      out.transmittance[at] = t;
      out.contributors[at] = static_cast<std::uint32_t>(state.contributors[lane]);
    }
  }
  return out;
}

}  // namespace

TEST_CASE("reference renderer equals its definition bit for bit, at any frame size") {
  for (const int degree : {0, 3}) {
    const ActivatedCloud cloud =
        activate(test::random_cloud(3, 1500, degree, {0, 0, 3}, 4, 0.01F, 0.6F));
    for (const auto& [width, height] : {std::pair{1, 1}, {3, 50}, {64, 48}, {83, 37}, {130, 65}}) {
      const auto view =
          make_view<float>(test::forward_camera(width, height, 0.7 * (width + height)));
      const glm::vec3 background(0.1F, 0.7F, 0.3F);
      const RenderResult fast = render_reference(view, cloud, background);
      CAPTURE(degree, width, height);
      CHECK(same_bits(fast, render_by_definition(view, cloud, background)));
      CHECK(*std::max_element(fast.contributors.begin(), fast.contributors.end()) > 10);
    }
  }
}

TEST_CASE("reference renderer gives the same bits with any number of threads") {
  const BuiltinScene scene = make_builtin_scene("builtin:outdoor?n=60000");
  const ActivatedCloud cloud = activate(scene.cloud);
  const auto view = make_view<float>(scene.cameras.at(0));
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return render_reference(view, cloud);
  };
  const RenderResult one = with_threads(1);
  for (const std::size_t threads : {2, 3, 8}) {
    CAPTURE(threads);
    CHECK(same_bits(one, with_threads(threads)));
  }
}

TEST_CASE("reference renderer on small built-in scenes: float against double") {
  for (const std::string name : {"object", "outdoor"}) {
    const BuiltinScene scene = make_builtin_scene("builtin:" + name + "?n=20000");

    test::check_against_double(name, scene.cameras.at(0), scene.cloud);
  }
}
