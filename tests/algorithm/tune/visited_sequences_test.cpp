// Paper order, drawn and differentiated.
#include <tbb/global_control.h>

#include <catch2/catch.hpp>

#include "algorithm/render/paper_renderer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/tune/group_sequences.h"
#include "tests/algorithm/tune/float_scenes.h"
#include "tests/algorithm/tune/hard_gaussians.h"
#include "tests/support/same_bytes.h"

namespace sgs::test {
namespace {

// A cloud in storage order and what is visited of it.
struct Stored {
  GaussianCloud parameters;
  ActivatedCloud cloud;
  VoxelGrid grid;
  StreamingResult result;
  GroupSequences sequences;
};

Stored stored(const GaussianCloud& scene, const Camera& camera, float voxel_size,
              const PaperOrderConfig& config) {
  Stored out;
  const auto view = make_view<float>(camera);
  auto arranged = arrange_by_voxels(activate(scene), voxel_size);
  out.grid = std::move(arranged.table);
  out.parameters = reordered(scene, arranged.storage_order);
  out.cloud = activate(out.parameters);
  out.result = render_paper_order(view, out.cloud, out.grid, config);
  out.sequences = visited_sequences(view, out.cloud, out.grid, out.result.group_voxels,
                                    config.group, config.visit_gaussians);
  return out;
}

TEST_CASE("the drawn picture is that of paper order, bit for bit") {
  const Camera camera = forward_camera(150, 90, 110);
  const GaussianCloud scene = random_cloud(1, 3000, 2, {0, 0, 3}, 1, 0.01F, 0.3F);
  for (const float voxel_size : {0.1F, 0.5F, 3.0F}) {
    for (const PixelSize group : {PixelSize{16, 16}, {64, 64}, {40, 20}}) {
      for (const std::uint32_t visit_gaussians : {0U, 100U}) {
        for (const auto precision : {BlendPrecision::kSingle, BlendPrecision::kHalf}) {
          PaperOrderConfig config;
          config.group = group;
          config.visit_gaussians = visit_gaussians;
          config.precision = precision;
          config.background = {0.25F, 0.5F, 1};
          const Stored s = stored(scene, camera, voxel_size, config);
          const RenderResult ours = draw(s.sequences, config.background, precision);
          INFO("voxels of " << voxel_size << ", groups of " << group.width << " x " << group.height
                            << ", visits of " << visit_gaussians);
          CHECK(same_bytes(ours.image.pixels, s.result.frame.image.pixels));
          CHECK(same_bytes(ours.transmittance, s.result.frame.transmittance));
          CHECK(same_bytes(ours.contributors, s.result.frame.contributors));
          if (voxel_size < 1) CHECK(s.result.stats.misordered > 0);
        }
      }
    }
  }
}

TEST_CASE("gradients of paper order are those of its sequences, to four digits") {
  const Camera camera = forward_camera(75, 46, 60);
  const GaussianCloud scene = random_cloud(2, 300, 3, {0, 0, 3}, 1, 0.02F, 0.4F);
  PaperOrderConfig config;
  config.group = {32, 20};
  const LinearLoss loss = HardGaussians(3, 0).loss(camera);
  config.background = glm::vec3(loss.background);
  const Stored s = stored(scene, camera, 0.3F, config);
  REQUIRE(s.result.stats.misordered > 100);

  const GroupSequences& sequences = s.sequences;
  const auto as_visited = [&](const std::vector<float>&, int x, int y) {
    const int columns = (camera.width + config.group.width - 1) / config.group.width;
    const auto group = static_cast<std::size_t>(4 * y / config.group.height * columns +
                                                4 * x / config.group.width);
    std::vector<std::uint32_t> order;
    for (std::size_t i = sequences.first[group]; i != sequences.first[group + 1]; ++i) {
      order.push_back(sequences.splat_of(i).index);
    }
    return order;
  };
  const auto exact = gradient_of(make_view<double>(camera),
                                 converted<double>(scene_of(s.parameters)), loss, as_visited);
  std::vector<CloudGradient> gradients;
  for (const std::size_t threads : {1, 2, 3}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    gradients.emplace_back();
    scene_gradient({make_view<float>(camera), s.parameters, s.cloud, sequences, s.result.frame,
                    config.background},
                   in_float(loss, camera), GradientRule::kDerivative, gradients.back());
  }
  REQUIRE(gradients[0].size() > 100);
  const Deviation found = deviation(dense(gradients[0], s.cloud.size()), exact);
  for (int p = 0; p < 12; ++p) {
    INFO("parameter " << p);
    CHECK(found.relative(p) <= 1e-4);
  }
  for (const std::size_t other : {1, 2}) {
    CHECK(same_bytes(gradients[0].indices, gradients[other].indices));
    CHECK(same_bytes(gradients[0].parameters.means, gradients[other].parameters.means));
    CHECK(same_bytes(gradients[0].parameters.sh_coeffs, gradients[other].parameters.sh_coeffs));
  }
}

// Where rounding changes what is blended nothing is alike; elsewhere it is a half's last place.
TEST_CASE("pixels kept in half hand gradients on") {
  const Camera camera = forward_camera(75, 46, 60);
  const GaussianCloud scene = random_cloud(4, 300, 1, {0, 0, 3}, 1, 0.02F, 0.4F);
  PaperOrderConfig config;
  const Stored s = stored(scene, camera, 0.3F, config);
  std::vector<SceneOf<float>> gradients;
  for (const auto precision : {BlendPrecision::kSingle, BlendPrecision::kHalf}) {
    const RenderResult picture = draw(s.sequences, config.background, precision);
    CloudGradient gradient;
    scene_gradient({make_view<float>(camera), s.parameters, s.cloud, s.sequences, picture,
                    config.background, precision},
                   in_float(HardGaussians(5, 0).loss(camera), camera), GradientRule::kDerivative,
                   gradient);
    gradients.push_back(dense(gradient, s.cloud.size()));
  }
  const Deviation found = deviation(gradients[1], converted<double>(gradients[0]));
  for (int p = 0; p < 12; ++p) {
    INFO("parameter " << p << ": " << found.relative(p));
    CHECK(found.relative(p) <= 0.05);
    CHECK(found.relative(p) > 0);
  }
}

}  // namespace
}  // namespace sgs::test
