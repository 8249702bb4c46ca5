// What can be chosen about the tile-centric machine.
#pragma once

#include <cstdint>

#include "algorithm/memory/frame_buffer.h"
#include "algorithm/memory/tile_records.h"
#include "algorithm/render/tile_renderer.h"
#include "modules/config/config_visitor.h"
#include "modules/datapath/lane_steps.h"
#include "tlm/memory_port.h"
#include "tlm/sram_use.h"

namespace sgs::gscore {

constexpr int kMostDegree = 3;  // of SH

// How a Gaussian comes to its tiles, and in which numbers.
struct TilesConfig {
  TileReach reach = TileReach::kThreeSigma;
  TileTest test = TileTest::kOriented;
  int subtiles_across = 2;
  NumberFormat features = NumberFormat::kHalf, keys = NumberFormat::kHalf;

  TileRules rules() const { return {reach, test, subtiles_across}; }
};

struct CcuConfig {
  // Multiply-accumulates of one CCU that cull and that convert.
  std::uint32_t cull_lanes = 8, convert_lanes = 18;
  std::uint32_t slice_gaussians = 8;     // first halves read at once
  std::uint32_t input_slots = 4;         // slices on their way or waiting
  std::uint32_t candidates = 16;         // that wait for their second halves to be asked for
  std::uint32_t second_half_slots = 16;  // second halves on their way or waiting
  std::uint32_t output_entries = 16;     // converted Gaussians that wait for the lister
};

struct ListsConfig {
  std::uint32_t tiles_at_once = 4;  // neighbours in a row that are tested together
  // Multiply-accumulates that test tiles, and the parts of one, for all CCUs.
  std::uint32_t tile_lanes = 20, part_lanes = 24;
  std::uint32_t tested_entries = 4;  // listed tiles that wait for the lines
  // Of a pass at most: a frame with more takes several. Lines in which entries of a tile are
  // combined. 0: chosen by the frame (list_memory.h).
  std::uint32_t tiles = 0, lines = 0;
  std::uint32_t line_bytes = 32, block_lines = 16;
  std::uint64_t pool_bytes = 268435456;  // of lists in memory
};

struct SortingConfig {
  // Of a list on chip; longer ones are split in memory. 0: chosen by what lists of tiles leave.
  std::uint32_t list_entries = 0;
  std::uint32_t list_buffers = 2;     // such lists in a core
  std::uint32_t chunk_entries = 256;  // that the network sorts
};

struct RenderingConfig {
  BlendPrecision precision = BlendPrecision::kHalf;  // of blending and of the pixels on chip
  std::uint32_t core_lanes = 0;  // multiply-accumulates of the 16 VRUs; 0: a pixel a cycle each
  std::uint32_t sorted_entries = 256;  // that wait for their records
  std::uint32_t record_slots = 48;     // records on their way or waiting
  std::uint32_t pixel_buffers = 2;     // tiles whose pixels are in a core
  std::uint32_t drain_pixels_per_cycle = 1;
  bool skip_finished = true;  // parts of a tile in which every pixel is finished
  std::uint32_t feedback_latency_cycles = 2;
};

struct SramConfig {
  std::uint32_t buffer_bytes = 8 * 34 * 1024;
};

struct GscoreConfig {
  double clock_mhz = 1000;
  std::uint32_t lane_latency_cycles = 3, half_lane_latency_cycles = 2;
  FrameFormat framebuffer = FrameFormat::kRgb8;
  std::uint32_t ccus = 4, cores = 4;
  TilesConfig tiles;
  SramConfig sram;
  CcuConfig ccu;
  ListsConfig lists;
  SortingConfig sorting;
  RenderingConfig rendering;
  MemoryPortConfig memory_port;

  OperationLatencies single() const { return {lane_latency_cycles, 1, 1}; }
  OperationLatencies half() const { return {half_lane_latency_cycles, 1, 1}; }
  OperationLatencies blending() const {
    return in_16_bits(rendering.precision) ? half() : single();
  }
  EntryFormat entries() const { return {tiles.keys, tiles.subtiles_across, tiles.features}; }
  BlockFormat blocks() const { return {entries(), lists.line_bytes, lists.block_lines}; }
  TileOrderConfig order() const;
  std::uint32_t pool_blocks() const {
    return static_cast<std::uint32_t>(lists.pool_bytes / blocks().block_bytes());
  }
};

void visit(ConfigVisitor& v, GscoreConfig& config);

// The one on-chip memory.
constexpr const char* kBuffer = "buffer";

// Of the whole machine.
SramUses sram_uses(const GscoreConfig& config);

// Combinations that cannot be built. Throws InputError.
void check(const GscoreConfig& config);

}  // namespace sgs::gscore
