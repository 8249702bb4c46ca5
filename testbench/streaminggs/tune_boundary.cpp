// streaminggs tune SCENE --boundary
#include <fmt/format.h>

#include <utility>

#include "algorithm/input_error.h"
#include "algorithm/scene/ply_writer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/reorder.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/train/boundary_tuner.h"
#include "algorithm/train/paper_quality.h"
#include "testbench/streaminggs/numbers.h"
#include "testbench/streaminggs/tune_command.h"

namespace sgs {
namespace {

constexpr std::uint32_t kPaperSteps = 3'000;
constexpr std::size_t kMegabyte = 1'000'000;

BoundaryTuningConfig tuning_config(const TuneArguments& arguments, std::uint32_t steps) {
  BoundaryTuningConfig config;
  config.steps = static_cast<int>(steps);
  config.seed = arguments.seed;
  config.rate = arguments.rate;
  config.beta = arguments.beta;
  if (arguments.misordered_in == "pixel") config.penalty.in = MisorderedIn::kPixel;
  if (arguments.penalty_mean == "scene") config.penalty.mean = PenaltyMean::kScene;
  return config;
}

PaperOrderConfig paper_order_of(const RunConfig& config) {
  const std::optional<PaperOrderConfig> order = config.design->paper_order();
  if (!order) {
    throw InputError(fmt::format(
        "--boundary: machine {} shows the reference picture, no boundary costs it anything, "
        "expected one of paper order",
        config.machine()));
  }
  if (order->parts > 1 && order->precision == BlendPrecision::kHalf) {
    throw InputError(
        "--boundary: fetch shared with rendering.precision fp16 filters each part of a group by "
        "itself, expected fetch split, or fp32");
  }
  return *order;
}

// A cloud as voxels store it.
struct InVoxels {
  VoxelGrid grid;
  GaussianCloud cloud;
};

InVoxels in_voxels(const GaussianCloud& cloud, const StorageConfig& storage) {
  auto [grid, order] = arrange_by_voxels(activate(cloud), static_cast<float>(storage.voxel_size),
                                         stored_of(storage));
  return {std::move(grid), reordered(cloud, order)};
}

BoundaryTuner begun(const TuneArguments& arguments, const BoundaryTuningConfig& config,
                    const Photographs& photographs, VisitPlan& plan, const GaussianCloud& given,
                    const std::optional<Checkpoint>& from) {
  if (!from) return {config, photographs, plan, given};
  BoundaryTuner::State state = BoundaryTuner::restored(from->state);
  if (state.cloud.means != given.means) {
    throw InputError(fmt::format("{}: is of another scene than {}, its centres are others",
                                 arguments.resume, arguments.scene));
  }
  return {config, photographs, plan, std::move(state)};
}

}  // namespace

int tune_for_boundaries(const TuneArguments& arguments, const TuningJob& job) {
  const std::uint32_t steps = arguments.steps > 0 ? arguments.steps : kPaperSteps;
  const BoundaryTuningConfig config = tuning_config(arguments, steps);
  const PaperOrderConfig order = paper_order_of(job.config);
  const StorageConfig& storage = job.config.storage;
  const std::string work = arguments.work(steps);
  const std::optional<Checkpoint> from = arguments.resumed("tune", work);

  const InVoxels given = in_voxels(job.scene.cloud, storage);
  if (given.cloud.size() == 0) {
    throw InputError(arguments.scene + ": holds no Gaussian that a view could show");
  }
  VisitPlan plan(given.grid, order, arguments.visit_memory_mb * kMegabyte);
  BoundaryTuner tuner = begun(arguments, config, job.views.tune, plan, given.cloud, from);
  fmt::print("{:<26}{}\n{:<26}{} in voxels of {:.4g}, {} left out that no view can show\n",
             "target", job.views.says, "Gaussians", grouped(given.cloud.size()), storage.voxel_size,
             grouped(job.scene.cloud.size() - given.cloud.size()));
  const auto look = [&] {
    const InVoxels now = in_voxels(tuner.cloud(), storage);
    const PaperQuality quality =
        paper_quality(activate(now.cloud), now.grid, order, config.penalty, job.views.test);
    return Look{quality.paper,
                {quality.reference.psnr_db, quality.misordered_gaussians, quality.misordered_pixels,
                 quality.penalty}};
  };
  const FittingTask task{"tune",
                         work,
                         tuner,
                         {{"reference_psnr_db", "reference"},
                          {"misordered_gaussians", "misordered"},
                          {"misordered_pixels", "in pixels"},
                          {"l_cbp", "L_CBP"}},
                         look,
                         [&] { write_ply(arguments.out, tuner.cloud()); }};
  const int status = run_fitting(arguments, task, from ? from->log : "", !from);
  fmt::print("{:<26}{:.1f} MB kept\n", "visits",
             static_cast<double>(plan.kept_bytes()) / kMegabyte);
  return status;
}

}  // namespace sgs
