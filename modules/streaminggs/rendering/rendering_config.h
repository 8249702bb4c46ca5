// Parameters of the rendering unit.
#pragma once

#include <cstdint>

#include "algorithm/memory/frame_buffer.h"
#include "algorithm/splat/blend.h"
#include "modules/config/config_visitor.h"
#include "modules/datapath/lane_steps.h"
#include "tlm/datapath.h"

namespace sgs {

struct RenderingConfig {
  std::uint32_t clusters = 4;         // each holds the pixels of its sub-tiles in a bank of its own
  std::uint32_t cluster_lanes = 190;  // multiply-accumulates of one cluster: a sub-tile a cycle
  BlendPrecision precision = BlendPrecision::kSingle;  // of blending and of the pixels on chip
  std::uint32_t cluster_queue_entries = 8;             // sub-tiles waiting for each cluster
  // Of a blend, from a splat's conic to the pixel written. Depths of 0: by schedules.
  std::uint32_t depth_cycles = 0;
  // Of these from reading a pixel to having it written: a splat behind another on the same sub-tile
  // waits as long.
  std::uint32_t state_loop_cycles = 0;
  std::uint32_t begin_depth_cycles = 0;  // of the beginning of a splat's spans
  std::uint32_t span_depth_cycles = 0;   // of a row's span
  std::uint32_t drain_depth_cycles = 0;  // of a finished pixel's conversion
  std::uint32_t pixel_buffers = 2;       // groups whose pixels are on chip; 2: drain while blending
  std::uint32_t drain_pixels_per_cycle = 8;  // conversion to the frame's format
  bool ellipse_test = true;                  // skips sub-tiles that the ellipse cannot reach
  // Multiply-accumulates that begin a splat's spans, and that give its rows theirs.
  std::uint32_t begin_lanes = 24, span_lanes = 40;
  std::uint32_t span_slots = 16;    // splats that have begun and are not dispatched yet
  bool saturation_feedback = true;  // a finished group's visits are dropped upstream
  // A register where it leaves, a wire over at most the side of the die (2.5 mm, below a cycle at
  // 32 nm), a register where it arrives.
  std::uint32_t feedback_latency_cycles = 2;
  std::uint32_t input_fifo_entries = 8;  // sorted splats waiting, for each sorting unit

  // A cluster starts a sub-tile every so many cycles.
  std::uint32_t cluster_interval_cycles() const;
  // From one splat's beginning to the next one's.
  std::uint32_t begin_interval_cycles() const;
  // Rows that begin at once, and from these to the next: several a cycle, or one in several.
  std::uint32_t spans_at_once() const;
  std::uint32_t span_interval_cycles() const;
  // Sub-tiles of one cluster that can be in the loop through the pixel state at once.
  std::uint32_t subtiles_in_loop() const;
  // From a row of pixels of so many sub-tiles to the next, in draining: a bank gives one word a
  // cycle.
  std::uint32_t drain_row_cycles(std::uint32_t px) const;
  // Bytes of state a pixel: R, G, B and transmittance.
  std::uint32_t pixel_state_bytes() const { return in_16_bits(precision) ? 8 : 16; }
};

// Counted by running the code (modules/datapath/rendering_flows.h): the lanes that every splat
// passes ahead of the clusters' queues, one a cycle; the lanes of all clusters, an item a sub-tile;
// those that begin a splat's spans, an item a splat; those of its rows. Scheduled on lanes of these
// latencies.
Datapath conic_pipeline(const RenderingConfig& config, const OperationLatencies& single);
Datapath blend_pipeline(const RenderingConfig& config, const OperationLatencies& latencies);
Datapath begin_pipeline(const RenderingConfig& config, const OperationLatencies& single);
Datapath span_pipeline(const RenderingConfig& config, const OperationLatencies& single);
// An item a finished pixel: as many lanes as drain_pixels_per_cycle of them take.
Datapath drain_pipeline(const RenderingConfig& config, FrameFormat format,
                        const OperationLatencies& single);

void visit(ConfigVisitor& v, RenderingConfig& config);

}  // namespace sgs
