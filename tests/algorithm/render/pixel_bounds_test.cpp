// The bounds of pixels hold a usual scene closely, and do not hold a picture that is off.
#include "tests/algorithm/render/pixel_bounds.h"

#include <catch2/catch.hpp>

#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "tests/algorithm/render/test_clouds.h"

using namespace sgs;

TEST_CASE("pixel bounds: float and double lie within, a picture that is off does not") {
  const Camera camera = test::forward_camera(64, 48, 50);
  const GaussianCloud cloud = test::random_cloud(21, 400, 3, {0, 0, 4}, 3, 0.03F, 0.5F);
  const RenderResult in_float = render_reference(make_view<float>(camera), activate(cloud));
  const test::PixelBounds bounds = test::bound_pixels(camera, cloud, in_float);
  INFO(bounds.first_outside);
  CHECK(bounds.outside == 0);
  CHECK(bounds.pixels == 64 * 48);
  CHECK(100 * bounds.narrow >= 97 * bounds.pixels);

  struct Fault {
    const char* what;
    void (*plant)(const Camera&, const GaussianCloud&, RenderResult&);
  };
  for (const Fault& fault :
       {Fault{"one pixel a little brighter",
              [](const Camera&, const GaussianCloud&, RenderResult&picture) {
                picture.image.pixels[24 * 64 + 32].y += 1e-3F;
              }},
        {"light that is left, of a pixel",
         [](const Camera&, const GaussianCloud&, RenderResult&picture) {
           picture.transmittance[24 * 64 + 32] *= 1.01F;
         }},
        {"a camera a thousandth of a pixel aside",
         [](const Camera&at, const GaussianCloud&scene, RenderResult&picture) {
           Camera moved = at;
           moved.position.x += 1e-4;
           picture = render_reference(make_view<float>(moved), activate(scene));
         }},
        {"opacities a thousandth lower",
         [](const Camera&same, const GaussianCloud&scene, RenderResult&picture) {
           GaussianCloud fainter = scene;
           for (float& logit : fainter.opacity_logits) logit -= 1e-3F;
           picture = render_reference(make_view<float>(same), activate(fainter));
         }}}) {
    INFO(fault.what);
    RenderResult off = in_float;
    fault.plant(camera, cloud, off);
    CHECK(test::bound_pixels(camera, cloud, off).outside > 0);
  }
}
