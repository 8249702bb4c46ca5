// Keys of the rendering unit, and the lanes that follow from them.
#pragma once

#include <cstdint>

#include "algorithm/memory/frame_buffer.h"
#include "algorithm/splat/blend.h"
#include "modules/config/config_visitor.h"
#include "modules/datapath/lane_steps.h"
#include "tlm/datapath.h"
#include "tlm/sram_use.h"

namespace sgs {

struct RenderingConfig {
  std::uint32_t clusters = 4;
  std::uint32_t cluster_lanes = 167;
  BlendPrecision precision = BlendPrecision::kSingle;
  std::uint32_t cluster_queue_entries = 8;
  std::uint32_t depth_cycles = 0;
  std::uint32_t state_loop_cycles = 0;
  std::uint32_t begin_depth_cycles = 0;
  std::uint32_t span_depth_cycles = 0;
  std::uint32_t drain_depth_cycles = 0;
  std::uint32_t pixel_buffers = 2;
  std::uint32_t pixel_ports = 2;
  std::uint32_t drain_pixels_per_cycle = 8;
  bool drain_on_clusters = false;
  bool ellipse_test = true;
  std::uint32_t begin_lanes = 24, span_lanes = 40;
  std::uint32_t span_slots = 16;
  bool saturation_feedback = true;
  // Latency of the feedback: a register where it leaves, a wire over at most the side of the die, a
  // register where it arrives. The wire (2.5 mm) takes below a cycle at 32 nm.
  std::uint32_t feedback_latency_cycles = 2;
  std::uint32_t input_fifo_entries = 8;

  // A cluster starts a sub-tile every so many cycles.
  std::uint32_t cluster_interval_cycles() const;
  // Cycles from one splat's beginning to the next one's.
  std::uint32_t begin_interval_cycles() const;
  // Rows that begin at once, and cycles from these to the next: several a cycle, or one in several.
  std::uint32_t spans_at_once() const;
  std::uint32_t span_interval_cycles() const;
  // Sub-tiles of one cluster that can be in the loop through the pixel state at once.
  std::uint32_t subtiles_in_loop() const;
  // With one port a cluster reads a pixel in one cycle of its turn, and writes it in another.
  SramPorts ports_of_pixels() const;
  // Finished pixels are converted on the clusters' lanes.
  bool drains_on_clusters() const;
  // Cycles from a row of pixels of so many sub-tiles to the next, in draining: a port gives one
  // word a cycle, or clears the one that it gave before.
  std::uint32_t drain_row_cycles(std::uint32_t px) const;
  // Bytes of state a pixel: R, G, B and transmittance.
  std::uint32_t pixel_state_bytes() const { return in_16_bits(precision) ? 8 : 16; }
};

inline void visit(ConfigVisitor& v, RenderingConfig& c) {
  v("clusters", c.clusters, in_range(1, 256),
    "blend a 4x4 sub-tile at a time each; a bank each holds the pixels of its sub-tiles");
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
  v("pixel_buffers", c.pixel_buffers, in_range(1, 2),
    "groups whose pixels are on chip; 2: one drains while the next is blended");
  v("pixel_ports", c.pixel_ports, in_range(0, 2),
    "of a memory of pixels; 2: a read and a write a cycle; 1: in different cycles of a sub-tile; "
    "0: 1 where a cluster takes several cycles for one");
  v("drain_pixels_per_cycle", c.drain_pixels_per_cycle, in_range(1, 4096),
    "finished pixels converted a cycle");
  v("drain_on_clusters", c.drain_on_clusters,
    "on the clusters' MAC lanes, where these are enough and idle meanwhile: with one pixel buffer, "
    "in single precision");
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

// Throws InputError: a port that would be wanted twice in a cycle.
void check(const RenderingConfig& config);

// Counted by running the code (modules/datapath/rendering_flows.h): the lanes that every splat
// passes ahead of the clusters' queues, one a cycle; the lanes of all clusters, an item a sub-tile;
// those that begin a splat's spans, an item a splat; those of its rows. Scheduled on lanes of these
// latencies.
Datapath conic_pipeline(const RenderingConfig& config, const OperationLatencies& single);
// Ahead of all these, where splats come in halves: a splat a cycle.
Datapath terms_pipeline(const OperationLatencies& single);
Datapath blend_pipeline(const RenderingConfig& config, const OperationLatencies& latencies);
Datapath begin_pipeline(const RenderingConfig& config, const OperationLatencies& single);
Datapath span_pipeline(const RenderingConfig& config, const OperationLatencies& single);
// An item a finished pixel: as many lanes as drain_pixels_per_cycle of them take.
Datapath drain_pipeline(const RenderingConfig& config, FrameFormat format,
                        const OperationLatencies& single);

}  // namespace sgs
