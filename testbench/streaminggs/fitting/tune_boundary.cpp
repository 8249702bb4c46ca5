// streaminggs tune SCENE --boundary
#include <fmt/format.h>

#include <optional>
#include <utility>
#include <variant>

#include "algorithm/files/input_error.h"
#include "algorithm/scene/ply_writer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/train/comparison.h"
#include "algorithm/train/fitting.h"
#include "algorithm/train/scene_tuner.h"
#include "testbench/streaminggs/fitting/tune_command.h"

namespace sgs {
namespace {

constexpr int kBoundarySteps = 3'000;  // the paper's
constexpr double kBoundaryRate = 1;

BoundaryPenaltyConfig penalty_config(const TuneArguments& arguments) {
  BoundaryPenaltyConfig config;
  if (arguments.misordered_in == "pixel") config.in = MisorderedIn::kPixel;
  if (arguments.penalty_mean == "scene") config.mean = PenaltyMean::kScene;
  return config;
}

PaperOrderConfig paper_order_of(const TuneArguments& arguments, const RunConfig& config) {
  const std::optional<PaperOrderConfig> order = tuned_order(arguments, config);
  if (order) return *order;
  throw InputError(fmt::format(
      "--boundary: machine {} shows the reference picture, no boundary costs it anything, expected "
      "one of paper order",
      config.machine()));
}

}  // namespace

int tune_for_boundaries(const TuneArguments& arguments, const TuningJob& job) {
  TuningConfig config;
  arguments.set(config, kBoundarySteps, kBoundaryRate);
  const BoundaryPenaltyConfig penalty = penalty_config(arguments);
  const PaperOrderConfig order = paper_order_of(arguments, job.config);
  const StorageConfig& storage = job.config.storage;
  const std::string work = arguments.work();
  const std::optional<Checkpoint> from = arguments.resumed(work, job.contents);

  const CloudInStorage given = given_in_storage(arguments, job);
  VisitPlan plan(std::get<VoxelGrid>(given.table), order, arguments.visit_bytes());
  SceneTuner tuner = begun_tuner(
      arguments, job, config, paper_order(plan),
      arguments.beta > 0 ? boundary_loss(arguments.beta, order.precision, penalty) : Penalty(),
      given.cloud, from);
  print_target(job, given.cloud.size());
  arguments.pictures.write_photographs(job.views.test, order.background);
  const auto look = [&] {
    const CloudInStorage now = in_storage(tuner.cloud(), storage);
    const PaperQuality quality =
        paper_quality(activate(now.cloud), std::get<VoxelGrid>(now.table), order, penalty,
                      job.views.test, arguments.pictures.behind(tuner.next_step()));
    return Look{quality.paper,
                {quality.reference.psnr_db, quality.misordered_gaussians, quality.misordered_pixels,
                 quality.penalty}};
  };
  const FittingTask task{work,
                         arguments.pace(config),
                         job.contents,
                         tuner,
                         {{"reference_psnr_db", "reference"},
                          {"misordered_gaussians", "misordered"},
                          {"misordered_pixels", "in pixels"},
                          {"l_cbp", "L_CBP"}},
                         look,
                         [&] { write_ply(arguments.out, tuner.cloud()); }};
  const int status = run_fitting(arguments, task, from, !from);
  print_visits(plan);
  return status;
}

}  // namespace sgs
