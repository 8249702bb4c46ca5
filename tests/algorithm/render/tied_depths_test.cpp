// Ties of depth, and what another order of them does to the reference picture.
#include "algorithm/render/tied_depths.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>

#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/reorder.h"
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
    CHECK(reorders_ties(view, cloud, c.ranks) == c.reordered);
    // What it promises, and that the picture shows what it warns of.
    const Image as_it_is = render_reference(view, cloud).image;
    const Image other = render_reference(view, reordered(cloud, order_of(c.ranks))).image;
    CHECK((as_it_is.pixels == other.pixels) == !c.reordered);
  }
}
