// Keys of the rendering unit.
#include "modules/streaminggs/rendering/rendering_config.h"

#include <algorithm>

#include "modules/datapath/counted_datapath.h"
#include "modules/datapath/rendering_flows.h"
#include "modules/datapath/work_rates.h"

namespace sgs {

namespace {

struct Counted {
  explicit Counted(BlendPrecision precision)
      : flows(rendering_flows(precision)),
        conic(flows.conic.counts()),
        spans_begin(flows.spans_begin.counts()),
        span(flows.span.counts()),
        subtile_blend(flows.subtile_blend.counts()) {}
  RenderingFlows flows;
  OperationCounts conic, spans_begin, span, subtile_blend;
};

const Counted& counted(BlendPrecision precision) {
  static const Counted single(BlendPrecision::kSingle), half(BlendPrecision::kHalf);
  return in_16_bits(precision) ? half : single;
}

// Without schedule.
Datapath begin_datapath(const RenderingConfig& config) {
  Datapath path =
      counted_datapath("spans_begin", "rendering", counted(config.precision).spans_begin);
  path.lanes = config.begin_lanes;
  return path;
}
Datapath span_datapath(const RenderingConfig& config) {
  Datapath path = counted_datapath("row_span", "rendering", counted(config.precision).span);
  path.copies = config.spans_at_once();
  path.lanes = config.span_lanes / path.copies;
  return path;
}

}  // namespace

Datapath conic_pipeline(const RenderingConfig& config, const OperationLatencies& single) {
  Datapath path = counted_datapath("conic", "rendering", counted(config.precision).conic);
  path.lanes = path.used_macs;
  schedule(path, counted(config.precision).flows.conic.steps(single), single);
  return path;
}

Datapath blend_pipeline(const RenderingConfig& config, const OperationLatencies& latencies) {
  const OperationCounts& work = counted(config.precision).subtile_blend;
  const bool in_half = in_16_bits(config.precision);
  Datapath path = counted_datapath("subtile_blend", "rendering", work,
                                   in_half ? "exp2_table_half" : "exp2_table");
  if (in_half) path.lane = "fp16_lane";
  path.lanes = config.cluster_lanes;
  path.copies = config.clusters;
  schedule(path, counted(config.precision).flows.subtile_blend.steps(latencies), latencies,
           in_half ? kHalfBits : kSingleBits);
  return path;
}

Datapath begin_pipeline(const RenderingConfig& config, const OperationLatencies& single) {
  Datapath path = begin_datapath(config);
  schedule(path, counted(config.precision).flows.spans_begin.steps(single), single);
  return path;
}

// The edge above a row is that of the row before it, or of the beginning: three words selected.
Datapath span_pipeline(const RenderingConfig& config, const OperationLatencies& single) {
  constexpr std::uint32_t kEdgeBits = 3 * kSingleBits;
  Datapath path = span_datapath(config);
  schedule(path, counted(config.precision).flows.span.steps(single), single);
  path.between.multiplexers += kEdgeBits;
  path.between.selected += kEdgeBits;
  return path;
}

Datapath drain_pipeline(const RenderingConfig& config, FrameFormat format,
                        const OperationLatencies& single) {
  Datapath path = counted_datapath("drain", "rendering", pixel_flow(format).counts());
  path.lanes = path.used_macs;
  path.copies = config.drain_pixels_per_cycle;
  schedule(path, pixel_flow(format).steps(single), single);
  return path;
}

std::uint32_t RenderingConfig::cluster_interval_cycles() const {
  return static_cast<std::uint32_t>(
      cycles_for(folded_macs(counted(precision).subtile_blend), cluster_lanes));
}

std::uint32_t RenderingConfig::begin_interval_cycles() const {
  return static_cast<std::uint32_t>(begin_datapath(*this).interval_cycles());
}

std::uint32_t RenderingConfig::spans_at_once() const {
  return std::max(1U, span_lanes / folded_macs(counted(precision).span));
}

std::uint32_t RenderingConfig::span_interval_cycles() const {
  return static_cast<std::uint32_t>(span_datapath(*this).interval_cycles());
}

std::uint32_t RenderingConfig::subtiles_in_loop() const {
  return static_cast<std::uint32_t>(cycles_for(state_loop_cycles, cluster_interval_cycles()));
}

std::uint32_t RenderingConfig::drain_row_cycles(std::uint32_t px) const {
  const std::uint64_t subtiles = cycles_for(px, kSubtilePx);
  return static_cast<std::uint32_t>(
      std::max(cycles_for(px, drain_pixels_per_cycle), cycles_for(subtiles, clusters)));
}

void visit(ConfigVisitor& v, RenderingConfig& c) {
  v("clusters", c.clusters, in_range(1, 256), "blend a 4x4 sub-tile at a time each");
  v("cluster_lanes", c.cluster_lanes, in_range(1, 4096),
    "MAC lanes of one cluster: how often it starts a sub-tile follows");
  v("precision", c.precision,
    names<BlendPrecision>({{"fp32", BlendPrecision::kSingle},
                           {"fp16", BlendPrecision::kHalf},
                           {"fixed16", BlendPrecision::kFixed}}),
    "of blending and of the pixels on chip");
  v("cluster_queue_entries", c.cluster_queue_entries, in_range(1, 1024),
    "sub-tiles waiting for each cluster");
  v("state_loop_cycles", c.state_loop_cycles, in_range(0, 1000),
    "until the next splat may be blended into the same sub-tile; 0: by its schedule");
  v("depth_cycles", c.depth_cycles, in_range(0, 1000),
    "latency of a blend, by which drain and news of a finished group come later; 0: by its "
    "schedule");
  v("begin_depth_cycles", c.begin_depth_cycles, in_range(0, 1000),
    "latency of the beginning of a splat's spans; 0: by its schedule");
  v("span_depth_cycles", c.span_depth_cycles, in_range(0, 1000),
    "latency of a row's span; 0: by its schedule");
  v("drain_depth_cycles", c.drain_depth_cycles, in_range(0, 1000),
    "latency of a finished pixel's conversion; 0: by its schedule");
  v("pixel_buffers", c.pixel_buffers, in_range(1, 2), "groups whose pixels are on chip");
  v("drain_pixels_per_cycle", c.drain_pixels_per_cycle, in_range(1, 4096),
    "finished pixels converted a cycle");
  v("ellipse_test", c.ellipse_test, "sub-tiles that a splat's ellipse cannot reach are skipped");
  v("begin_lanes", c.begin_lanes, in_range(1, 4096),
    "MAC lanes that begin to find the sub-tiles of an ellipse");
  v("span_lanes", c.span_lanes, in_range(1, 4096),
    "MAC lanes that go on with it row by row, several rows at once where they are enough");
  v("span_slots", c.span_slots, in_range(1, 1024),
    "splats whose spans are under way or wait for the dispatcher");
  v("feedback_latency_cycles", c.feedback_latency_cycles, in_range(1, 1000),
    "until VSU and HFUs see that a group is finished");
  v("saturation_feedback", c.saturation_feedback, "a finished group's visits are dropped upstream");
  v("input_fifo_entries", c.input_fifo_entries, in_range(1, 4096),
    "sorted splats waiting from each sorting unit");
}

}  // namespace sgs
