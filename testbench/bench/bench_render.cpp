// Benchmark of the reference renderer: milliseconds a view, scene loaded, all threads.
// usage: bench_render SCENE...   (see bench_scene.h)
//
// Each view is rendered once to warm up, then kRuns times. `project` is the share of it that finds,
// sorts and projects the splats. `floor` is measured beside it: the same number of 4x4 blends done
// back to back on one sub-tile a thread that never leaves its cache; no renderer that blends so
// often can be faster. Exit status 1 when a view takes longer than the budget.
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "algorithm/files/input_error.h"
#include "algorithm/render/blend_pass.h"
#include "algorithm/render/group_state.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "testbench/bench/bench_scene.h"
#include "testbench/command_line/guard.h"

namespace {

using namespace sgs;

constexpr int kRuns = 9;
constexpr double kBudgetMs = 250;  // a view of 640x360 on two cores

struct ViewCounts {
  std::uint64_t splats = 0;          // visible in the frame
  std::uint64_t subtile_blends = 0;  // (splat, 4x4 sub-tile) pairs
};

ViewCounts count(const View<float>& view, const ActivatedCloud& cloud) {
  ViewCounts counts;
  SplatSequence sequence(view, cloud);
  std::vector<GroupState> tiles;
  for (const PixelRect& pixels : pixel_groups(view.width, view.height, square_of(kTilePx))) {
    tiles.emplace_back(pixels, view.width, view.height);
  }
  const CellGrid grid = cell_grid(view.width, view.height, square_of(kTilePx));
  std::vector<std::uint64_t> blends(tiles.size(), 0);
  std::vector<Splat> batch;
  while (!sequence.at_end()) {
    sequence.next(65536, batch);
    counts.splats += batch.size();
    const SplatBins bins = bin_splats(grid, batch.data(), batch.size());
    tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t tile) {
      for (std::size_t i = bins.first[tile]; i != bins.first[tile + 1]; ++i) {
        blends[tile] += tiles[tile].blend(batch[bins.entries[i]]).blended;
      }
    });
  }
  counts.subtile_blends = std::accumulate(blends.begin(), blends.end(), std::uint64_t{0});
  return counts;
}

void project_all(const View<float>& view, const ActivatedCloud& cloud) {
  SplatSequence sequence(view, cloud);
  std::vector<Splat> batch;
  while (!sequence.at_end()) sequence.next(32768, batch);
}

void blend_floor(std::uint64_t subtile_blends) {
  const auto threads = static_cast<std::uint64_t>(tbb::this_task_arena::max_concurrency());
  tbb::parallel_for(std::uint64_t{0}, threads, [&](std::uint64_t) {
    SubtileState state = make_subtile(0, 0, 4, 4);
    Splat splat{};
    splat.conic_a = splat.conic_c = 0.1F;
    splat.opacity = 0.5F;
    for (std::uint64_t i = 0; i < subtile_blends / threads; ++i) {
      blend(state, 0, 0, splat);
      state.transmittance[i % kSubtilePixels] = 1;
    }
  });
}

// Prints a line for each view; returns the slowest median.
double bench_scene(const std::string& spec) {
  const Scene scene = load_bench_scene(spec);
  const ActivatedCloud cloud = activate(scene.cloud);
  double slowest_ms = 0;
  for (const Camera& camera : scene.cameras) {
    const auto view = make_view<float>(camera);
    const ViewCounts counts = count(view, cloud);
    std::vector<double> whole, project, floor;
    render_reference(view, cloud);
    for (int run = 0; run < kRuns; ++run) {
      whole.push_back(time_ms([&] { render_reference(view, cloud); }));
      project.push_back(time_ms([&] { project_all(view, cloud); }));
      floor.push_back(time_ms([&] { blend_floor(counts.subtile_blends); }));
    }
    const double whole_ms = median(whole), floor_ms = median(floor);
    fmt::print("{:<10} {:>4} {:>10} {:>9} {:>9.2f} {:>8.1f} {:>8.1f} {:>8.1f} {:>8.1f} {:>6.1f}\n",
               scene.name, camera.id, cloud.size(), counts.splats,
               1e-6 * static_cast<double>(counts.subtile_blends),
               *std::min_element(whole.begin(), whole.end()), whole_ms, median(project), floor_ms,
               whole_ms / floor_ms);
    slowest_ms = std::max(slowest_ms, whole_ms);
  }
  return slowest_ms;
}

}  // namespace

int main(int argc, char** argv) {
  return run_guarded("bench_render", [&] {
    const std::vector<std::string> scenes(argv + 1, argv + argc);
    if (scenes.empty()) throw InputError("got no scene, expected bench_render SCENE...");
    fmt::print("reference renderer, {} threads, {} runs, times in ms\n",
               tbb::this_task_arena::max_concurrency(), kRuns);
    fmt::print("{:<10} {:>4} {:>10} {:>9} {:>9} {:>8} {:>8} {:>8} {:>8} {:>6}\n", "scene", "view",
               "Gaussians", "splats", "M blends", "best", "median", "project", "floor", "ratio");
    double slowest_ms = 0;
    for (const std::string& scene : scenes) slowest_ms = std::max(slowest_ms, bench_scene(scene));
    const bool met = slowest_ms <= kBudgetMs;
    fmt::print("slowest view {:.1f} ms, budget {:.0f} ms: {}\n", slowest_ms, kBudgetMs,
               met ? "met" : "MISSED");
    return met ? kDone : kFailed;
  });
}
