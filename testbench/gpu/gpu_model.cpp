// Instructions are those of the released kernels, counted by hand to some ten per cent, loads and
// branches among them; bytes are what their arrays hold.
#include "testbench/gpu/gpu_model.h"

#include <algorithm>
#include <cmath>

#include "algorithm/render/tile_renderer.h"
#include "algorithm/splat/projection.h"

namespace sgs {

namespace {

// The original lists by the square of 3 sigma and skips nothing.
TileOrderConfig original() {
  TileOrderConfig config;
  config.rules = {TileReach::kThreeSigma, TileTest::kBox, 1};
  config.features = config.keys = NumberFormat::kSingle;
  config.precision = BlendPrecision::kSingle;
  config.chunk_entries = 256;  // a batch: one for each thread of a tile
  return config;
}

// Tiles of a Gaussian; -1: not in front.
std::int64_t tiles_of(const View<float>& view, const Gaussian<float>& g) {
  if (!(to_camera(view, g.mean).z > static_cast<float>(kNearPlane))) return -1;
  Splat splat;
  TileBoxes boxes;
  if (!make_tile_geometry(view, g, original().rules, splat, boxes)) return 0;
  return std::int64_t{boxes.tiles.width()} * boxes.tiles.height();
}

constexpr double kWarp = 32;
constexpr double kSector = 32;  // B, the least that comes from memory

// Instructions of one thread.
constexpr double kOfGaussian = 40;     // read, transformed, dropped
constexpr double kOfCovariance = 260;  // in 3D, in 2D, its inverse, radius, tiles
constexpr double kOfColourTerm = 6;    // per coefficient: three channels
constexpr double kOfPair = 12;         // its key, two stores
constexpr double kOfKey = 30;          // in a pass of the sort
constexpr double kOfRange = 8;
// Instructions of one warp.
constexpr double kOfEntry = 16;  // from shared memory, distance, exponent, test
constexpr double kOfBlend = 24;  // exponential, tests, colour, transmittance
constexpr double kOfFetch = 20;  // an entry of a batch, by one thread

// Arrays, B.
constexpr double kMean = 12, kShape = 12 + 16, kOpacity = 4, kCovariance = 24;
constexpr double kProjected =
    8 + 4 + 16 + 12 + 3;  // centre, depth, conic and opacity, colour, clamps
constexpr double kRadius = 4, kCount = 4;
constexpr double kKey = 8, kValue = 4, kPixel = 12 + 4 + 4;

double sh_terms(int degree) { return (degree + 1) * (degree + 1); }

// Passes of 8 bits over depth and as many bits as number the tiles.
double sort_passes(double tiles) {
  return std::ceil((32 + std::ceil(std::log2(std::max(tiles, 2.0)))) / 8);
}

GpuStage projection(const RasterWork& w) {
  const auto n = static_cast<double>(w.gaussians), front = static_cast<double>(w.in_front);
  const auto listed = static_cast<double>(w.listed);
  const double terms = sh_terms(w.sh_degree);
  GpuStage s{"projection", GpuPart::kProjection};
  s.instructions =
      (n * kOfGaussian + front * kOfCovariance + listed * 3 * kOfColourTerm * terms) / kWarp;
  s.scene_bytes = n * kMean + front * kShape + listed * (kOpacity + 12 * terms);
  s.intermediate_bytes = n * (kRadius + kCount) + front * kCovariance + listed * kProjected;
  return s;
}

GpuStage duplication(const RasterWork& w) {
  const auto n = static_cast<double>(w.gaussians), listed = static_cast<double>(w.listed);
  const auto pairs = static_cast<double>(w.pairs);
  GpuStage s{"duplication", GpuPart::kSorting};
  s.instructions = n / kWarp * kOfGaussian + static_cast<double>(w.pair_steps) * kOfPair;
  // Prefix sum, then who is listed, then keys and values.
  s.intermediate_bytes =
      n * (2 * kCount + kRadius) + listed * (kCount + 8 + 4) + pairs * (kKey + kValue);
  return s;
}

GpuStage sort(const RasterWork& w) {
  const auto pairs = static_cast<double>(w.pairs);
  const double passes = sort_passes(static_cast<double>(w.tiles));
  GpuStage s{"sort", GpuPart::kSorting};
  s.instructions = passes * pairs * kOfKey / kWarp;
  s.intermediate_bytes =
      pairs * (kKey + passes * 2 * (kKey + kValue));  // a histogram, then the passes
  return s;
}

GpuStage ranges(const RasterWork& w) {
  const auto pairs = static_cast<double>(w.pairs);
  GpuStage s{"ranges", GpuPart::kSorting};
  s.instructions = pairs * kOfRange / kWarp;
  s.intermediate_bytes = pairs * kKey + static_cast<double>(w.tiles) * 8;
  return s;
}

// Bytes that gathers fetch from memory: everything they touch once, and repeats that the cache does
// not hold.
double gathered(double requests, double distinct, double bytes_each, double cache_bytes) {
  const double footprint = distinct * bytes_each;
  const double held = std::min(1.0, cache_bytes / std::max(footprint, 1.0));
  const double once = std::min(requests, distinct);
  return bytes_each * (once + (requests - once) * (1 - held));
}

GpuStage rendering(const RasterWork& w, double cache_bytes) {
  const auto fetched = static_cast<double>(w.entries_fetched);
  const auto blends = static_cast<double>(w.warp_blends);
  GpuStage s{"rendering", GpuPart::kRendering};
  s.instructions = fetched / kWarp * kOfFetch + static_cast<double>(w.warp_entries) * kOfEntry +
                   blends * kOfBlend;
  // Centre, conic and colour lie in arrays of their own: a sector each.
  s.intermediate_bytes =
      fetched * kValue + gathered(fetched, static_cast<double>(w.listed), 3 * kSector, cache_bytes);
  s.frame_bytes = static_cast<double>(w.pixels) * kPixel;
  return s;
}

}  // namespace

RasterWork count_raster_work(const View<float>& view, const ActivatedCloud& cloud) {
  constexpr std::size_t kWarp = 32;
  RasterWork work;
  work.sh_degree = cloud.sh_degree;
  work.gaussians = cloud.size();
  for (std::size_t first = 0; first < cloud.size(); first += kWarp) {
    std::int64_t most = 0;
    for (std::size_t i = first; i < std::min(first + kWarp, cloud.size()); ++i) {
      const std::int64_t tiles = tiles_of(view, cloud.gaussians[i]);
      work.in_front += tiles >= 0 ? 1 : 0;
      work.listed += tiles > 0 ? 1 : 0;
      work.pairs += static_cast<std::uint64_t>(std::max<std::int64_t>(tiles, 0));
      most = std::max(most, tiles);
    }
    work.pair_steps += static_cast<std::uint64_t>(most);
  }
  const TileOrderConfig config = original();
  const TileStats stats = render_tiles(view, cloud, config).stats;
  const auto tiles = [](int px) { return (px + kTilePx - 1) / kTilePx; };
  work.tiles = static_cast<std::uint64_t>(tiles(view.width)) * tiles(view.height);
  work.pixels = static_cast<std::uint64_t>(view.width) * view.height;
  work.entries_fetched = stats.chunk_entries_taken;
  work.warp_entries = stats.warp_entries;
  work.warp_blends = stats.warp_blends;
  work.blends = stats.contributors;
  return work;
}

double GpuFrame::bytes() const {
  double sum = 0;
  for (const GpuStage& s : stages) sum += s.bytes();
  return sum;
}
double GpuFrame::bytes_of(GpuPart part) const {
  double sum = 0;
  for (const GpuStage& s : stages) sum += s.part == part ? s.bytes() : 0;
  return sum;
}
double GpuFrame::intermediate_bytes() const {
  double sum = 0;
  for (const GpuStage& s : stages) sum += s.intermediate_bytes;
  return sum;
}

GpuFrame model_gpu(const RasterWork& work, const GpuConfig& config) {
  GpuFrame frame;
  frame.stages = {projection(work), duplication(work), sort(work), ranges(work),
                  rendering(work, config.cache_mb * 1e6)};
  for (GpuStage& s : frame.stages) {
    const double by_instructions = s.instructions / config.instructions_a_second();
    const double by_bytes = s.bytes() / config.bytes_a_second();
    s.bound_by_bytes = by_bytes > by_instructions;
    s.seconds = std::max(by_instructions, by_bytes);
    frame.seconds += s.seconds;
  }
  frame.joules = frame.seconds * config.watts;
  return frame;
}

}  // namespace sgs
