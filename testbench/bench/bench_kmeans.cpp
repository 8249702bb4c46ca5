// Benchmark of k-means at the paper's codebook sizes, on as many points as quantise() trains with,
// made up to look like a trained scene's: clusters of clusters, few of them large; SH of a few
// patterns of light, weaker from band to band.
// usage: bench_kmeans [SCENE...]   (scripts/bench.sh hands scenes to all; this one needs none)
//
// First one pass of finding every point's nearest entry, from the last pass's: k-d tree beside
// exhaustive search, and a whole training as the library does it. Then the SH codebook on half of
// the points: plain Lloyd beside Hamerly's bounds and mini-batches. Passes and ways of training are
// medians of kRuns paired runs; all threads. Exit status 1 when two searches differ in any label or
// distance.
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "algorithm/vq/canonical_shape.h"
#include "algorithm/vq/codebooks.h"
#include "algorithm/vq/kmeans.h"
#include "algorithm/vq/nearest.h"
#include "testbench/bench/training.h"

namespace {

using namespace sgs;

constexpr int kRuns = 3;
constexpr std::uint32_t kIterations = 20;

template <class Work>
double time_ms(const Work& work) {
  const auto began = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - began;
  return took.count();
}

double median(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

// Sums of three random steps, each from a set smaller and wider than the next: clusters of
// clusters.
class Clusters {
 public:
  Clusters(std::mt19937_64& random, std::size_t dims) : dims_(dims) {
    std::normal_distribution<float> normal;
    for (const auto& [count, width] : {std::pair{12U, 1.0F}, {300U, 0.3F}}) {
      steps_.emplace_back(count * dims);
      for (float& value : steps_.back()) value = width * normal(random);
    }
  }
  void draw(std::mt19937_64& random, float* point) const {
    std::normal_distribution<float> normal;
    for (std::size_t d = 0; d < dims_; ++d) point[d] = 0.05F * normal(random);
    for (const std::vector<float>& steps : steps_) {
      // The square makes some clusters much larger than others.
      const double at = std::pow(std::generate_canonical<double, 53>(random), 2);
      const auto step = static_cast<std::size_t>(at * static_cast<double>(steps.size() / dims_));
      for (std::size_t d = 0; d < dims_; ++d) point[d] += steps[step * dims_ + d];
    }
  }

 private:
  std::size_t dims_;
  std::vector<std::vector<float>> steps_;
};

// A drawn point of few dimensions as one of the codebook's.
void shape_point(Codebook codebook, const float* drawn, float* point) {
  if (codebook == Codebook::kScale) {
    point[0] = -std::abs(drawn[0]);
    point[1] = point[0] - std::abs(drawn[1]);
  } else if (codebook == Codebook::kRotation) {
    float length = 0;
    for (int k = 0; k < 4; ++k) length += drawn[k] * drawn[k];
    length = std::sqrt(length);
    const CanonicalShape shape = canonical_shape(
        {3, 2, 1}, {drawn[0] / length, drawn[1] / length, drawn[2] / length, drawn[3] / length});
    std::copy(shape.quat.begin(), shape.quat.end(), point);
  } else {
    std::copy_n(drawn, 3, point);
  }
}

// 15 bands of rgb from eight patterns of light, their strength of very different size.
void shape_sh(const std::vector<float>& patterns, const float* drawn, std::mt19937_64& random,
              float* point) {
  std::normal_distribution<float> normal;
  const float strength = std::exp(0.8F * normal(random) - 2);
  for (std::size_t word = 0; word < 45; ++word) {
    const float band = word < 9 ? 1.0F : word < 24 ? 0.5F : 0.3F;
    float sum = 0.2F * normal(random);
    for (std::size_t k = 0; k < 8; ++k) sum += drawn[k] * patterns[k * 45 + word];
    point[word] = strength * band * sum;
  }
}

PointSet make_points(Codebook codebook) {
  const std::size_t count =
      std::max<std::size_t>(1U << 16, std::size_t{64} * VqConfig{}.entries(codebook));
  std::mt19937_64 random(1 + static_cast<std::uint64_t>(codebook));
  const bool sh = codebook == Codebook::kSh;
  const std::size_t drawn_dims = sh ? 8 : 4;
  const std::size_t dims = codebook == Codebook::kScale ? 2 : codebook_words(codebook, 3);
  const Clusters clusters(random, drawn_dims);
  std::normal_distribution<float> normal;
  std::vector<float> patterns(8 * 45), drawn(drawn_dims);
  for (float& value : patterns) value = normal(random);
  PointSet points;
  points.dims = static_cast<int>(dims);
  points.values.resize(count * dims);
  points.weights.assign(count, 1);
  for (std::size_t i = 0; i < count; ++i) {
    clusters.draw(random, drawn.data());
    if (sh) {
      shape_sh(patterns, drawn.data(), random, &points.values[i * dims]);
    } else {
      shape_point(codebook, drawn.data(), &points.values[i * dims]);
    }
  }
  return points;
}

using Labels = std::vector<std::uint32_t>;

// Nearest entries; hints and their results in `labels`, distances summed up in order.
double assign(const PointSet& points, const NearestSearch& search, Labels& labels) {
  std::vector<float> squared(points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 2048),
                    [&](const auto& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        const Nearest nearest = search.find(points[i], labels[i]);
                        labels[i] = nearest.index;
                        squared[i] = nearest.squared_distance;
                      }
                    });
  double sum = 0;
  for (const float one : squared) sum += one;
  return sum;
}

