#include "testbench/streaminggs/fitting/tune_job.h"

#include <fmt/format.h>

#include <utility>

#include "algorithm/files/input_error.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/storage/storage_scheme.h"
#include "testbench/streaminggs/report/fact_line.h"
#include "testbench/streaminggs/report/numbers.h"

namespace sgs {

CloudInStorage in_storage(const GaussianCloud& cloud, const StorageConfig& storage) {
  auto [table, order] = scheme_of(storage.order).arrange(activate(cloud), storage);
  return {std::move(table), reordered(cloud, order)};
}

CloudInStorage given_in_storage(const TuneArguments& arguments, const TuningJob& job) {
  CloudInStorage given = in_storage(job.scene.cloud, job.config.storage);
  if (given.cloud.size() == 0) {
    throw InputError(arguments.scene + ": holds no Gaussian that a view could show");
  }
  return given;
}

std::optional<PaperOrderConfig> tuned_order(const TuneArguments& arguments,
                                            const RunConfig& config) {
  std::optional<PaperOrderConfig> order = config.design->paper_order();
  if (!order && !config.design->draws_reference()) {
    throw InputError(fmt::format(
        "--{}: machine {} as it is configured draws neither paper order nor the reference "
        "picture, expected rendering.precision fp32 and nothing that is given up",
        arguments.purpose(), config.machine()));
  }
  if (!order && arguments.visit_memory_mb != TuneArguments::kVisitMemoryMb) {
    throw InputError("--visit-memory: only paper order has visits");
  }
  if (order && order->parts > 1 && in_16_bits(order->precision)) {
    throw InputError(
        "fetch: shared with rendering.precision fp16 filters each part of a group by itself, "
        "expected split, or fp32");
  }
  return order;
}

SceneTuner begun_tuner(const TuneArguments& arguments, const TuningJob& job,
                       const TuningConfig& config, DrawingOrder order, Penalty penalty,
                       const GaussianCloud& given, const std::optional<Checkpoint>& from) {
  if (!from) {
    return {config, job.views.tune, std::move(order), std::move(penalty), given};
  }
  SceneTuner::State state = SceneTuner::restored(from->state);
  if (state.cloud.means != given.means) {
    throw InputError(fmt::format("{}: is of another scene than {}, its centres are others",
                                 arguments.resume, arguments.scene));
  }
  return {config, job.views.tune, std::move(order), std::move(penalty), std::move(state)};
}

void print_target(const TuningJob& job, std::size_t gaussians) {
  const StorageConfig& storage = job.config.storage;
  print_fact("target", job.views.says);
  print_fact("Gaussians",
             fmt::format("{} in {}, {} left out that no view can show", grouped(gaussians),
                         scheme_of(storage.order).in_words(storage),
                         grouped(job.scene.cloud.size() - gaussians)));
}

void print_visits(const VisitPlan& plan) {
  print_fact("visits", fmt::format("{:.1f} MB kept", static_cast<double>(plan.kept_bytes()) / 1e6));
}

}  // namespace sgs
