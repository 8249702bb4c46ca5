// Longest paths as configuration.
#include "modules/streaminggs/pipeline_depths.h"

#include <fmt/format.h>

#include <cmath>

#include "algorithm/splat/filter_work.h"
#include "modules/streaminggs/hfu/fine_filter.h"

namespace sgs {
void resolve_depth(const char* key, std::uint32_t& depth_cycles, const LongestPath& path,
                   const OperationLatencies& latencies, std::uint32_t beside,
                   std::vector<AutoChoice>& chosen) {
  if (depth_cycles > 0) return;
  depth_cycles = path.cycles(latencies) + beside;
  std::string why = fmt::format("longest path: {} on lanes of {} cycles, {} on comparators, {} look-ups",
                                path.lane, latencies.lane, path.comparator, path.look_ups);
  if (beside > 0) why += fmt::format("; {} beside", beside);
  chosen.push_back({key, static_cast<double>(depth_cycles), std::move(why)});
}

void resolve_rendering_depths(StreamingConfig& config, std::vector<AutoChoice>& chosen) {
  const OperationLatencies single = config.single_latencies(), half = config.half_latencies();
  RenderingConfig& rendering = config.rendering;
  const RenderingPaths paths = rendering_paths(rendering.precision, single, half);
  const bool in_half = rendering.precision == BlendPrecision::kHalf;
  const OperationLatencies& blending = in_half ? half : single;
  resolve_depth("rendering.span_depth_cycles", rendering.span_depth_cycles, paths.spans, single, 0,
                chosen);
  // The conic's lanes stand ahead of the queues: what they take comes on top.
  resolve_depth("rendering.depth_cycles", rendering.depth_cycles, paths.blend, blending,
                paths.conic.cycles(single) + kReadCycles + kWriteCycles, chosen);
  resolve_depth("rendering.state_loop_cycles", rendering.state_loop_cycles, paths.state_loop,
                blending, kReadCycles + kWriteCycles, chosen);
  resolve_depth("rendering.drain_depth_cycles", rendering.drain_depth_cycles,
                pixel_path(config.framebuffer, single), single, 0, chosen);
}

void resolve_filter_depths(StreamingConfig& config, const RecordSplit& split, int sh_degree,
                           std::vector<AutoChoice>& chosen) {
  const OperationLatencies single = config.single_latencies();
  const auto across = static_cast<std::uint32_t>(std::lround(std::sqrt(config.parts())));
  resolve_depth("hfu.cfu_depth_cycles", config.hfu.cfu_depth_cycles,
                coarse_path(split.bound_by, longest_case(), across, single), single, kReadCycles, chosen);
  resolve_depth("hfu.ffu_depth_cycles", config.hfu.ffu_depth_cycles,
                fine_path(longest_case(), split.fine_record(sh_degree), single), single,
                FineFilter::read_cycles(split.second_bytes), chosen);
}

}  // namespace sgs
