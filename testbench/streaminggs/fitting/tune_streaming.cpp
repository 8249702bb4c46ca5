// streaminggs tune SCENE --streaming
#include <fmt/format.h>

#include <optional>

#include "algorithm/files/input_error.h"
#include "algorithm/render/blend_pass.h"
#include "algorithm/scene/ply_writer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/train/comparison.h"
#include "testbench/streaminggs/fitting/tune_command.h"

namespace sgs {
namespace {

constexpr int kStreamingSteps = 3'000;
constexpr double kStreamingRate = 0.2;  // the picture is right already

// Second halves that a view must fetch at least, on average over the views: groups that the boxes
// of its splats meet.
double fetches_of(const ActivatedCloud& cloud, const Photographs& views, const PixelSize& group) {
  std::size_t sum = 0;
  for (std::size_t at = 0; at < views.size(); ++at) {
    const auto view = make_view<float>(views.camera(at));
    const CellGrid grid = cell_grid(view.width, view.height, group);
    for (const Splat& splat : reference_sequences(view, cloud).splats) {
      sum += cells_of(grid, splat.footprint).size();
    }
  }
  return static_cast<double>(sum) / static_cast<double>(views.size());
}

}  // namespace

int tune_for_streaming(const TuneArguments& arguments, const TuningJob& job) {
  TuningConfig config;
  arguments.set(config, kStreamingSteps, kStreamingRate);
  if (job.config.design->paper_order()) {
    throw InputError(fmt::format(
        "--streaming: machine {} fetches by voxels, whatever is seen of them, expected one of "
        "exact order, as --config exact",
        job.config.machine()));
  }
  tuned_order(arguments, job.config);
  const PixelSize group = job.config.design->group();
  if (group == PixelSize{}) {
    throw InputError(
        fmt::format("--streaming: machine {} has no groups of pixels", job.config.machine()));
  }
  const std::string work = arguments.work();
  const std::optional<Checkpoint> from = arguments.resumed(work, job.contents);
  const CloudInStorage given = given_in_storage(arguments, job);
  SceneTuner tuner = begun_tuner(arguments, job, config, reference_order(),
                                 streaming_loss(arguments.price, group), given.cloud, from);
  print_target(job, given.cloud.size());
  arguments.pictures.write_photographs(job.views.test, glm::vec3(0));
  const auto look = [&] {
    const PictureSeen seen = arguments.pictures.behind(tuner.next_step());
    const CloudInStorage now = in_storage(tuner.cloud(), job.config.storage);
    const ActivatedCloud cloud = activate(now.cloud);
    return Look{mean_quality(qualities(cloud, job.views.test, glm::vec3(0), seen)),
                {static_cast<double>(cloud.size()), fetches_of(cloud, job.views.test, group)}};
  };
  const FittingTask task{work,
                         arguments.pace(config),
                         job.contents,
                         tuner,
                         {{"stored", "stored"}, {"fetches", "fetches"}},
                         look,
                         [&] { write_ply(arguments.out, tuner.cloud()); }};
  return run_fitting(arguments, task, from, !from);
}

}  // namespace sgs
