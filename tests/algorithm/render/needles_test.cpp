// Needles of axis ratio 10^10 that cross the whole frame: where the power of section 3 cancels, a
// float pixel can be off by percents. Each pixel is held against the rounding of its own formula.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "testbench/oracle/double_oracle.h"
#include "tests/algorithm/render/decisions.h"
#include "tests/algorithm/render/test_clouds.h"
#include "tests/algorithm/render/tracked_projection.h"

using namespace sgs;
using test::Tracked;

namespace {

// power and alpha of section 3 with their rounding, dx and dy as blend() takes them.
Tracked tracked_alpha(const Projected<Tracked>& p, Tracked opacity, int x, int y) {
  const auto offset = [](Tracked centre, int pixel) {
    const int corner = pixel / kSubtilePx * kSubtilePx;
    return centre - Tracked(static_cast<float>(corner)) -
           Tracked(static_cast<float>(pixel - corner));
  };
  const Tracked dx = offset(p.x, x), dy = offset(p.y, y);
  const Tracked power =
      Tracked(-0.5F) * (p.conic_a * dx * dx + p.conic_c * dy * dy) - p.conic_b * dx * dy;
  return min_of(opacity * exp(power), constant<Tracked>(kAlphaMax));
}

}  // namespace

TEST_CASE("long needles of ratio 10^10: every pixel is within the rounding of its formula") {
  const Camera camera = test::forward_camera(160, 90, 200);
  const auto view = test::tracked_view(camera);
  const auto all = test::random_cloud(14, 300, 0, {0, 0, 5}, 3, 0.3F, 0.5F);
  int drawn = 0, flipped = 0;
  double widest = 0, worst_share = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    GaussianCloud cloud;
    cloud.resize(1, 0);
    cloud.means[0] = all.means[i];
    cloud.quats[0] = all.quats[i];
    cloud.opacity_logits[0] = all.opacity_logits[i];
    cloud.log_scales[0] = {std::log(30.0F), std::log(30e-10F), std::log(30e-10F)};
    const auto decisions = test::compare_decisions(camera, cloud);
    REQUIRE(decisions.unexplained == 0);
    if (decisions.in_front == 0 || decisions.rect_differs > 0) continue;

    const auto g = test::tracked_gaussian(cloud, 0);
    const auto p = project(view, g, to_camera(view, g.mean));
    const Tracked opacity =
        test::rounded(1 / (1 + std::exp(-static_cast<double>(cloud.opacity_logits[0]))));
    const RenderResult in_float = render_reference(make_view<float>(camera), activate(cloud));
    const OracleImage in_double = oracle_render(camera, cloud);
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const auto at = static_cast<std::size_t>(y) * camera.width + x;
        if (in_float.contributors[at] == 0 && in_double.contributors[at] == 0) continue;
        ++drawn;
        const Tracked alpha = tracked_alpha(p, opacity, x, y);
        if (in_float.contributors[at] != in_double.contributors[at]) {
          ++flipped;
          // Only at the thresholds: alpha of 1/255, or power above 0.
          const bool open = alpha.low() <= 1.0 / 255 || alpha.high() >= opacity.value;
          if (!open) FAIL("needle " << i << " at " << x << ", " << y << ": decided wrongly");
          continue;
        }
        const double error = std::abs(in_float.transmittance[at] - in_double.transmittance[at]);
        const double bound = alpha.error + 0x1p-24;  // of 1 - alpha
        widest = std::max(widest, error);
        worst_share = std::max(worst_share, error / bound);
        if (!(error <= bound)) {
          FAIL("needle " << i << " at " << x << ", " << y << ": off by " << error << ", bound "
                         << bound);
        }
      }
    }
  }
  fmt::print("long needles: {} pixels, {} flipped, largest error {:.2g}, error / bound {:.2f}\n",
             drawn, flipped, widest, worst_share);
  CHECK(drawn > 5000);
  CHECK(flipped < drawn / 100);
  CHECK(worst_share > 0.01);  // a bound far above the errors would prove nothing
}
