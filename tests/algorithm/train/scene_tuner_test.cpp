// Tunings of scenes as a whole, on a small one whose own pictures are the target.
#include "algorithm/train/scene_tuner.h"

#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/files/input_error.h"
#include "algorithm/render/blend_pass.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/train/comparison.h"
#include "algorithm/train/photographs.h"
#include "tests/algorithm/render/test_clouds.h"
#include "tests/algorithm/train/cameras_in_a_row.h"

namespace sgs::test {
namespace {

constexpr float kVoxel = 0.4F;

// A scene whose Gaussians span voxels, and its target.
struct BoundaryCase {
  GaussianCloud cloud;
  VoxelGrid grid;
  PaperOrderConfig order;
  Photographs pictures;

  BoundaryCase() : pictures(0, {}) {
    const GaussianCloud given = random_cloud(2, 500, 0, {0, 0, 3}, 1, 0.05F, 0.4F);
    auto [made, storage_order] = arrange_by_voxels(activate(given), kVoxel);
    grid = std::move(made);
    cloud = reordered(given, storage_order);
    order.group = square_of(32);
    order.precision = BlendPrecision::kHalf;
    pictures = own_pictures(activate(cloud), cameras_in_a_row());
    pictures.load(1);
  }
  PaperQuality quality(const GaussianCloud& of) const {
    auto [now, storage_order] = arrange_by_voxels(activate(of), kVoxel);
    return paper_quality(reordered(activate(of), storage_order), now, order,
                         {MisorderedIn::kPixel, PenaltyMean::kRendered}, pictures);
  }
};

TuningConfig short_tuning() {
  TuningConfig config;
  config.steps = 150;
  config.rate = 10;  // for as many steps more
  return config;
}

Penalty boundary(double beta, MisorderedIn in) {
  return boundary_loss(beta, BlendPrecision::kHalf, {in, PenaltyMean::kRendered});
}

GaussianCloud tuned(const BoundaryCase& scene, double beta) {
  VisitPlan plan(scene.grid, scene.order, 1U << 20U);
  SceneTuner tuner(short_tuning(), scene.pictures, paper_order(plan),
                   beta > 0 ? boundary(beta, MisorderedIn::kPixel) : Penalty(), scene.cloud);
  while (!tuner.done()) tuner.step();
  return tuner.cloud();
}

TEST_CASE("boundary tuning: paper order comes nearer, and less of it is out of order") {
  const BoundaryCase scene;
  const PaperQuality before = scene.quality(scene.cloud);
  CHECK(before.reference.psnr_db > 80);
  REQUIRE(before.misordered_pixels > 0.02);
  PaperQuality by_loss{};
  for (const double beta : {0.0, 0.5}) {
    const GaussianCloud cloud = tuned(scene, beta);
    CHECK(cloud.means == scene.cloud.means);
    const PaperQuality after = scene.quality(cloud);
    CAPTURE(beta, before.paper.psnr_db, after.paper.psnr_db, before.misordered_pixels,
            after.misordered_pixels, before.misordered_gaussians, after.misordered_gaussians);
    if (beta == 0) {
      by_loss = after;
      CHECK(after.paper.psnr_db > before.paper.psnr_db + 3);
    } else {
      CHECK(after.paper.psnr_db > before.paper.psnr_db);
      CHECK(after.misordered_pixels < 0.9 * by_loss.misordered_pixels);
      CHECK(after.penalty < 0.7 * before.penalty);
    }
  }
}

TEST_CASE("boundary tuning: saved and resumed, on 1 and 3 threads, the same bits") {
  const BoundaryCase scene;
  const TuningConfig config = short_tuning();
  const Penalty penalty = boundary(0.05, MisorderedIn::kGroup);
  VisitPlan plan(scene.grid, scene.order, 1U << 20U);
  SceneTuner whole(config, scene.pictures, paper_order(plan), penalty, scene.cloud);
  for (int i = 0; i < 10; ++i) whole.step();
  const std::string saved = whole.saved();
  for (int i = 0; i < 10; ++i) whole.step();
  for (const std::size_t threads : {1, 3}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    VisitPlan none(scene.grid, scene.order, 0);
    SceneTuner resumed(config, scene.pictures, paper_order(none), penalty,
                       SceneTuner::restored(saved));
    CHECK(resumed.next_step() == 10);
    for (int i = 0; i < 10; ++i) resumed.step();
    CHECK(resumed.saved() == whole.saved());
  }
}

// Groups that the boxes of all splats meet.
std::size_t fetches(const ActivatedCloud& cloud, const PixelSize& group) {
  std::size_t sum = 0;
  for (const Camera& camera : cameras_in_a_row()) {
    const auto view = make_view<float>(camera);
    const CellGrid grid = cell_grid(view.width, view.height, group);
    for (const Splat& splat : reference_sequences(view, cloud).splats) {
      sum += cells_of(grid, splat.footprint).size();
    }
  }
  return sum;
}

TEST_CASE("streaming tuning: fewer fetches the more they cost, for some quality") {
  const BoundaryCase scene;
  const PixelSize group = square_of(16);
  std::size_t before = fetches(activate(scene.cloud), group);
  for (const double weight : {0.005, 0.05}) {
    SceneTuner tuner(short_tuning(), scene.pictures, reference_order(),
                     streaming_loss(weight, group), scene.cloud);
    while (!tuner.done()) tuner.step();
    const std::size_t after = fetches(activate(tuner.cloud()), group);
    const double psnr =
        mean_quality(qualities(activate(tuner.cloud()), scene.pictures, glm::vec3(0))).psnr_db;
    CAPTURE(weight, before, after, psnr);
    CHECK(static_cast<double>(after) < 0.9 * static_cast<double>(before));
    CHECK(psnr > 25);
    CHECK(tuner.cloud().means == scene.cloud.means);
    before = after;
  }
}

TEST_CASE("tuning: rates fall to a tenth, centres rest") {
  TuningConfig config;
  config.steps = 101;
  config.rate = 2;
  CHECK(config.rates_at(0).log_scale == Approx(0.01));
  CHECK(config.rates_at(50).sh_dc == Approx(2 * 2.5e-3 * std::sqrt(0.1)));
  CHECK(config.rates_at(100).opacity_logit == Approx(0.01));
  for (const int step : {0, 50, 100}) CHECK(config.rates_at(step).mean == 0);
}

TEST_CASE("own pictures: the reference renderer's, and cameras between those given") {
  const ActivatedCloud cloud = activate(random_cloud(1, 200, 0, {0, 0, 3}, 1, 0.05F, 0.4F));
  const std::vector<Camera> given = cameras_in_a_row();
  Photographs pictures = own_pictures(cloud, given);
  pictures.load(1);
  CHECK_FALSE(pictures.transparent());
  const Image ours = pictures.before(1, glm::vec3(0));
  const Image golden = render_reference(make_view<float>(given[1]), cloud).image;
  for (std::size_t i = 0; i < golden.pixels.size(); ++i) {
    REQUIRE(std::abs(ours.pixels[i].y - std::min(golden.pixels[i].y, 1.0F)) < 1e-5F);
  }
  pictures.load(2);
  CHECK(pictures.camera(0).width == 48);

  const std::vector<Camera> between = cameras_between(given, 50, 7);
  REQUIRE(between.size() == 50);
  double least = 1, most = -1;
  for (const Camera& camera : between) {
    least = std::min(least, camera.position.x);
    most = std::max(most, camera.position.x);
    CHECK(camera.position.y == 0);
    CHECK(std::abs(camera.world_from_camera[2].z - 1) < 1e-12);
  }
  CHECK(least >= -0.3);
  CHECK(most <= 0.3);
  CHECK(most - least > 0.4);
  CHECK(cameras_between(given, 50, 7)[49].position == between[49].position);
  CHECK(cameras_between(given, 50, 8)[49].position != between[49].position);
  CHECK_THROWS_AS(cameras_between({given[0]}, 1, 1), InputError);
}

}  // namespace
}  // namespace sgs::test
