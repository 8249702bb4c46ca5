// Benchmark of one step of training: milliseconds, all threads.
// usage: bench_tune SCENE...   (see bench_scene.h)
//
// Each scene gives at most kMostGaussians, evenly drawn, seen by its first camera at 400 x 400 px.
// The target is the scene's own picture, and the parameters are moved off it. Stages: `order`
// projects, sorts and bins, `draw` blends, `loss` with SSIM, `gradient` back to parameters, `Adam`,
// `activate` what it moved. Each stage's time is the processor time over all threads, which is its
// duration when nobody else computes. `step` is the sum of the stages; `median` and `best` are
// measured by the clock. Medians of kRuns steps. Exit status 1 when the best step of a scene takes
// longer than the budget.
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <functional>
#include <numeric>
#include <random>
#include <utility>

#include "algorithm/files/input_error.h"
#include "algorithm/render/paper_renderer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/tune/adam.h"
#include "algorithm/tune/group_sequences.h"
#include "algorithm/tune/photometric_loss.h"
#include "algorithm/tune/scene_gradient.h"
#include "testbench/bench/bench_scene.h"
#include "testbench/command_line/guard.h"

namespace {

using namespace sgs;

constexpr int kRuns = 15;
constexpr std::size_t kMostGaussians = 100'000;
constexpr int kSidePx = 400;
constexpr double kBudgetMs = 150;  // on two cores

GaussianCloud thinned(const GaussianCloud& cloud) {
  const std::size_t count = std::min(kMostGaussians, cloud.size());
  std::vector<std::uint32_t> order(count);
  for (std::size_t i = 0; i < count; ++i) {
    order[i] = static_cast<std::uint32_t>(i * cloud.size() / count);
  }
  return reordered(cloud, order);
}

// Square, of the same height in the scene.
Camera square(Camera camera) {
  const double scale = static_cast<double>(kSidePx) / camera.height;
  camera.width = camera.height = kSidePx;
  camera.focal_x *= scale;
  camera.focal_y *= scale;
  return camera;
}

void move_off(GaussianCloud& cloud) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal(0, 0.1F);
  for (auto& coeff : cloud.sh_coeffs)
    coeff += glm::vec3(normal(random), normal(random), normal(random));
  for (auto& scale : cloud.log_scales) scale += normal(random);
  for (float& logit : cloud.opacity_logits) logit += normal(random);
}

// Processor time of work() over the threads, milliseconds.
template <class Work>
double cpu_ms(const Work& work) {
  const std::clock_t began = std::clock();
  work();
  return 1e3 * static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC /
         tbb::this_task_arena::max_concurrency();
}

// Makes the sequences of a step.
using Order = std::function<GroupSequences(const View<float>&, const ActivatedCloud&)>;

class Trainer {
 public:
  Trainer(const GaussianCloud& scene, const Camera& camera, Order order)
      : view_(make_view<float>(camera)),
        order_(std::move(order)),
        parameters_(scene),
        adam_(scene) {
    target_ = draw(reference_sequences(view_, activate(scene))).image;
    move_off(parameters_);
    cloud_ = activate(parameters_);
    extent_ = scene_extent({camera, Camera{}});
  }

  static constexpr std::size_t kStages = 6;
  using Stages = std::array<double, kStages>;

  // Processor time of each stage of one step, in ms.
  Stages step_ms() {
    GroupSequences sequences;
    RenderResult picture;
    PixelGradient by_pixel;
    return {cpu_ms([&] { sequences = order_(view_, cloud_); }),
            cpu_ms([&] { picture = draw(sequences); }),
            cpu_ms([&] { by_pixel.colour = photometric_loss(picture.image, target_).gradient; }),
            cpu_ms([&] {
              scene_gradient({view_, parameters_, cloud_, sequences, picture}, by_pixel,
                             GradientRule::kDerivative, gradient_);
            }),
            cpu_ms([&] { adam_.step(gradient_, schedule_.at(0, extent_), parameters_); }),
            cpu_ms([&] { reactivate(parameters_, gradient_.indices, cloud_); })};
  }
  std::size_t seen() const { return gradient_.size(); }

 private:
  View<float> view_;
  Order order_;
  GaussianCloud parameters_;
  ActivatedCloud cloud_;
  Adam adam_;
  LearningSchedule schedule_;
  Image target_;
  CloudGradient gradient_;
  double extent_;
};

// Prints a line; returns the best step.
double bench_order(const std::string& name, const GaussianCloud& cloud, const Camera& camera,
                   const Order& order) {
  Trainer trainer(cloud, camera, order);
  trainer.step_ms();
  std::array<std::vector<double>, Trainer::kStages> stages;
  std::vector<double> whole, clock;
  for (int run = 0; run < kRuns; ++run) {
    Trainer::Stages step{};
    clock.push_back(time_ms([&] { step = trainer.step_ms(); }));
    whole.push_back(std::accumulate(step.begin(), step.end(), 0.0));
    for (std::size_t k = 0; k < step.size(); ++k) stages[k].push_back(step[k]);
  }
  std::string line = fmt::format("{:<17} {:>9} {:>8}", name, cloud.size(), trainer.seen());
  for (const auto& stage : stages) line += fmt::format(" {:>8.1f}", median(stage));
  const double best = *std::min_element(clock.begin(), clock.end());
  fmt::print("{} {:>8.1f} {:>8.1f} {:>8.1f}\n", line, median(whole), median(clock), best);
  return best;
}

// In the paper's voxels and groups; returns the slower order's best step.
double bench_scene(const std::string& spec) {
  const Scene scene = load_bench_scene(spec);
  const Camera camera = square(scene.cameras.at(0));
  const GaussianCloud cloud = thinned(scene.cloud);
  const double reference = bench_order(scene.name, cloud, camera, reference_sequences);

  const ActivatedCloud activated = activate(cloud);
  const auto voxel_size = static_cast<float>(paper_voxel_size(inner_extent(activated)));
  const auto arranged = arrange_by_voxels(activated, voxel_size);
  const GaussianCloud stored = reordered(cloud, arranged.storage_order);
  const PaperOrderConfig config;
  const auto group_voxels =
      render_paper_order(make_view<float>(camera), activate(stored), arranged.table, config)
          .group_voxels;
  const double paper =
      bench_order(scene.name + ", paper", stored, camera,
                  [&](const View<float>& view, const ActivatedCloud& now) {
                    return visited_sequences(view, now, arranged.table, group_voxels, config.group);
                  });
  return std::max(reference, paper);
}

}  // namespace

int main(int argc, char** argv) {
  return run_guarded("bench_tune", [&] {
    const std::vector<std::string> scenes(argv + 1, argv + argc);
    if (scenes.empty()) throw InputError("got no scene, expected bench_tune SCENE...");
    fmt::print("one step of training, {} threads, {} steps, times in ms\n",
               tbb::this_task_arena::max_concurrency(), kRuns);
    fmt::print("{:<17} {:>9} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n",
               "scene", "Gaussians", "seen", "order", "draw", "loss", "gradient", "Adam",
               "activate", "step", "median", "best");
    double slowest_ms = 0;
    for (const std::string& scene : scenes) slowest_ms = std::max(slowest_ms, bench_scene(scene));
    const bool met = slowest_ms <= kBudgetMs;
    fmt::print("slowest scene's best step {:.1f} ms, budget {:.0f} ms: {}\n", slowest_ms, kBudgetMs,
               met ? "met" : "MISSED");
    return met ? kDone : kFailed;
  });
}
