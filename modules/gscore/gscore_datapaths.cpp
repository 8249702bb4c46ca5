// Counts and schedules.
#include "modules/gscore/gscore_datapaths.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <vector>

#include "modules/chunks/chunk_flows.h"
#include "modules/datapath/counted_datapath.h"
#include "modules/datapath/rendering_flows.h"
#include "modules/datapath/work_rates.h"
#include "modules/gscore/tile_flows.h"

namespace sgs::gscore {
namespace {

// Frame constants are the same for all copies: set once a frame.
void set_by_frame(Datapath& path, const std::vector<LaneStep>& steps) {
  path.set_bits = kSingleBits * constants_of(steps);
}

Datapath counted(const char* name, const char* component, const FlowPart& flow, std::uint32_t lanes,
                 const OperationLatencies& latencies) {
  Datapath path = counted_datapath(name, component, flow.counts());
  path.lanes = lanes;
  const std::vector<LaneStep> steps = flow.steps(latencies);
  schedule(path, steps, latencies);
  set_by_frame(path, steps);
  return path;
}

// An opacity that lies in two places is counted from the least one on, and back.
void count_opacity(Datapath& path, const GscoreConfig& config) {
  if (config.tiles.features == NumberFormat::kSingle) ++path.part_of("adder").operations;
}

Datapath convert_of_degree(const GscoreConfig& config, int sh_degree) {
  const RecordSplit split =
      split_of(config.storage_order(), {SecondHalfEncoding::kRaw, sh_degree, {}});
  const FlowPart flow = convert_flow(config.tiles.rules(), split.fine_record(sh_degree),
                                     config.tiles.features == NumberFormat::kHalf, config.eyes);
  Datapath path = counted("convert", "ccu", flow, config.ccu.convert_lanes, config.single());
  count_opacity(path, config);  // both eyes have the same
  return path;
}

// True if the lanes of blending take a record's numbers as they are stored.
bool blends_its_records(const GscoreConfig& config) {
  return config.tiles.features == NumberFormat::kHalf && in_16_bits(config.rendering.precision);
}

FlowPart blend_flow(const GscoreConfig& config) {
  if (blends_its_records(config)) return blend_of_halves_flow();
  return rendering_flows(config.rendering.precision).blend_from_corner;
}

// Of 16 pixels; what it hangs on changes their number.
std::uint32_t blend_macs(const GscoreConfig& config) {
  static std::map<std::pair<BlendPrecision, NumberFormat>, std::uint32_t> known;
  const auto [at, is_new] = known.try_emplace({config.rendering.precision, config.tiles.features});
  if (is_new) at->second = folded_macs(blend_flow(config).counts());
  return at->second;
}

// Lanes of a core that also convert finished pixels, in whichever format.
std::uint32_t lanes_that_drain(const GscoreConfig& config) {
  static const std::uint32_t macs = folded_macs(pixel_flow(FrameFormat::kRgb8).counts());
  return config.rendering.drain_pixels_per_cycle * macs;
}
constexpr std::uint32_t kOperandBits = 3 * kSingleBits;  // of a lane

}  // namespace

std::uint64_t blend_interval(const GscoreConfig& config) {
  const std::uint32_t lanes = config.rendering.core_lanes;
  return lanes == 0 ? 1 : cycles_for(blend_macs(config), lanes);
}

bool shares_pixel_memories(const GscoreConfig& config) {
  return config.rendering.pixel_buffers > 1 && blend_interval(config) > 1;
}

SramPorts ports_of_pixels(const GscoreConfig& config) {
  const bool one = config.rendering.pixel_buffers == 1 && blend_interval(config) > 1;
  return one ? SramPorts::kOne : SramPorts::kReadAndWrite;
}

bool drains_on_lanes(const GscoreConfig& config) {
  return config.rendering.pixel_buffers == 1 && !in_16_bits(config.rendering.precision) &&
         (config.rendering.core_lanes == 0 ||
          lanes_that_drain(config) <= config.rendering.core_lanes);
}

std::uint64_t drain_row_cycles(const GscoreConfig& config, std::uint32_t px) {
  const std::uint64_t at_once = cycles_for(px, config.rendering.drain_pixels_per_cycle);
  if (shares_pixel_memories(config)) return at_once * blend_interval(config);
  const std::uint64_t accesses = ports_of_pixels(config) == SramPorts::kOne ? 2 : 1;
  return std::max(at_once, accesses * cycles_for(px, kSubtilePx));
}

Datapath chunk_test_pipeline(const GscoreConfig& config) {
  return counted("chunk_test", "culler", chunk_culling_flow(longest_chunk_case(config.eyes)),
                 config.culling.test_lanes, config.single());
}

Datapath cull_pipeline(const GscoreConfig& config) {
  return counted("cull", "ccu", cull_flow(config.eyes), config.ccu.cull_lanes, config.single());
}

// Scheduling takes longest of all, and every CCU, the budget and the report ask.
Datapath convert_pipeline(const GscoreConfig& config, int sh_degree) {
  using Key = std::tuple<StorageOrder, TileReach, TileTest, int, NumberFormat, std::uint32_t,
                         std::uint32_t, int, std::uint32_t>;
  static std::map<Key, Datapath> known;
  const TilesConfig& tiles = config.tiles;
  const Key key{config.storage_order(),     tiles.reach,    tiles.test,
                tiles.subtiles_across,      tiles.features, config.ccu.convert_lanes,
                config.lane_latency_cycles, sh_degree,      config.eyes};
  if (const auto at = known.find(key); at != known.end()) return at->second;
  Datapath path = convert_of_degree(config, sh_degree);
  for (int degree = 0; degree <= kMostDegree; ++degree) {
    if (degree != sh_degree) path.build_also_for(convert_of_degree(config, degree));
  }
  known.emplace(key, path);
  return path;
}

Datapath tile_test_pipeline(const GscoreConfig& config) {
  return counted("tile_test", "lists", tile_test_flow(static_cast<int>(config.lists.tiles_at_once)),
                 config.lists.tile_lanes, config.single());
}

Datapath part_test_pipeline(const GscoreConfig& config) {
  return counted("part_test", "lists", part_test_flow(config.tiles.rules()),
                 config.lists.part_lanes, config.single());
}

// A splat that is blended takes a turn for each block of a part at least, so that lanes for that
// pace suffice. Ahead of them the halves of its record are widened.
std::optional<Datapath> conic_pipeline(const GscoreConfig& config) {
  if (blends_its_records(config)) return std::nullopt;
  const bool of_halves = config.tiles.features == NumberFormat::kHalf;
  constexpr std::uint32_t kHalves = 7, kOfConic = 3;
  const FlowPart flow =
      of_halves ? terms_of_square_flow() : rendering_flows(config.rendering.precision).conic;
  Datapath path = counted_datapath("conic", "rendering", flow.counts());
  if (of_halves) {
    path.part_of("conversion").operations += kHalves;
    path.part_of("adder").operations += kOfConic;
  }
  count_opacity(path, config);
  const int across = kSubtilesPerTile / config.tiles.subtiles_across;
  const std::uint64_t turn = static_cast<std::uint64_t>(across * across) * blend_interval(config);
  path.lanes = static_cast<std::uint32_t>(cycles_for(path.used_macs, turn));
  schedule(path, flow.steps(config.single()), config.single());
  return path;
}

// The block's first pixel comes as two whole numbers.
Datapath corner_pipeline(const GscoreConfig& config) {
  const FlowPart flow = rendering_flows(BlendPrecision::kSingle).corner;
  Datapath path = counted_datapath("corner", "rendering", flow.counts());
  path.part_of("conversion").operations += 2;
  path.lanes = static_cast<std::uint32_t>(cycles_for(path.used_macs, blend_interval(config)));
  schedule(path, flow.steps(config.single()), config.single());
  return path;
}

Datapath blend_pipeline(const GscoreConfig& config) {
  const bool in_half = in_16_bits(config.rendering.precision);
  const FlowPart flow = blend_flow(config);
  Datapath path = counted_datapath("blend", "rendering", flow.counts(),
                                   in_half ? NumberFormat::kHalf : NumberFormat::kSingle);
  path.lanes = config.rendering.core_lanes > 0 ? config.rendering.core_lanes : path.used_macs;
  schedule(path, flow.steps(config.blending()), config.blending(),
           in_half ? kHalfBits : kSingleBits);
  ask_where_alpha_passes(path);
  if (drains_on_lanes(config)) {
    // Before the operands of a lane that also converts pixels.
    const std::uint32_t lanes = lanes_that_drain(config);
    path.between.multiplexers += kOperandBits * lanes;
    path.between.selected += kOperandBits * static_cast<std::uint32_t>(cycles_for(
                                                std::uint64_t{path.used_macs} * lanes, path.lanes));
  }
  return path;
}

// Colour and transmittance of pixels in halves are widened first. Lanes of their own have a turn as
// long as the blend's where pixels come once in that.
Datapath drain_pipeline(const GscoreConfig& config) {
  const FlowPart flow = pixel_flow(config.framebuffer);
  Datapath path = counted_datapath("drain", "rendering", flow.counts());
  constexpr std::uint32_t kOfPixel = 4;
  if (in_16_bits(config.rendering.precision)) {
    path.part_of("conversion").operations += kOfPixel;
  }
  const std::uint64_t turn = shares_pixel_memories(config) ? blend_interval(config) : 1;
  path.lanes = static_cast<std::uint32_t>(cycles_for(path.used_macs, turn));
  path.copies = config.rendering.drain_pixels_per_cycle;
  schedule(path, flow.steps(config.single()), config.single());
  if (drains_on_lanes(config)) {
    path.lanes_of = "blend";
    path.between.selected += kOperandBits * path.used_macs;
  }
  return path;
}

}  // namespace sgs::gscore
