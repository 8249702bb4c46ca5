// Lanes and latencies of the rendering unit.
#include "modules/streaminggs/rendering/rendering_config.h"

#include <algorithm>

#include "algorithm/splat/rendering_work.h"
#include "modules/datapath/counted_datapath.h"
#include "modules/datapath/scheduled_datapath.h"
#include "modules/datapath/work_rates.h"

namespace sgs {

namespace {

struct Counted {
  explicit Counted(BlendPrecision precision)
      : work(rendering_work(precision)),
        blend_macs(folded_macs(work.subtile_blend)),
        span_macs(folded_macs(work.span)) {}
  RenderingWork work;
  std::uint32_t blend_macs, span_macs;
};

const Counted& counted(BlendPrecision precision) {
  static const Counted single(BlendPrecision::kSingle), half(BlendPrecision::kHalf);
  return in_16_bits(precision) ? half : single;
}

// Without schedule.
Datapath begin_datapath(const RenderingConfig& config) {
  Datapath path =
      counted_datapath("spans_begin", "rendering", counted(config.precision).work.spans_begin);
  path.lanes = config.begin_lanes;
  return path;
}
Datapath span_datapath(const RenderingConfig& config) {
  Datapath path = counted_datapath("row_span", "rendering", counted(config.precision).work.span);
  path.copies = config.spans_at_once();
  path.lanes = config.span_lanes / path.copies;
  return path;
}

}  // namespace

Datapath conic_pipeline(const RenderingConfig& config, const OperationLatencies& single) {
  Datapath path = counted_datapath("conic", "rendering", counted(config.precision).work.conic);
  path.lanes = path.used_macs;
  schedule(path, conic_steps(config.precision, single), single);
  return path;
}

Datapath blend_pipeline(const RenderingConfig& config, const OperationLatencies& latencies) {
  const OperationCounts& work = counted(config.precision).work.subtile_blend;
  const bool in_half = in_16_bits(config.precision);
  Datapath path = counted_datapath("subtile_blend", "rendering", work,
                                   in_half ? "exp2_table_half" : "exp2_table");
  if (in_half) path.lane = "fp16_lane";
  path.lanes = config.cluster_lanes;
  path.copies = config.clusters;
  schedule(path, blend_steps(config.precision, latencies), latencies,
           in_half ? kHalfBits : kSingleBits);
  return path;
}

Datapath begin_pipeline(const RenderingConfig& config, const OperationLatencies& single) {
  Datapath path = begin_datapath(config);
  schedule(path, spans_begin_steps(single), single);
  return path;
}

// The edge above a row is that of the row before it, or of the beginning: three words selected.
Datapath span_pipeline(const RenderingConfig& config, const OperationLatencies& single) {
  constexpr std::uint32_t kEdgeBits = 3 * kSingleBits;
  Datapath path = span_datapath(config);
  schedule(path, span_steps(single), single);
  path.between.multiplexers += kEdgeBits;
  path.between.selected += kEdgeBits;
  return path;
}

Datapath drain_pipeline(const RenderingConfig& config, FrameFormat format,
                        const OperationLatencies& single) {
  Datapath path = counted_datapath("drain", "rendering", pixel_work(format));
  path.lanes = path.used_macs;
  path.copies = config.drain_pixels_per_cycle;
  schedule(path, pixel_steps(format, single), single);
  return path;
}

std::uint32_t RenderingConfig::cluster_interval_cycles() const {
  return static_cast<std::uint32_t>(cycles_for(counted(precision).blend_macs, cluster_lanes));
}

std::uint32_t RenderingConfig::begin_interval_cycles() const {
  return static_cast<std::uint32_t>(begin_datapath(*this).interval_cycles());
}

std::uint32_t RenderingConfig::spans_at_once() const {
  return std::max(1U, span_lanes / counted(precision).span_macs);
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

}  // namespace sgs
