// Quantisation-aware tuning: entries by hand, a small scene as a whole, and what is packed of it.
#include "algorithm/train/quantised_tuner.h"

#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "algorithm/splat/activate.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/storage/image_file.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/storage/stored_scene.h"
#include "algorithm/train/comparison.h"
#include "algorithm/train/photographs.h"
#include "algorithm/vq/image_weights.h"
#include "tests/algorithm/render/test_clouds.h"
#include "tests/algorithm/train/cameras_in_a_row.h"
#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

// The first step of Adam is as long as the rate, against the sign of the gradient.
TEST_CASE("entries: a step by the sum over those that use one, within what an entry may be") {
  QuantisedCloud quantised;
  quantised.codebooks[0] = {1, 0.5F, 0.25F, 1, 1, 1};
  quantised.codebooks[1] = {1, 0, 0, 0, 0, 1, 0, 0};
  quantised.codebooks[2] = {0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F};
  quantised.codebooks[3] = std::vector<float>(18, 0.5F);
  for (auto& indices : quantised.indices) indices = {0, 0, 1, 0};
  CodebookEntries entries(quantised, 1);
  CloudGradient gradient;
  gradient.resize(2, 1);  // of Gaussians 0 and 3: both use entry 0
  gradient.indices = {0, 3};
  gradient.parameters.log_scales = {{9, 3, 1}, {9, -1, -3}};
  gradient.parameters.quats = {{0, 0, 3, 0}, {0, 0, -1, 0}};
  const float dc[] = {3, -1, 1, -3};
  for (std::size_t r = 0; r < 2; ++r) {
    for (std::size_t k = 0; k < 4; ++k) {
      gradient.parameters.sh_coeffs[4 * r + k] = {dc[r], dc[2 + r], 0};
    }
  }
  const QuantisedCloud before = quantised;
  const LearningRates rates{0, 0.1, 0.1, 0, 0.1, 0.01};
  entries.step(gradient, rates, quantised);
  CHECK(quantised.codebooks[0][0] == 1);
  CHECK(quantised.codebooks[0][1] == Approx(0.5 * std::exp(-0.1)));
  CHECK(quantised.codebooks[0][2] == Approx(0.25 * std::exp(0.1)));
  const double length = std::sqrt(1.01);
  CHECK(quantised.codebooks[1][0] == Approx(1 / length));
  CHECK(quantised.codebooks[1][2] == Approx(-0.1 / length));
  CHECK(quantised.codebooks[2][0] == Approx(0.0).margin(1e-6));
  CHECK(quantised.codebooks[2][1] == Approx(0.3));
  CHECK(quantised.codebooks[2][2] == 0.3F);
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(quantised.codebooks[3][3 * k] == Approx(0.49));
    CHECK(quantised.codebooks[3][3 * k + 1] == Approx(0.51));
  }
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    const std::size_t half = before.codebooks[id].size() / 2;
    for (std::size_t w = half; w < 2 * half; ++w) {
      CHECK(quantised.codebooks[id][w] == before.codebooks[id][w]);
    }
  }
  // Ratios: at most 1, falling.
  gradient.parameters.log_scales = {{0, 1, -1}, {0, 1, -1}};
  for (int step = 0; step < 30; ++step) entries.step(gradient, rates, quantised);
  CHECK(quantised.codebooks[0][2] == quantised.codebooks[0][1]);
  gradient.parameters.log_scales = {{0, -1, -1}, {0, -1, -1}};
  for (int step = 0; step < 80; ++step) entries.step(gradient, rates, quantised);
  CHECK(quantised.codebooks[0][1] == 1);
}

// A scene with far fewer entries than Gaussians, in paper order or in the reference order.
struct Case {
  StorageConfig storage;
  PaperOrderConfig order;
  ActivatedCloud cloud;
  StoredTable table;
  QuantisedTuner::Weighing weighing;
  QuantisedCloud quantised;
  Photographs pictures;

  explicit Case(StorageOrder by, SecondHalfEncoding encoding = SecondHalfEncoding::kVq)
      : pictures(0, {}) {
    storage.order = by;
    storage.encoding = encoding;
    storage.voxel_size = 0.5;
    storage.vq.scale_entries = 16;
    storage.vq.rotation_entries = 32;
    storage.vq.dc_entries = 16;
    storage.vq.sh_entries = 8;
    order.group = square_of(32);
    order.precision = BlendPrecision::kHalf;
    const ActivatedCloud given = activate(random_cloud(2, 500, 1, {0, 0, 3}, 1, 0.05F, 0.3F));
    auto [made, slots] = scheme_of(by).arrange(given, storage);
    table = std::move(made);
    cloud = reordered(given, slots);
    pictures = own_pictures(cloud, cameras_in_a_row());
    pictures.load(1);
    weighing = {image_weights(cloud, cameras_in_a_row()), pixel_sizes(cloud, cameras_in_a_row())};
    quantised = quantise(cloud, weighing.weights, weighing.pixel_sizes, storage.vq);
  }
  std::optional<VisitPlan> plan() const {
    if (storage.order != StorageOrder::kVoxels) return {};
    return std::optional<VisitPlan>(std::in_place, std::get<VoxelGrid>(table), order, 1U << 20U);
  }
  QuantisedTuningConfig config(int steps) const {
    QuantisedTuningConfig out;
    out.steps = steps;
    out.rate = 3;
    out.reassign_every = 20;
    out.encoding = storage.encoding;
    return out;
  }
  double psnr_db(const StoredScene& stored) const {
    if (storage.order == StorageOrder::kVoxels) {
      return paper_quality(stored.decoded, stored.grid(), order, {}, pictures).paper.psnr_db;
    }
    return mean_quality(qualities(stored.decoded, pictures, glm::vec3(0))).psnr_db;
  }
};

