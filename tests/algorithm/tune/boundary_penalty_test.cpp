// L_CBP by hand, its gradient against dual numbers, and the plan of visits.
#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cstring>

#include "algorithm/splat/activate.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/tune/additional_losses.h"
#include "algorithm/tune/group_sequences.h"
#include "algorithm/tune/scene_gradient.h"
#include "tests/algorithm/render/test_clouds.h"
#include "tests/algorithm/splat/dual.h"

namespace sgs::test {
namespace {

// 32 x 16 px in two groups; a, b and c lie behind each other in the left one, d alone beside them,
// e in the right one.
struct Row {
  const char* order;  // of blending, of both groups
  MisorderedIn in;
  PenaltyMean mean;
  const char* misordered;
  double count;
};

TEST_CASE("L_CBP: who is out of order, by what, over how many") {
  const Camera camera = forward_camera(32, 16, 16);
  GaussianCloud cloud;
  const glm::vec3 grey(0.5F);
  add_ball(cloud, {-0.6F, 0, 1}, 0.04, 0.5, grey);     // a
  add_ball(cloud, {-1.2F, 0, 2}, 0.08, 0.5, grey);     // b
  add_ball(cloud, {-1.8F, 0, 3}, 0.12, 0.5, grey);     // c
  add_ball(cloud, {-0.4F, 0.8F, 2}, 0.02, 0.5, grey);  // d
  add_ball(cloud, {1.2F, 0, 2.5F}, 0.07, 0.5, grey);   // e
  add_ball(cloud, {-1.2F, 0, 2}, 0.08, 0.001, grey);   // f, never seen
  cloud.log_scales[1].y += 0.5F;
  const double scales[] = {0.04, 0.08 * std::exp(0.5), 0.12, 0.02, 0.07, 0.08};
  const ActivatedCloud activated = activate(cloud);
  const auto group = MisorderedIn::kGroup;
  const auto pixel = MisorderedIn::kPixel;
  const auto rendered = PenaltyMean::kRendered;
  const auto scene = PenaltyMean::kScene;
  for (const Row& row : std::vector<Row>{{"abcde", group, rendered, "d", 5},
                                         {"abdce", group, rendered, "", 5},
                                         {"acbde", group, rendered, "bd", 5},
                                         {"acbde", pixel, rendered, "b", 5},
                                         {"acbde", pixel, scene, "b", 6},
                                         {"cabde", group, rendered, "abd", 5},
                                         {"cbade", pixel, rendered, "ab", 5},
                                         {"cfade", group, scene, "ad", 6},
                                         {"ecba", group, rendered, "ab", 4}}) {
    INFO(row.order);
    GroupSequences sequences = reference_sequences(make_view<float>(camera), activated);
    sequences.groups = {{0, 0, 16, 16}, {16, 0, 32, 16}};
    std::vector<std::uint32_t> entries[2];
    for (const char* name = row.order; *name != 0; ++name) {
      const auto index = static_cast<std::uint32_t>(*name - 'a');
      for (std::uint32_t at = 0; at < sequences.splats.size(); ++at) {
        if (sequences.splats[at].index == index) entries[index == 4].push_back(at);
      }
    }
    sequences.entries = entries[0];
    sequences.entries.insert(sequences.entries.end(), entries[1].begin(), entries[1].end());
    sequences.first = {0, entries[0].size(), sequences.entries.size()};

    const BoundaryPenalty penalty =
        boundary_penalty(sequences, activated, BlendPrecision::kSingle, {row.in, row.mean});
    double sum = 0;
    for (const char* name = row.misordered; *name != 0; ++name) sum += scales[*name - 'a'];
    CHECK(penalty.value == Approx(sum / row.count).epsilon(1e-6));
    CHECK(penalty.misordered == std::strlen(row.misordered));
    CHECK(penalty.count == row.count);
    for (std::size_t at = 0; at < sequences.splats.size(); ++at) {
      const char name = static_cast<char>('a' + sequences.splats[at].index);
      CHECK(penalty.groups[at] == (std::strchr(row.misordered, name) != nullptr ? 1U : 0U));
    }
  }
}

// A cloud in storage order, its grid and how it is shown.
struct PaperScene {
  GaussianCloud parameters;
  ActivatedCloud cloud;
  VoxelGrid grid;
  PaperOrderConfig order;
};

PaperScene paper_scene(const GaussianCloud& scene, float voxel_size) {
  auto [grid, storage_order] = arrange_by_voxels(activate(scene), voxel_size);
  PaperScene out{reordered(scene, storage_order), {}, std::move(grid), {}};
  out.cloud = activate(out.parameters);
  out.order.group = square_of(32);
  return out;
}

CloudGradient penalty_gradient(const PaperScene& scene, const View<float>& view,
                               const GroupSequences& sequences) {
  const RenderResult picture = draw(sequences);
  PixelGradient by_pixel{Image(view.width, view.height), {}};
  for (glm::vec3& pixel : by_pixel.colour.pixels) pixel = glm::vec3(1e-3F);
  CloudGradient out;
  scene_gradient({view, scene.parameters, scene.cloud, sequences, picture}, by_pixel,
                 GradientRule::kDerivative, out);
  return out;
}

// 1/N sum T_i S_i with the decisions as they are.
Dual penalty_of(const PaperScene& scene, const GroupSequences& sequences,
                const BoundaryPenalty& decided, std::size_t moved, int axis) {
  Dual sum(0.0);
  for (std::size_t at = 0; at < sequences.splats.size(); ++at) {
    const std::size_t i = sequences.splats[at].index;
    RawGaussian<Dual> raw{};
    raw.quat = {Dual(1.0), Dual(0.0), Dual(0.0), Dual(0.0)};
    for (int k = 0; k < 3; ++k) {
      raw.log_scale[k] = {scene.parameters.log_scales[i][k], i == moved && k == axis ? 1.0 : 0.0};
    }
    const auto scale = activate(raw).scale;
    sum += Dual(decided.groups[at]) * std::max({scale.x, scale.y, scale.z});
  }
  return sum / Dual(decided.count);
}

TEST_CASE("L_CBP: its gradient is that of dual numbers, and adds to what is there") {
  const Camera camera = forward_camera(75, 46, 60);
  const auto view = make_view<float>(camera);
  const PaperScene scene = paper_scene(random_cloud(2, 300, 0, {0, 0, 3}, 1, 0.02F, 0.4F), 0.3F);
  VisitPlan plan(scene.grid, scene.order, 0);
  const GroupSequences sequences = plan.sequences(0, view, scene.cloud);
  for (const auto in : {MisorderedIn::kGroup, MisorderedIn::kPixel}) {
    for (const auto mean : {PenaltyMean::kRendered, PenaltyMean::kScene}) {
      const BoundaryPenalty penalty =
          boundary_penalty(sequences, scene.cloud, BlendPrecision::kSingle, {in, mean});
      REQUIRE(penalty.misordered > 50);
      REQUIRE(penalty.misordered < penalty.rendered);
      const CloudGradient before = penalty_gradient(scene, view, sequences);
      CloudGradient with = before;
      const double beta = 0.5;
      add_boundary_gradient(penalty, beta, sequences, scene.cloud, with);
      CHECK(with.parameters.quats == before.parameters.quats);
      CHECK(with.parameters.means == before.parameters.means);
      std::size_t moved = 0;
      for (std::size_t r = 0; r < with.size(); ++r) {
        for (int axis = 0; axis < 3; ++axis) {
          const double slope =
              beta * penalty_of(scene, sequences, penalty, with.indices[r], axis).slope;
          const double ours = static_cast<double>(with.parameters.log_scales[r][axis]) -
                              before.parameters.log_scales[r][axis];
          const double rounding =
              3e-7 * (std::abs(before.parameters.log_scales[r][axis]) + std::abs(slope));
          REQUIRE(std::abs(ours - slope) <= rounding);
          moved += slope > 0 ? 1 : 0;
        }
      }
      CHECK(moved > 30);
    }
  }
}

TEST_CASE("plan of visits: within its memory, and whatever is kept, paper order's picture") {
  const PaperScene scene = paper_scene(random_cloud(4, 2000, 0, {0, 0, 3}, 1, 0.01F, 0.3F), 0.2F);
  std::vector<View<float>> views;
  for (const double focal : {60, 110, 200}) {
    views.push_back(make_view<float>(forward_camera(150, 90, focal)));
  }
  std::size_t all = 0;
  for (const std::size_t most : {std::size_t{1} << 30U, std::size_t{0}, std::size_t{1}}) {
    const std::size_t bound = most == 1 ? all - 1 : most;
    VisitPlan plan(scene.grid, scene.order, bound);
    for (int time = 0; time < 2; ++time) {
      for (std::size_t at = 0; at < views.size(); ++at) {
        const Image ours = draw(plan.sequences(at, views[at], scene.cloud)).image;
        const StreamingResult golden =
            render_paper_order(views[at], scene.cloud, scene.grid, scene.order);
        CHECK(ours.pixels == golden.frame.image.pixels);
      }
      CHECK(plan.kept_bytes() <= bound);
    }
    if (all == 0) all = plan.kept_bytes();
    if (most == 1) CHECK(plan.kept_bytes() > 0);
  }
  CHECK(all > 1000);
}

}  // namespace
}  // namespace sgs::test
