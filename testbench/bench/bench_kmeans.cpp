// Benchmark of k-means at the paper's codebook sizes, on as many of a scene's Gaussians as
// quantise() trains with.
// usage: bench_kmeans SCENE...   (see bench_scene.h)
//
// One pass of finding every point's nearest entry from the last pass's: as the library does it,
// beside exhaustive search; then seeding and kIterations. Passes are medians of kRuns paired runs;
// all threads. Exit status 1 when the two searches differ in any label or distance.
#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "algorithm/files/input_error.h"
#include "algorithm/splat/activate.h"
#include "algorithm/vq/kmeans.h"
#include "algorithm/vq/nearest.h"
#include "algorithm/vq/quantise.h"
#include "algorithm/vq/vq_points.h"
#include "testbench/bench/bench_scene.h"
#include "testbench/command_line/guard.h"

namespace {

using namespace sgs;

constexpr int kRuns = 3;
constexpr std::uint32_t kIterations = 20;

// Appends what the codebook stores of Gaussian `i`: scales as logarithms, like quantise().
void append(Codebook codebook, const ActivatedCloud& cloud, std::size_t i,
            std::vector<float>& values) {
  const Gaussian<float>& g = cloud.gaussians[i];
  const CanonicalShape shape = canonical_shape(g.scale, g.quat);
  const glm::vec3* sh = cloud.sh(i);
  if (codebook == Codebook::kScale) {
    for (int axis : {1, 2}) values.push_back(std::log(shape.scale[axis] / shape.scale[0] + 0.02F));
  } else if (codebook == Codebook::kRotation) {
    values.insert(values.end(), shape.quat.begin(), shape.quat.end());
  } else {
    const int first = codebook == Codebook::kDc ? 0 : 1;
    const int last = codebook == Codebook::kDc ? 1 : sh_coeff_count(cloud.sh_degree);
    for (int k = first; k < last; ++k) {
      for (int channel = 0; channel < 3; ++channel) values.push_back(sh[k][channel]);
    }
  }
}

PointSet points_of(Codebook codebook, const ActivatedCloud& cloud) {
  PointSet points;
  for (std::size_t i = 0; i < cloud.size(); ++i) append(codebook, cloud, i, points.values);
  points.dims = static_cast<int>(points.values.size() / cloud.size());
  points.weights.assign(cloud.size(), 1);
  const std::size_t trained = std::size_t{64} * VqConfig{}.entries(codebook);
  return draw(points, std::max(std::size_t{1} << 16, trained), 1);
}

KMeansResult train(const PointSet& points, std::uint32_t entries, std::uint32_t iterations) {
  KMeansConfig config;
  config.entries = entries;
  config.iterations = iterations;
  return kmeans(points, config);
}

// Nearest entries, with hints and results in `labels`; their squared distances.
std::vector<float> assign(const PointSet& points, const NearestSearch& search,
                          std::vector<std::uint32_t>& labels) {
  std::vector<float> squared(points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 2048),
                    [&](const auto& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        const Nearest nearest = search.find(points[i], labels[i]);
                        labels[i] = nearest.index;
                        squared[i] = nearest.squared_distance;
                      }
                    });
  return squared;
}

// Prints a line; returns whether the searches agree.
bool bench_codebook(const std::string& scene, Codebook codebook, const ActivatedCloud& cloud) {
  const PointSet points = points_of(codebook, cloud);
  const std::uint32_t entries = VqConfig{}.entries(codebook);
  // The second pass of a training: hints are good, not perfect.
  const KMeansResult before = train(points, entries, 1), after = train(points, entries, 2);
  std::vector<double> library_ms, exhaustive_ms;
  bool agree = true;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<std::uint32_t> by_library = before.labels, by_all = before.labels;
    std::vector<float> library_squared, all_squared;
    library_ms.push_back(time_ms([&] {
      library_squared = assign(points, *make_search(after.centroids, points.dims), by_library);
    }));
    exhaustive_ms.push_back(time_ms([&] {
      all_squared = assign(points, *make_exhaustive_search(after.centroids, points.dims), by_all);
    }));
    agree = agree && by_library == by_all && library_squared == all_squared;
  }
  const double train_ms = time_ms([&] { train(points, entries, kIterations); });
  fmt::print("{:<10} {:<9} {:>4} {:>8} {:>8} {:>10.0f} {:>11.0f} {:>6.1f} {:>9.0f}\n", scene,
             kCodebookNames[static_cast<std::size_t>(codebook)], points.dims, points.size(),
             after.entries(points.dims), median(library_ms), median(exhaustive_ms),
             median(exhaustive_ms) / median(library_ms), train_ms);
  return agree;
}

}  // namespace

int main(int argc, char** argv) {
  return run_guarded("bench_kmeans", [&] {
    const std::vector<std::string> specs(argv + 1, argv + argc);
    if (specs.empty()) throw InputError("got no scene, expected bench_kmeans SCENE...");
    fmt::print("k-means, {} threads, {} runs, times in ms\n",
               tbb::this_task_arena::max_concurrency(), kRuns);
    fmt::print("{:<10} {:<9} {:>4} {:>8} {:>8} {:>10} {:>11} {:>6} {:>9}\n", "scene", "codebook",
               "dims", "points", "entries", "library", "exhaustive", "ratio", "training");
    bool agree = true;
    for (const std::string& spec : specs) {
      const Scene scene = load_bench_scene(spec);
      const ActivatedCloud cloud = activate(scene.cloud);
      if (cloud.size() == 0) continue;
      for (const Codebook codebook :
           {Codebook::kScale, Codebook::kRotation, Codebook::kDc, Codebook::kSh}) {
        if (codebook == Codebook::kSh && cloud.sh_degree == 0) continue;
        agree = bench_codebook(scene.name, codebook, cloud) && agree;
      }
    }
    fmt::print("both searches give the same bits: {}\n", agree ? "yes" : "NO");
    return agree ? kDone : kFailed;
  });
}