DrawingOrder order_of(std::optional<VisitPlan>& plan) {
  return plan ? paper_order(*plan) : reference_order();
}

bool same(const ActivatedCloud& a, const ActivatedCloud& b) {
  return a.size() == b.size() && a.sh_coeffs == b.sh_coeffs &&
         std::memcmp(a.gaussians.data(), b.gaussians.data(), a.size() * sizeof a.gaussians[0]) == 0;
}

TEST_CASE("quantised tuning: what is packed comes nearer, and is what a reader decodes") {
  const ScratchFolder scratch;
  for (const StorageOrder by : {StorageOrder::kVoxels, StorageOrder::kChunks}) {
    for (const auto encoding : {SecondHalfEncoding::kVq, SecondHalfEncoding::kVqPacked}) {
      const Case scene(by, encoding);
      auto plan = scene.plan();
      QuantisedTuner tuner(scene.config(100), scene.pictures, order_of(plan), scene.weighing,
                           scene.cloud, scene.quantised);
      // Before the first step it is what is packed without tuning, but for roundings of logarithms.
      const double before = scene.psnr_db(tuner.stored(scene.storage));
      CHECK(before ==
            Approx(scene.psnr_db(store_quantised(scene.cloud, scene.quantised, scene.storage)))
                .margin(0.01));
      while (!tuner.done()) tuner.step();
      const StoredScene stored = tuner.stored(scene.storage);
      const double reported = scene.psnr_db(stored);
      CAPTURE(static_cast<int>(by), static_cast<int>(encoding), before, reported);
      CHECK(reported > before + 1.5);
      CHECK(tuner.reassigned() > 0);
      CHECK(tuner.reassigned() < 1);
      for (std::size_t slot = 0; slot < stored.decoded.size(); ++slot) {
        const std::size_t given = (*stored.file_indices)[slot];
        REQUIRE(stored.decoded.gaussians[slot].mean == scene.cloud.gaussians[given].mean);
      }

      const std::string path = scratch.path("t.sgs");
      write_image_file(path, {"t", stored.gaussians, 0}, stored.storage, stored.image);
      const StoredScene read = restore_scene(read_image_file(path), path);
      CHECK(same(read.decoded, stored.decoded));
      CHECK(scene.psnr_db(read) == reported);
    }
  }
}

TEST_CASE("quantised tuning: saved and resumed, on 1 and 3 threads, the same bits") {
  for (const StorageOrder by : {StorageOrder::kVoxels, StorageOrder::kChunks}) {
    const Case scene(by);
    auto plan = scene.plan();
    QuantisedTuner whole(scene.config(100), scene.pictures, order_of(plan), scene.weighing,
                         scene.cloud, scene.quantised);
    for (int i = 0; i < 30; ++i) whole.step();
    const std::string saved = whole.saved();
    for (int i = 0; i < 30; ++i) whole.step();
    for (const std::size_t threads : {1, 3}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      QuantisedTuner resumed(scene.config(100), scene.pictures, order_of(plan), scene.weighing,
                             QuantisedTuner::restored(saved));
      REQUIRE(resumed.next_step() == 30);
      for (int i = 0; i < 30; ++i) resumed.step();
      CHECK(resumed.saved() == whole.saved());
      CHECK(same(resumed.stored(scene.storage).decoded, whole.stored(scene.storage).decoded));
    }
  }
}

TEST_CASE("quantised tuning: what is no number stops it, and the step has changed nothing") {
  const Case scene(StorageOrder::kChunks);
  QuantisedCloud quantised = scene.quantised;
  for (float& word : quantised.codebooks[2]) word = 1e38F;
  QuantisedTuner tuner(scene.config(10), scene.pictures, reference_order(), scene.weighing,
                       scene.cloud, quantised);
  const std::string before = tuner.saved();
  CHECK_THROWS_WITH(tuner.step(), Catch::StartsWith("step 1: a derivative of Gaussian "));
  CHECK(tuner.saved() == before);
}

}  // namespace
}  // namespace sgs::test