KMeansResult train(const PointSet& points, std::uint32_t entries, std::uint32_t iterations) {
  KMeansConfig config;
  config.entries = entries;
  config.iterations = iterations;
  return kmeans(points, config);
}

// Prints a line; returns whether all searches agree.
bool bench_codebook(Codebook codebook) {
  const PointSet points = make_points(codebook);
  const std::uint32_t entries = VqConfig{}.entries(codebook);
  // The second pass of a training: hints are good, not perfect.
  const KMeansResult before = train(points, entries, 1), after = train(points, entries, 2);
  std::vector<double> tree_ms, all_ms;
  bool agree = true;
  for (int run = 0; run < kRuns; ++run) {
    Labels by_tree = before.labels, by_all = before.labels;
    double tree_sum = 0, all_sum = 0;
    tree_ms.push_back(time_ms(
        [&] { tree_sum = assign(points, *make_kd_tree(after.centroids, points.dims), by_tree); }));
    all_ms.push_back(time_ms([&] {
      all_sum = assign(points, *make_exhaustive_search(after.centroids, points.dims), by_all);
    }));
    agree = agree && by_tree == by_all && tree_sum == all_sum;
  }
  const double train_ms = time_ms([&] { train(points, entries, kIterations); });
  const bool tree = points.dims <= 4;
  fmt::print("{:<9} {:>5} {:>8} {:>8} {:>10} {:>11.0f} {:>10.0f}\n",
             kCodebookNames[static_cast<std::size_t>(codebook)], points.dims, points.size(),
             entries, tree ? fmt::format("{:.0f}", median(tree_ms)) : "-", median(all_ms),
             train_ms);
  return agree;
}

// Training of the SH codebook in several ways from the same seeds.
bool bench_training() {
  const PointSet all = make_points(Codebook::kSh);
  const PointSet points = draw(all, all.size() / 2, 1);
  const std::uint32_t entries = VqConfig{}.sh_entries;
  const std::vector<float> seeds = train(points, entries, 0).centroids;
  std::vector<double> lloyd_ms, hamerly_ms, batch_ms;
  bench::Training lloyd, hamerly, batch;
  for (int run = 0; run < kRuns; ++run) {
    lloyd_ms.push_back(time_ms([&] { lloyd = bench::plain_lloyd(points, seeds, kIterations); }));
    hamerly_ms.push_back(time_ms([&] { hamerly = bench::hamerly(points, seeds, kIterations); }));
    batch_ms.push_back(
        time_ms([&] { batch = bench::mini_batches(points, seeds, lloyd.mean_squared_error); }));
  }
  fmt::print("\nSH, {} points, {} iterations    ms    error\n", points.size(), kIterations);
  fmt::print("  plain Lloyd          {:>12.0f} {:>8.5f}\n", median(lloyd_ms),
             lloyd.mean_squared_error);
  fmt::print("  Hamerly's bounds     {:>12.0f} {:>8.5f}   {:.0f} % of the searches spared\n",
             median(hamerly_ms), hamerly.mean_squared_error, 100 * hamerly.spared);
  fmt::print("  mini-batches         {:>12.0f} {:>8.5f}   {} batches of {}\n", median(batch_ms),
             batch.mean_squared_error, batch.batches, bench::kBatchPoints);
  return hamerly.centroids == lloyd.centroids;
}

}  // namespace

int main() {
  fmt::print("k-means, {} threads, {} runs, times in ms\n", tbb::this_task_arena::max_concurrency(),
             kRuns);
  fmt::print("{:<9} {:>5} {:>8} {:>8} {:>10} {:>11} {:>10}\n", "codebook", "dims", "points",
             "entries", "k-d tree", "exhaustive", "training");
  bool agree = true;
  for (const Codebook codebook :
       {Codebook::kScale, Codebook::kRotation, Codebook::kDc, Codebook::kSh}) {
    agree = bench_codebook(codebook) && agree;
  }
  agree = bench_training() && agree;
  fmt::print("all ways give the same bits: {}\n", agree ? "yes" : "NO");
  return agree ? 0 : 1;
}
