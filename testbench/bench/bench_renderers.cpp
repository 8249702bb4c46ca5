// Renderers beside each other: wall time of a view, and how far its picture is from that in double
// precision, pixel by pixel. The same of thresholds of light at which a pixel counts as finished,
// beside double that goes on to the last splat.
//
// The chosen views of a scene as CSV. The scene is stored and sorted beforehand. Times are the
// shortest of kRuns; `cpu ms` is the sum over threads; largest: linear, not clamped; blends:
// (splat, pixel) pairs.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <limits>
#include <numeric>
#include <string>
#include <systemc>
#include <utility>

#include "algorithm/image/quality.h"
#include "algorithm/render/exact_renderer.h"
#include "algorithm/render/paper_renderer.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/render/tile_renderer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/voxel/chunk_tree.h"
#include "algorithm/voxel/voxel_grid.h"
#include "testbench/bench/bench_scene.h"
#include "testbench/command_line/program.h"
#include "testbench/oracle/double_oracle.h"
#include "testbench/streaminggs/run/scene_arguments.h"
#include "tlm/no_banner.h"

namespace {

using namespace sgs;

constexpr int kRuns = 2;
constexpr std::uint32_t kChunkGaussians = 8;  // as the preset `exact`
constexpr double kFinished = 1e-4;            // transmittance of a finished pixel, by the semantics
constexpr double kThresholds[] = {0.1, 0.01, 0.001, kFinished, 1e-5};

struct Picture {
  Image image;
  std::uint64_t blends = 0;
};

Picture picture_of(const OracleImage& oracle) {
  Picture out{Image(oracle.width, oracle.height), 0};
  std::copy(oracle.pixels.begin(), oracle.pixels.end(), out.image.pixels.begin());
  out.blends =
      std::accumulate(oracle.contributors.begin(), oracle.contributors.end(), std::uint64_t{0});
  return out;
}

Picture picture_of(RenderResult&& frame) {
  const auto& blends = frame.contributors;
  return {std::move(frame.image), std::accumulate(blends.begin(), blends.end(), std::uint64_t{0})};
}

// Prints a line for each picture.
struct Bench {
  std::string head;  // scene and view
  int threads;

  template <class Draw>
  void measure(const std::string& renderer, double finished_below, const std::string& beside,
               const Image& truth, const Draw& draw) const {
    Picture picture;
    double wall_ms = std::numeric_limits<double>::max(), cpu_ms = wall_ms;
    for (int run = 0; run < kRuns; ++run) {
      const std::clock_t began = std::clock();
      wall_ms = std::min(wall_ms, time_ms([&] { picture = draw(); }));
      cpu_ms = std::min(cpu_ms, 1e3 * static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC);
    }
    fmt::print("{},{},{:g},{},{:.2f},{:.2f},{},{:.2f},{:.3g},{}\n", head, renderer, finished_below,
               threads, wall_ms, cpu_ms, beside, psnr_db(picture.image, truth),
               max_abs_error(picture.image, truth), picture.blends);
  }
};

ExactOrderConfig exact_order(BlendPrecision precision) {
  ExactOrderConfig config;
  config.group = square_of(96);
  config.merge_entries = 512;
  config.precision = precision;
  return config;
}

PaperOrderConfig paper_order(BlendPrecision precision) {
  PaperOrderConfig config;
  config.rays.step_px = 2;
  config.visit_gaussians = 256;
  config.precision = precision;
  return config;
}

void bench_view(const Bench& bench, const Scene& scene, const ActivatedCloud& cloud,
                const Camera& camera) {
  const auto view = make_view<float>(camera);
  const auto in_double = [&](double finished_below) {
    const auto ordered = oracle_order(oracle_project(camera, scene.cloud));
    return picture_of(oracle_blend(camera, ordered, glm::dvec3(0), finished_below));
  };
  const std::string to_its_end = "double to its end", as_finished = "double";
  const Image unfinished = in_double(0).image, truth = in_double(kFinished).image;
  for (const double threshold : kThresholds) {
    bench.measure("double", threshold, to_its_end, unfinished,
                  [&] { return in_double(threshold); });
  }
  const auto measure = [&](const std::string& renderer, const auto& draw) {
    bench.measure(renderer, kFinished, as_finished, truth, [&] { return picture_of(draw()); });
  };
  measure("reference", [&] { return render_reference(view, cloud); });
  const auto [tree, by_chunk] = arrange_by_chunks(cloud, kChunkGaussians);
  const ActivatedCloud chunks = reordered(cloud, by_chunk);
  const auto voxel = static_cast<float>(choose_voxel_size(cloud).value);
  const auto [grid, by_voxel] = arrange_by_voxels(cloud, voxel, Stored::kVisible);
  const ActivatedCloud voxels = reordered(cloud, by_voxel);
  for (const auto& [precision, name] :
       {std::pair{BlendPrecision::kSingle, ""}, std::pair{BlendPrecision::kHalf, " in half"}}) {
    measure(std::string("exact order") + name, [&, p = precision] {
      return render_exact_order(view, chunks, tree, exact_order(p)).frame;
    });
    measure(std::string("paper order") + name, [&, p = precision] {
      return render_paper_order(view, voxels, grid, paper_order(p)).frame;
    });
  }
  measure("tiles lossless",
          [&] { return render_tiles(view, cloud, TileOrderConfig::lossless()).frame; });
  measure("tiles in half", [&] { return render_tiles(view, cloud, TileOrderConfig{}).frame; });
}

}  // namespace

int sc_main(int argc, char* argv[]) {
  SceneArguments arguments;
  arguments.size = "640x360";
  std::uint32_t threads = static_cast<std::uint32_t>(tbb::this_task_arena::max_concurrency());
  CommandLine line("bench_renderers", "Times of renderers, and their pictures beside double");
  arguments.add_scene_to(line, kUnpackedSceneForms);
  arguments.add_views_to(line);
  line.whole("--threads", threads, 1, 999, "that draw");
  return run_program(line, argc, argv, [&] {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const Scene scene = arguments.load();
    const ActivatedCloud cloud = activate(scene.cloud);
    const ChosenCameras cameras = arguments.chosen_cameras(scene.cameras);
    fmt::print(
        "scene,view,renderer,finished below,threads,ms,cpu ms,beside,PSNR dB,largest,blends\n");
    for (const auto& [number, camera] : cameras.views) {
      bench_view({fmt::format("{},{}", scene.name, number), static_cast<int>(threads)}, scene,
                 cloud, camera);
    }
    return kDone;
  });
}
