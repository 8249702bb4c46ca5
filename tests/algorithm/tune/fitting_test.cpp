// All of a step together: a scene moved off its picture finds back, in either order.
#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "algorithm/image/quality.h"
#include "algorithm/render/paper_renderer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/tune/adam.h"
#include "algorithm/tune/group_sequences.h"
#include "algorithm/tune/photometric_loss.h"
#include "algorithm/tune/scene_gradient.h"
#include "tests/algorithm/render/test_clouds.h"

namespace sgs::test {
namespace {

GaussianCloud moved_off(GaussianCloud cloud, bool with_means) {
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      if (with_means) cloud.means[i][k] += 0.01F * normal(random);
      cloud.log_scales[i][k] += 0.2F * normal(random);
    }
    cloud.opacity_logits[i] += normal(random);
    for (float& component : cloud.quats[i]) component *= 1 + 0.2F * normal(random);
  }
  for (auto& coeff : cloud.sh_coeffs) {
    coeff += 0.3F * glm::vec3(normal(random), normal(random), normal(random));
  }
  return cloud;
}

// Makes the sequences of a step.
using Order = std::function<GroupSequences(const View<float>&, const ActivatedCloud&)>;

struct Fit {
  GaussianCloud cloud;
  std::vector<double> losses;
};

Fit fit(GaussianCloud cloud, const View<float>& view, const Image& target, const Order& order,
        LearningRates rates, int steps) {
  Fit out;
  Adam adam(cloud);
  ActivatedCloud activated = activate(cloud);
  CloudGradient gradient;
  for (int step = 0; step < steps; ++step) {
    const GroupSequences sequences = order(view, activated);
    const RenderResult picture = draw(sequences);
    ImageLoss loss = photometric_loss(picture.image, target);
    out.losses.push_back(loss.loss);
    scene_gradient({view, cloud, activated, sequences, picture}, {std::move(loss.gradient), {}},
                   GradientRule::kDerivative, gradient);
    adam.step(gradient, rates, cloud);
    reactivate(cloud, gradient.indices, activated);
  }
  out.cloud = std::move(cloud);
  return out;
}

const LearningRates kFittingRates{2e-4, 1e-2, 5e-3, 5e-2, 1e-2, 2e-3};

TEST_CASE("a scene moved off its picture finds back by gradients of the reference order") {
  const Camera camera = forward_camera(100, 64, 80);
  const auto view = make_view<float>(camera);
  const GaussianCloud scene = random_cloud(1, 600, 1, {0, 0, 3}, 1, 0.02F, 0.3F);
  const Image target = draw(reference_sequences(view, activate(scene))).image;
  const Fit fitted =
      fit(moved_off(scene, true), view, target, reference_sequences, kFittingRates, 120);
  CHECK(fitted.losses.back() < 0.2 * fitted.losses.front());
}

// The target is the reference picture: what tuning for a streaming order asks for.
TEST_CASE("paper order comes nearer to the reference picture, the centres left where they are") {
  const Camera camera = forward_camera(100, 64, 80);
  const auto view = make_view<float>(camera);
  const GaussianCloud given = random_cloud(2, 600, 1, {0, 0, 3}, 1, 0.05F, 0.4F);
  const auto arranged = arrange_by_voxels(activate(given), 0.5F);
  const GaussianCloud scene = reordered(given, arranged.storage_order);
  const ActivatedCloud cloud = activate(scene);
  const Image target = draw(reference_sequences(view, cloud)).image;
  PaperOrderConfig config;
  config.group = square_of(32);
  const StreamingResult before = render_paper_order(view, cloud, arranged.table, config);
  const Order visited = [&](const View<float>& v, const ActivatedCloud& c) {
    return visited_sequences(v, c, arranged.table, before.group_voxels, config.group);
  };
  LearningRates rates = kFittingRates;
  rates.mean = 0;
  const Fit fitted = fit(scene, view, target, visited, rates, 120);
  REQUIRE(fitted.cloud.means == scene.means);
  const StreamingResult after =
      render_paper_order(view, activate(fitted.cloud), arranged.table, config);
  const double psnr_before = psnr_db(before.frame.image, target);
  const double psnr_after = psnr_db(after.frame.image, target);
  CAPTURE(psnr_before, psnr_after);
  CHECK(psnr_after > psnr_before + 3);
}

}  // namespace
}  // namespace sgs::test
