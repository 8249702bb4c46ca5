// Lanes and latencies of the rendering unit.
#include "modules/streaminggs/rendering/rendering_config.h"

#include <fmt/format.h>

#include <algorithm>

#include "algorithm/files/input_error.h"
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

// Lanes of the clusters that also convert finished pixels, in whichever format.
std::uint32_t lanes_that_drain(const RenderingConfig& config) {
  static const std::uint32_t macs = folded_macs(pixel_flow(FrameFormat::kRgb8).counts());
  return config.drain_pixels_per_cycle * macs;
}
constexpr std::uint32_t kOperandBits = 3 * kSingleBits;  // of a lane

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

// Seven halves are widened, three of them in units of their own.
Datapath terms_pipeline(const OperationLatencies& single) {
  constexpr std::uint32_t kHalves = 7, kOfConic = 3;
  const FlowPart flow = conic_terms_flow();
  Datapath path = counted_datapath("conic_terms", "rendering", flow.counts());
  path.part_of("conversion").operations += kHalves;
  path.part_of("adder").operations += kOfConic;
  path.lanes = path.used_macs;
  schedule(path, flow.steps(single), single);
  return path;
}

Datapath blend_pipeline(const RenderingConfig& config, const OperationLatencies& latencies) {
  const OperationCounts& counts = counted(config.precision).subtile_blend;
  const bool in_half = in_16_bits(config.precision);
  Datapath path = counted_datapath("subtile_blend", "rendering", counts,
                                   in_half ? NumberFormat::kHalf : NumberFormat::kSingle);
  path.lanes = config.cluster_lanes;
  path.copies = config.clusters;
  schedule(path, counted(config.precision).flows.subtile_blend.steps(latencies), latencies,
           in_half ? kHalfBits : kSingleBits);
  ask_where_alpha_passes(path);
  if (config.drains_on_clusters()) {
    // Before the operands of a lane that also converts pixels.
    const auto lanes =
        static_cast<std::uint32_t>(cycles_for(lanes_that_drain(config), config.clusters));
    path.between.multiplexers += kOperandBits * lanes;
    path.between.selected += kOperandBits * static_cast<std::uint32_t>(cycles_for(
                                                std::uint64_t{path.used_macs} * lanes, path.lanes));
  }
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
  if (config.drains_on_clusters()) {
    path.lanes_of = "subtile_blend";
    path.between.selected += kOperandBits * path.used_macs;
  }
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
  const std::uint64_t accesses = ports_of_pixels() == SramPorts::kOne ? 2 : 1;
  return static_cast<std::uint32_t>(
      std::max(cycles_for(px, drain_pixels_per_cycle), accesses * cycles_for(subtiles, clusters)));
}

SramPorts RenderingConfig::ports_of_pixels() const {
  const bool one = pixel_ports == 1 || (pixel_ports == 0 && cluster_interval_cycles() > 1);
  return one ? SramPorts::kOne : SramPorts::kReadAndWrite;
}

bool RenderingConfig::drains_on_clusters() const {
  return drain_on_clusters && pixel_buffers == 1 && !in_16_bits(precision) &&
         lanes_that_drain(*this) <= std::uint64_t{clusters} * cluster_lanes;
}

void check(const RenderingConfig& c) {
  if (c.pixel_ports != 1 || c.cluster_interval_cycles() > 1) return;
  throw InputError(
      fmt::format("rendering.pixel_ports: got 1 with rendering.cluster_lanes {}, expected 2: a "
                  "sub-tile begins in every cycle",
                  c.cluster_lanes));
}

}  // namespace sgs
