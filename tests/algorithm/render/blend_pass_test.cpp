// The blend pass: what an observer is shown is what the reference image is made of.
#include "algorithm/render/blend_pass.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "tests/algorithm/render/test_clouds.h"

using namespace sgs;

namespace {

// A pixel put together from what the observer was shown.
struct Shown {
  glm::vec3 colour{0.0F};
  float transmittance = 1;
  std::uint32_t contributors = 0;
  float depth = 0;  // of the last splat, and its index
  std::uint32_t index = 0;
};

// Blends the frame anew from alpha and earlier T alone; `failure` names the first thing amiss.
std::vector<Shown> blend_again(const View<float>& view, const ActivatedCloud& cloud,
                               std::string& failure) {
  std::vector<Shown> frame(static_cast<std::size_t>(view.width) * view.height);
  blend_scene(view, cloud, [&](GroupState& tile, const Splat& splat) {
    tile.blend(splat, each_pixel([&](const PixelBlend& seen) {
                 if (seen.x < 0 || seen.x >= view.width || seen.y < 0 || seen.y >= view.height) {
                   failure = "outside the frame";
                   return;
                 }
                 Shown& pixel = frame[static_cast<std::size_t>(seen.y) * view.width + seen.x];
                 const bool behind = splat.depth > pixel.depth ||
                                     (splat.depth == pixel.depth && splat.index > pixel.index);
                 if (pixel.contributors > 0 && !behind) failure = "out of order";
                 if (seen.alpha < 1.0F / 255 || seen.alpha > 0.99F) failure = "alpha out of range";
                 if (seen.before != pixel.transmittance) failure = "T in front";
                 if (seen.after != seen.before - seen.alpha * seen.before) failure = "T behind";
                 pixel.colour += splat.rgb * (seen.alpha * seen.before);
                 pixel.transmittance = seen.after;
                 ++pixel.contributors;
                 pixel.depth = splat.depth;
                 pixel.index = splat.index;
               }));
  });
  return frame;
}

}  // namespace

TEST_CASE("blend pass: what observers see makes the reference image, to the bit") {
  struct Case {
    int width, height;
    std::size_t gaussians;
    float opacity_shift;  // of the logit: how soon pixels finish
  };
  for (const Case& c : {Case{1, 1, 500, 0},
                        {3, 50, 1500, 0},
                        {83, 37, 1500, 0},
                        {64, 48, 4000, 4},
                        {50, 70, 40000, 0}}) {
    CAPTURE(c.width, c.height, c.gaussians);
    GaussianCloud raw = test::random_cloud(31, c.gaussians, 1, {0, 0, 3}, 4, 0.01F, 0.6F);
    for (float& logit : raw.opacity_logits) logit += c.opacity_shift;
    for (std::size_t i = 0; i < raw.size(); i += 3) raw.means[i].z = 2.5F;  // equal depths
    const ActivatedCloud cloud = activate(raw);
    const auto view =
        make_view<float>(test::forward_camera(c.width, c.height, 0.7 * (c.width + c.height)));
    std::string failure;
    const std::vector<Shown> again = blend_again(view, cloud, failure);
    CHECK(failure.empty());
    const RenderResult reference = render_reference(view, cloud);
    REQUIRE(again.size() == reference.image.pixels.size());
    std::size_t different = 0;
    for (std::size_t at = 0; at < again.size(); ++at) {
      different += again[at].colour != reference.image.pixels[at] ||
                   again[at].transmittance != reference.transmittance[at] ||
                   again[at].contributors != reference.contributors[at];
    }
    CHECK(different == 0);
    CHECK(*std::max_element(reference.contributors.begin(), reference.contributors.end()) > 3);
  }
}
