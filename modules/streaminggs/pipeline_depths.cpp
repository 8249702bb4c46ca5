// Schedules as configuration.
#include "modules/streaminggs/pipeline_depths.h"

#include <fmt/format.h>

#include <cmath>

#include "algorithm/files/input_error.h"
#include "modules/datapath/filter_flows.h"
#include "modules/datapath/rendering_flows.h"
#include "modules/streaminggs/hfu/filter_datapaths.h"
#include "modules/streaminggs/hfu/fine_filter.h"

namespace sgs {
namespace {

void take(const char* key, std::uint32_t& depth_cycles, std::uint32_t scheduled,
          const std::string& of, const LongestPath& path, const OperationLatencies& latencies,
          std::uint32_t beside, std::vector<AutoChoice>& chosen) {
  const std::uint32_t least = scheduled + beside;
  if (depth_cycles >= least) return;
  if (depth_cycles > 0) {
    throw InputError(
        fmt::format("{}: got {}, expected {} or more, the end of the schedule of {}, "
                    "or 0: that",
                    key, depth_cycles, least, of));
  }
  depth_cycles = least;
  std::string why = fmt::format(
      "schedule of {}; its longest path is {}: {} sums and {} products on lanes, {} on "
      "comparators, "
      "{} look-ups",
      of, path.cycles(latencies), path.lane, path.products, path.comparator, path.look_ups);
  if (path.reads > 0) why += fmt::format(", {} reads", path.reads);
  if (beside > 0) why += fmt::format("; {} beside", beside);
  chosen.push_back({ChoiceKind::kDerived, key, static_cast<double>(depth_cycles), std::move(why)});
}

}  // namespace

void resolve_depth(const char* key, std::uint32_t& depth_cycles, const Datapath& pipeline,
                   const LongestPath& path, const OperationLatencies& latencies,
                   std::uint32_t beside, std::vector<AutoChoice>& chosen) {
  take(key, depth_cycles, pipeline.depth_cycles,
       fmt::format("{} on {} lanes of {} cycles", pipeline.name, pipeline.lanes, latencies.lane),
       path, latencies, beside, chosen);
}

void resolve_rendering_depths(StreamingConfig& config, std::vector<AutoChoice>& chosen) {
  const OperationLatencies single = config.single_latencies(), half = config.half_latencies();
  RenderingConfig& rendering = config.rendering;
  const RenderingConfig part = rendering_of_part(config);
  const RenderingFlows flows = rendering_flows(rendering.precision);
  const bool in_half = in_16_bits(rendering.precision);
  const OperationLatencies& blending = in_half ? half : single;
  const std::uint32_t terms =
      config.splats == NumberFormat::kSingle ? 0 : terms_pipeline(single).depth_cycles;
  // The begun spans of a splat are written to its slot, and read for its first row.
  resolve_depth("rendering.begin_depth_cycles", rendering.begin_depth_cycles,
                begin_pipeline(part, single), flows.spans_begin.longest_path(single), single,
                terms + kWriteCycles + kReadCycles, chosen);
  resolve_depth("rendering.span_depth_cycles", rendering.span_depth_cycles,
                span_pipeline(part, single), flows.span.longest_path(single), single, 0, chosen);
  // The conic's lanes stand ahead of the queues: their latency comes on top.
  if (rendering.pixel_ports == 0) {
    rendering.pixel_ports = part.ports_of_pixels() == SramPorts::kOne ? 1 : 2;
    chosen.push_back({ChoiceKind::kDerived, "rendering.pixel_ports",
                      static_cast<double>(rendering.pixel_ports),
                      fmt::format("a cluster begins a sub-tile every {} cycles",
                                  part.cluster_interval_cycles())});
  }
  const Datapath blend = blend_pipeline(part, blending);
  const PixelWrites writes = pixel_writes(blend, part.ports_of_pixels());
  constexpr std::uint32_t kAccesses = kReadCycles + kWriteCycles;
  resolve_depth("rendering.depth_cycles", rendering.depth_cycles, blend,
                flows.subtile_blend.longest_path(blending), blending,
                terms + conic_pipeline(part, single).depth_cycles + writes.wait_cycles + kAccesses,
                chosen);
  take("rendering.state_loop_cycles", rendering.state_loop_cycles, writes.loop_cycles,
       "subtile_blend, from a pixel's state on",
       longest_loop(flows.subtile_blend.steps(blending), blending), blending, kAccesses, chosen);
  if (rendering.state_loop_cycles > rendering.depth_cycles) {
    throw InputError(
        fmt::format("rendering.state_loop_cycles: got {}, expected at most {}, "
                    "rendering.depth_cycles, of which "
                    "the loop is a part",
                    rendering.state_loop_cycles, rendering.depth_cycles));
  }
  resolve_depth("rendering.drain_depth_cycles", rendering.drain_depth_cycles,
                drain_pipeline(part, config.framebuffer, single),
                pixel_flow(config.framebuffer).longest_path(single), single, 0, chosen);
}

void resolve_filter_depths(StreamingConfig& config, const RecordSplit& split, int sh_degree,
                           std::vector<AutoChoice>& chosen) {
  const OperationLatencies single = config.single_latencies();
  const auto across = static_cast<std::uint32_t>(std::lround(std::sqrt(config.parts_of_group())));
  if (has_cfus(config.hfu, split.bound_by)) {
    resolve_depth(
        "hfu.cfu_depth_cycles", config.hfu.cfu_depth_cycles,
        coarse_pipeline(config.hfu, split.bound_by, config.parts_of_group(), single),
        coarse_flow(split.bound_by, longest_case(config.hfu.eyes), across).longest_path(single),
        single, kReadCycles, chosen);
  } else if (config.hfu.cfu_depth_cycles > 0) {
    throw InputError(fmt::format(
        "hfu.cfu_depth_cycles: got {} with hfu.coarse_filter=false, which has no CFUs, expected 0",
        config.hfu.cfu_depth_cycles));
  } else {
    config.hfu.cfu_depth_cycles = kReadCycles;
  }
  const std::uint32_t rounding = config.splats == NumberFormat::kSingle
                                     ? 0
                                     : rounding_pipeline(config.hfu, single).depth_cycles;
  resolve_depth("hfu.ffu_depth_cycles", config.hfu.ffu_depth_cycles,
                fine_pipeline(config.hfu, split.fine_record(sh_degree), single),
                fine_flow(longest_case(config.hfu.eyes), split.fine_record(sh_degree))
                    .all.longest_path(single),
                single, FineFilter::read_cycles(split.second_bytes) + rounding, chosen);
}

}  // namespace sgs
