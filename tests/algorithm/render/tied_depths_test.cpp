// Ties of depth, and what another order of them does to the reference picture.
#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/gaussian.h"
#include "tests/algorithm/render/test_clouds.h"

using namespace sgs;

namespace {

using Ranks = std::vector<std::uint32_t>;

// Balls along the axis of view, at these depths, each in a colour of its own.
ActivatedCloud row(const std::vector<float>& depths) {
  GaussianCloud cloud;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const auto shade = static_cast<float>(i + 1) / 8;
    test::add_ball(cloud, {0, 0, depths[i]}, 0.1, 0.5, {shade, 1 - shade, shade / 2});
  }
  return activate(cloud);
}

// The order in which a Gaussian's place is its rank.
Ranks order_of(const Ranks& ranks) {
  Ranks order(ranks.size());
  for (std::uint32_t i = 0; i < ranks.size(); ++i) order[ranks[i]] = i;
  return order;
}

}  // namespace

TEST_CASE("tied depths: only ties that may be seen and stand in another order count") {
  const View<float> view = make_view<float>(test::forward_camera(48, 48, 60));
  struct Case {
    const char* what;
    std::vector<float> depths;
    Ranks ranks;
    bool reordered;
  };
  for (const Case& c :
       std::vector<Case>{{"no ties, another order", {2, 3, 4, 5}, {3, 2, 1, 0}, false},
                         {"a tie in the same order", {2, 3, 3, 5}, {3, 1, 2, 0}, false},
                         {"a tie in another order", {2, 3, 3, 5}, {0, 2, 1, 3}, true},
                         {"a tie of many, two of them swapped", {3, 3, 3, 3}, {0, 1, 3, 2}, true},
                         {"a tie behind the camera", {2, -3, -3, 5}, {0, 2, 1, 3}, false},
                         {"none at all", {}, {}, false}}) {
    INFO(c.what);
    const ActivatedCloud cloud = row(c.depths);
    const std::vector<char> tiles = tiles_of_ties(view, cloud, c.ranks);
    CHECK((std::count(tiles.begin(), tiles.end(), 1) > 0) == c.reordered);
    // What it promises, and that the picture shows what it warns of.
    const glm::vec3 background(0.1F, 0.2F, 0.3F);
    const Image as_it_is = render_reference(view, cloud, background).image;
    const Image other =
        render_reference(view, reordered(cloud, order_of(c.ranks)), background).image;
    CHECK((as_it_is.pixels == other.pixels) == !c.reordered);
    CHECK(picture_by_ranks(view, cloud, c.ranks, background, tiles, as_it_is).pixels ==
          other.pixels);
  }
}

TEST_CASE("tied depths: of many ties all over a frame, only some tiles are drawn anew") {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    std::mt19937_64 random(seed);
    const auto uniform = [&](float low, float high) {
      return std::uniform_real_distribution<float>(low, high)(random);
    };
    GaussianCloud given;
    for (int i = 0; i < 1500; ++i) {
      const float depth = 2 + 0.01F * static_cast<float>(random() % 400);
      test::add_ball(given, {depth * uniform(-1, 1), depth * uniform(-1, 1), depth}, 0.02, 0.7,
                     {uniform(0, 1), uniform(0, 1), uniform(0, 1)});
    }
    const ActivatedCloud cloud = activate(given);
    Ranks ranks(cloud.size());
    std::iota(ranks.begin(), ranks.end(), 0U);
    std::shuffle(ranks.begin(), ranks.end(), random);
    const View<float> view = make_view<float>(test::forward_camera(200, 120, 100));
    const Image as_it_is = render_reference(view, cloud).image;
    const Image other = render_reference(view, reordered(cloud, order_of(ranks))).image;
    const std::vector<char> tiles = tiles_of_ties(view, cloud, ranks);
    const auto drawn = std::count(tiles.begin(), tiles.end(), 1);
    CHECK(drawn > 0);
    CHECK(drawn < static_cast<std::ptrdiff_t>(tiles.size()));
    CHECK(as_it_is.pixels != other.pixels);
    CHECK(picture_by_ranks(view, cloud, ranks, glm::vec3(0), tiles, as_it_is).pixels ==
          other.pixels);
  }
}
