// Renderers beside each other: wall time of a view, and how far its picture is from that in double
// precision, pixel by pixel. The same of thresholds of light at which a pixel counts as finished,
// beside double that goes on to the last splat.
// usage: bench_renderers [--threads N] [--size WxH] [--view N] SCENE...   (see bench_scene.h)
//
// View N (0) of each scene at W x H px (640x360), N threads (all cores), as CSV. Scenes are stored
// and sorted beforehand. Times are the shortest of kRuns; `cpu ms` is the sum over threads;
// largest: linear, not clamped; blends: (splat, pixel) pairs.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/files/input_error.h"
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
#include "testbench/command_line/guard.h"
#include "testbench/oracle/double_oracle.h"

namespace {

using namespace sgs;

constexpr int kMaxThreads = 999, kMaxSizePx = 65536;
constexpr int kRuns = 2;
constexpr std::uint32_t kChunkGaussians = 8;  // as the preset `exact`
constexpr double kFinished = 1e-4;            // transmittance of a finished pixel, by the semantics
constexpr double kThresholds[] = {0.1, 0.01, 0.001, kFinished, 1e-5};

struct Options {
  int threads = tbb::this_task_arena::max_concurrency();
  int width = 640, height = 360;  // px
  int view = 0;
};

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
class Bench {
 public:
  Bench(std::string scene, const Options& options) : scene_(std::move(scene)), options_(options) {}

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
    fmt::print("{},{},{},{:g},{},{:.2f},{:.2f},{},{:.2f},{:.3g},{}\n", scene_, options_.view,
               renderer, finished_below, options_.threads, wall_ms, cpu_ms, beside,
               psnr_db(picture.image, truth), max_abs_error(picture.image, truth), picture.blends);
  }

 private:
  std::string scene_;
  Options options_;
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

// Throws InputError for a view that the scene has not.
Camera camera_of(const Scene& scene, const std::string& spec, const Options& options) {
  const auto view = static_cast<std::size_t>(options.view);
  if (view >= scene.cameras.size()) {
    throw InputError(fmt::format("{}: --view: got '{}', expected a number from 0 to {}", spec, view,
                                 scene.cameras.size() - 1));
  }
  return scaled_to(scene.cameras[view], options.width, options.height);
}

void bench_scene(const std::string& spec, const Options& options) {
  const Scene scene = load_bench_scene(spec);
  const Camera camera = camera_of(scene, spec, options);
  const ActivatedCloud cloud = activate(scene.cloud);
  const auto view = make_view<float>(camera);
  const Bench bench(scene.name, options);
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

// True if the text is a number from `least` to `most` and nothing else.
bool read_number(const std::string& text, int least, int most, int& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value >= least &&
         value <= most;
}

// Throws InputError.
int number_of(const std::string& option, const std::string& text, int least, int most) {
  int value = 0;
  if (!read_number(text, least, most, value)) {
    throw InputError(
        fmt::format("{}: got '{}', expected a number from {} to {}", option, text, least, most));
  }
  return value;
}

// Throws InputError.
void set_size(const std::string& text, Options& options) {
  const std::size_t cross = std::min(text.find('x'), text.size());
  if (!read_number(text.substr(0, cross), 1, kMaxSizePx, options.width) ||
      !read_number(text.substr(std::min(cross + 1, text.size())), 1, kMaxSizePx, options.height)) {
    throw InputError(
        fmt::format("--size: got '{}', expected WIDTHxHEIGHT, each 1 to {}", text, kMaxSizePx));
  }
}

// Takes the options before the scenes away from `words`. Throws InputError.
Options take_options(std::vector<std::string>& words) {
  Options options;
  while (words.size() >= 2 && words.front().rfind("--", 0) == 0) {
    const std::string option = words[0], text = words[1];
    if (option == "--threads") {
      options.threads = number_of(option, text, 1, kMaxThreads);
    } else if (option == "--size") {
      set_size(text, options);
    } else if (option == "--view") {
      options.view = number_of(option, text, 0, std::numeric_limits<int>::max());
    } else {
      throw InputError(
          fmt::format("got '{}', expected --threads, --size, --view or a scene", option));
    }
    words.erase(words.begin(), words.begin() + 2);
  }
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  return run_guarded("bench_renderers", [&] {
    std::vector<std::string> scenes(argv + 1, argv + argc);
    const Options options = take_options(scenes);
    if (scenes.empty()) {
      throw InputError("got no scene, expected bench_renderers [OPTION VALUE]... SCENE...");
    }
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(options.threads));
    fmt::print(
        "scene,view,renderer,finished below,threads,ms,cpu ms,beside,PSNR dB,largest,blends\n");
    for (const std::string& scene : scenes) bench_scene(scene, options);
    return kDone;
  });
}
