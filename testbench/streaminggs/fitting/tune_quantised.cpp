// streaminggs tune SCENE --quantise
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "algorithm/files/input_error.h"
#include "algorithm/splat/activate.h"
#include "algorithm/storage/decoded_image.h"
#include "algorithm/storage/image_file.h"
#include "algorithm/train/comparison.h"
#include "algorithm/train/quantised_tuner.h"
#include "algorithm/vq/image_weights.h"
#include "testbench/streaminggs/fitting/tune_command.h"
#include "testbench/streaminggs/report/numbers.h"
#include "testbench/streaminggs/run/progress.h"

namespace sgs {
namespace {

constexpr int kQuantisedSteps = 5'000;  // the paper's
// Where codebooks are near the scene already, more than a fifth of the original's rates leads away
// from it at first.
constexpr double kQuantisedRate = 0.2;

QuantisedTuningConfig tuning_config(const TuneArguments& arguments, SecondHalfEncoding encoding) {
  if (!SecondHalfFormat{encoding, 0, {}}.quantised()) {
    throw InputError(fmt::format(
        "--quantise: got storage.encoding {}, which has no codebooks, expected vq or vq_packed",
        kEncodingNames[static_cast<std::size_t>(encoding)]));
  }
  QuantisedTuningConfig config;
  arguments.set(config, kQuantisedSteps, kQuantisedRate);
  config.reassign_every = static_cast<int>(arguments.reassign_every);
  config.encoding = encoding;
  return config;
}

QuantisedTuner begun(const TuneArguments& arguments, const TuningJob& job,
                     const QuantisedTuningConfig& config, DrawingOrder order,
                     const ActivatedCloud& given, const std::optional<Checkpoint>& from) {
  QuantisedTuner::Weighing weighing{image_weights(given, job.views.cameras),
                                    pixel_sizes(given, job.views.cameras)};
  if (from) {
    QuantisedTuner::State state = QuantisedTuner::restored(from->state);
    const bool same =
        state.own.size() == given.size() &&
        std::equal(given.gaussians.begin(), given.gaussians.end(), state.own.means.begin(),
                   [](const auto& g, const glm::vec3& mean) { return g.mean == mean; });
    if (!same) {
      throw InputError(fmt::format("{}: is of another scene than {}, its centres are others",
                                   arguments.resume, arguments.scene));
    }
    return {config, job.views.tune, std::move(order), std::move(weighing), std::move(state)};
  }
  const ProgressLine progress;
  QuantisedCloud quantised = quantise(given, weighing.weights, weighing.pixel_sizes,
                                      job.config.storage.vq, progress.of_quantisation());
  return {config, job.views.tune,      std::move(order), std::move(weighing),
          given,  std::move(quantised)};
}

// Quality of a scene as the machine stores it, shown in the machine's order.
class Judge {
 public:
  Judge(const TuningJob& job, const std::optional<PaperOrderConfig>& order)
      : test_(job.views.test), order_(order) {}

  struct Verdict {
    Quality shown, reference;
  };
  Verdict of(const ActivatedCloud& cloud, const StoredTable& table,
             const PictureSeen& seen = {}) const {
    if (order_) {
      const PaperQuality quality =
          paper_quality(cloud, std::get<VoxelGrid>(table), *order_, {}, test_, seen);
      return {quality.paper, quality.reference};
    }
    const Quality shown = mean_quality(qualities(cloud, test_, glm::vec3(0), seen));
    return {shown, shown};
  }

 private:
  const Photographs& test_;
  const std::optional<PaperOrderConfig>& order_;
};

// Exactly what pack writes of a scene that it quantised itself.
void write_packed(const TuneArguments& arguments, const TuningJob& job,
                  const QuantisedTuner& tuner) {
  const StoredScene stored = tuner.stored(job.config.storage);
  decode_image(stored.image, arguments.out);  // refuses what a reader would
  write_image_file(arguments.out,
                   {job.scene.name, job.scene.cloud.size(), job.scene.dropped_invalid},
                   stored.storage, stored.image);
}

}  // namespace

int tune_for_codebooks(const TuneArguments& arguments, const TuningJob& job) {
  const StorageConfig& storage = job.config.storage;
  const QuantisedTuningConfig config = tuning_config(arguments, storage.encoding);
  const std::optional<PaperOrderConfig> order = tuned_order(arguments, job.config);
  const std::string work = arguments.work();
  const std::optional<Checkpoint> from = arguments.resumed(work, job.contents);

  const CloudInStorage given = given_in_storage(arguments, job);
  const ActivatedCloud activated = activate(given.cloud);
  std::optional<VisitPlan> plan;
  if (order) plan.emplace(std::get<VoxelGrid>(given.table), *order, arguments.visit_bytes());
  QuantisedTuner tuner =
      begun(arguments, job, config, plan ? paper_order(*plan) : reference_order(), activated, from);
  print_target(job, activated.size());
  const Judge judge(job, order);
  print_fact("as given", fmt::format("PSNR {:.2f} dB, before codebooks",
                                     judge.of(activated, given.table).shown.psnr_db));
  arguments.pictures.write_photographs(job.views.test, order ? order->background : glm::vec3(0));
  const auto look = [&] {
    const StoredScene stored = tuner.stored(storage);
    const Judge::Verdict verdict =
        judge.of(stored.decoded, stored.table, arguments.pictures.behind(tuner.next_step()));
    return Look{verdict.shown, {verdict.reference.psnr_db, tuner.reassigned()}};
  };
  const FittingTask task{work,
                         arguments.pace(config),
                         job.contents,
                         tuner,
                         {{"reference_psnr_db", "reference"}, {"reassigned", "reassigned"}},
                         look,
                         [&] { write_packed(arguments, job, tuner); }};
  const int status = run_fitting(arguments, task, from, !from);
  if (plan) print_visits(*plan);
  return status;
}

}  // namespace sgs
