// Gradients of whole frames in float: against the double ones of the pixel loop, finite on
// extremes.
#include "algorithm/tune/scene_gradient.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/render/reference_renderer.h"
#include "tests/algorithm/tune/float_scenes.h"
#include "tests/algorithm/tune/hard_gaussians.h"
#include "tests/support/same_bytes.h"

namespace sgs::test {
namespace {

CloudGradient gradient_in_float(const Camera& camera, const GaussianCloud& parameters,
                                const PixelGradient& by_pixel, const glm::vec3& background,
                                GradientRule rule = GradientRule::kDerivative) {
  const auto view = make_view<float>(camera);
  const ActivatedCloud cloud = activate(parameters);
  const GroupSequences sequences = reference_sequences(view, cloud);
  const RenderResult picture = draw(sequences, background);
  CloudGradient out;
  scene_gradient({view, parameters, cloud, sequences, picture, background}, by_pixel, rule, out);
  return out;
}

LinearLoss random_loss(const Camera& camera, unsigned seed) {
  return HardGaussians(seed, 0).loss(camera);
}

TEST_CASE("the drawn picture is the reference renderer's, bit for bit") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Camera camera = forward_camera(75, 46, 60);
    const auto view = make_view<float>(camera);
    const ActivatedCloud cloud = activate(random_cloud(seed, 700, 2, {0, 0, 3}, 1, 0.01F, 0.4F));
    const glm::vec3 background{0.25F, 0.5F, 1};
    const RenderResult ours = draw(reference_sequences(view, cloud), background);
    const RenderResult reference = render_reference(view, cloud, background);
    REQUIRE(same_bytes(ours.image.pixels, reference.image.pixels));
    REQUIRE(same_bytes(ours.transmittance, reference.transmittance));
    REQUIRE(same_bytes(ours.contributors, reference.contributors));
  }
}

// Of each kind of parameter, in the mean square over a scene: where float and double decide another
// way whether a splat is blended into a pixel, single values have nothing in common.
TEST_CASE("gradients in float are those in double to four digits") {
  const auto check = [](const Camera& camera, const SceneOf<float>& scene, const LinearLoss& loss,
                        const std::string& name) {
    const auto in_double = [&](auto rule) {
      return gradient_of<rule.value>(make_view<double>(camera), converted<double>(scene), loss,
                                     by_depth);
    };
    const auto compare = [&](GradientRule rule, const SceneOf<double>& exact) {
      const CloudGradient gradient = gradient_in_float(
          camera, cloud_of(scene), in_float(loss, camera), glm::vec3(loss.background), rule);
      const Deviation found = deviation(dense(gradient, scene.raw.size()), exact);
      for (int p = 0; p < 12; ++p) {
        INFO(name << ", parameter " << p);
        CHECK(found.relative(p) <= 1e-4);
      }
    };
    compare(GradientRule::kDerivative,
            in_double(std::integral_constant<GradientRule, GradientRule::kDerivative>{}));
    compare(GradientRule::kOriginal,
            in_double(std::integral_constant<GradientRule, GradientRule::kOriginal>{}));
  };
  for (const HardScene& hard : hard_scenes()) {
    if (hard.name.rfind("hardly visible", 0) == 0) continue;  // as many decisions as pixels
    if (hard.scene.sh_degree == 0) continue;
    check(small_camera(), converted<float>(hard.scene), hard.loss, hard.name);
  }
  const Camera camera = forward_camera(75, 46, 60);
  check(camera, scene_of(random_cloud(5, 300, 3, {0, 0, 3}, 1, 0.02F, 0.5F)),
        random_loss(camera, 6), "many");
}

TEST_CASE("gradients are finite on needles, giants and at both ends of opacity") {
  const Camera camera = forward_camera(90, 60, 70);
  const PixelGradient by_pixel = in_float(random_loss(camera, 9), camera);
  GaussianCloud cloud = random_cloud(10, 1200, 3, {0, 0, 3}, 1, 0.01F, 0.5F);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    glm::vec3& scale = cloud.log_scales[i];
    if (i % 3 == 0) scale = {scale.x, scale.x - 13.9F, scale.x - 13.9F};
    if (i % 11 == 0) scale.y = -100;
    if (i % 5 == 0) cloud.opacity_logits[i] = i % 2 == 0 ? 200.0F : 20.0F;
    if (i % 5 == 1) cloud.opacity_logits[i] = i % 2 == 0 ? -200.0F : -5.5F;
    if (i % 97 == 0) {
      scale += 9.0F;
      cloud.opacity_logits[i] = -4;  // not to hide the others
    }
    if (i % 13 == 0) {
      cloud.means[i] *= 0.2001F / std::abs(cloud.means[i].z);
      scale -= 3.0F;
    }
    if (i % 89 == 0) {  // at the limits of what is drawn
      cloud.means[i] *= 1e17F;
      scale = glm::vec3(16);
      cloud.opacity_logits[i] = -4;
    }
    const float length = i % 4 == 0 ? 1e-18F : i % 4 == 1 ? 1e18F : 1.0F;
    for (float& component : cloud.quats[i]) component *= length;
  }
  for (const GradientRule rule : {GradientRule::kDerivative, GradientRule::kOriginal}) {
    const CloudGradient gradient =
        gradient_in_float(camera, cloud, by_pixel, glm::vec3(0.5F), rule);
    REQUIRE(gradient.size() > 300);
    SceneOf<float> by = dense(gradient, cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      for_parameters(
          i,
          [&](float p) {
            INFO("Gaussian " << i);
            REQUIRE(std::isfinite(p));
          },
          by);
    }
  }
}

TEST_CASE("a frame with nothing in it has no gradients") {
  const Camera camera = forward_camera(20, 12, 15);
  GaussianCloud cloud = random_cloud(11, 20, 1, {0, 0, -30}, 1, 0.01F, 0.5F);
  const PixelGradient by_pixel = in_float(random_loss(camera, 12), camera);
  CHECK(gradient_in_float(camera, cloud, by_pixel, glm::vec3(1)).size() == 0);
  cloud.resize(0, 3);
  CHECK(gradient_in_float(camera, cloud, by_pixel, glm::vec3(1)).size() == 0);
}

}  // namespace
}  // namespace sgs::test
