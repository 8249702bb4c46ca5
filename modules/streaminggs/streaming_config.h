// Parameters of a streaming machine of either order; the defaults are the paper's
// (StreamingGS, DAC 2025) or, where it leaves a parameter open, stated with a reason.
#pragma once

#include <cstdint>

#include "algorithm/memory/frame_buffer.h"
#include "algorithm/memory/number_format.h"
#include "algorithm/memory/splat_record.h"
#include "algorithm/memory/storage_config.h"
#include "algorithm/splat/constants.h"
#include "modules/config/config_visitor.h"
#include "modules/datapath/lane_steps.h"
#include "modules/streaminggs/built_for.h"
#include "modules/streaminggs/hfu/codebook_config.h"
#include "modules/streaminggs/hfu/hfu_config.h"
#include "modules/streaminggs/rendering/rendering_config.h"
#include "tlm/memory_port.h"

namespace sgs {

struct SramConfig {
  std::uint32_t input_bytes;
  std::uint32_t codebook_bytes;
  std::uint32_t shared_bytes;
};

inline void visit(ConfigVisitor& v, SramConfig& c) {
  v("input_bytes", c.input_bytes, in_range(0, 1 << 30),
    "input buffer of all HFUs, first halves; 0: as large as the other parameters need");
  v("codebook_bytes", c.codebook_bytes, in_range(0, 1 << 30),
    "codebook buffer, idle unless second halves are quantised");
  v("shared_bytes", c.shared_bytes, in_range(0, 1 << 30),
    "everything between the stages; 0: as large as the other parameters need");
}

// Way in which the HFUs' Gaussians are fetched.
enum class Fetch {
  kShared,  // one fetch feeds all: each HFU tests every Gaussian against its part of the group
  kSplit    // each HFU fetches its share of a visit and tests it against the whole group
};

struct StreamingConfig {
  double clock_mhz = 1000;
  std::uint32_t lane_latency_cycles = 3;
  std::uint32_t half_lane_latency_cycles = 2;
  std::uint32_t group_width_px = 32, group_height_px = 32;
  FrameFormat framebuffer = FrameFormat::kRgb8;
  std::uint32_t hfus = 4;
  Fetch fetch = Fetch::kSplit;                  // a key of paper order
  NumberFormat splats = NumberFormat::kSingle;  // likewise
  std::uint32_t sorting_units = 2;
  SramConfig sram{};
  HfuConfig hfu;
  CodebookConfig codebook;
  RenderingConfig rendering;
  MemoryPortConfig memory_port;

  OperationLatencies single_latencies() const { return {lane_latency_cycles, 1, 1}; }
  OperationLatencies half_latencies() const { return {half_lane_latency_cycles, 1, 1}; }
  bool group_open() const { return group_width_px == 0 && group_height_px == 0; }
  PixelSize group() const {
    return {static_cast<int>(group_width_px), static_cast<int>(group_height_px)};
  }
  void set_group(const PixelSize& group) {
    group_width_px = static_cast<std::uint32_t>(group.width);
    group_height_px = static_cast<std::uint32_t>(group.height);
  }
  // HFUs behind one fetch, each with its part of a group; and how many fetches there are.
  std::uint32_t parts_of_group() const { return fetch == Fetch::kShared ? hfus : 1; }
  std::uint32_t fetches() const { return hfus / parts_of_group(); }
  // The parts of both eyes, where there are two: each has FFUs and a rendering unit of its own.
  std::uint32_t parts() const { return parts_of_group() * hfu.eyes; }
};

// The keys that stand before and behind those of the order's own units.
inline void visit_head(ConfigVisitor& v, StreamingConfig& c) {
  v("clock_mhz", c.clock_mhz, in_range(1, 10000), "clock of all units");
  v("lane_latency_cycles", c.lane_latency_cycles, in_range(1, 64),
    "of a multiply-add in single precision: depths of pipelines follow");
  v("half_lane_latency_cycles", c.half_lane_latency_cycles, in_range(1, 64), "in half precision");
  v("group_width_px", c.group_width_px, in_range(0, kMaxGroupPx),
    "of a pixel group, a multiple of 4; 0, and the height too: of the shapes that fit the SRAM the "
    "one that cuts the frame with the shortest borders");
  v("group_height_px", c.group_height_px, in_range(0, kMaxGroupPx), "of a pixel group, likewise");
  v("framebuffer", c.framebuffer,
    names<FrameFormat>({{"rgb8", FrameFormat::kRgb8}, {"rgb32f", FrameFormat::kRgb32f}}),
    "pixels in DRAM");
  v("hfus", c.hfus, in_range(1, 64), "hierarchical filtering units");
  v("sorting_units", c.sorting_units, in_range(1, 16), "sorting units");
  v.section("sram", c.sram, "on-chip memory");
}

inline void visit_tail(ConfigVisitor& v, StreamingConfig& c) {
  v.section("hfu", c.hfu, "each hierarchical filtering unit");
  v.section("codebook", c.codebook, "codebook buffer of all HFUs");
  v.section("rendering", c.rendering, "rendering unit");
  v.section("memory_port", c.memory_port, "how units talk to memory");
}

// Sizes of buffers that hold any scene that is stored so: second halves of degree 3, with full
// codebooks.
BuiltFor built_for(const StreamingConfig& config, const StorageConfig& storage);

// Share of one part of the groups: its share of the rendering unit, and buffers for its pixels.
RenderingConfig rendering_of_part(const StreamingConfig& config);
BuiltFor built_for_part(const StreamingConfig& config, BuiltFor built_for);

// Throw InputError: HFUs that share a fetch and whose parts of a group do not come out even; what
// neither order can build.
void check_parts(const StreamingConfig& config);
void check(const StreamingConfig& config, const StorageConfig& storage);

}  // namespace sgs
