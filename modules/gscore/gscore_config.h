// Parameters of the tile-centric machine.
#pragma once

#include <cstdint>

#include "algorithm/memory/frame_buffer.h"
#include "algorithm/memory/scene_layout.h"
#include "algorithm/memory/tile_records.h"
#include "algorithm/render/tile_renderer.h"
#include "modules/config/config_visitor.h"
#include "modules/datapath/lane_steps.h"
#include "tlm/memory_port.h"
#include "tlm/sram_use.h"

namespace sgs::gscore {

constexpr int kMostDegree = 3;  // largest SH degree

// Rules that assign a Gaussian to its tiles, and the number formats of its record.
struct TilesConfig {
  TileReach reach = TileReach::kThreeSigma;
  TileTest test = TileTest::kOriented;
  int subtiles_across = 2;
  NumberFormat features = NumberFormat::kHalf, keys = NumberFormat::kHalf;

  TileRules rules() const { return {reach, test, subtiles_across}; }
};

inline void visit(ConfigVisitor& v, TilesConfig& c) {
  v("reach", c.reach,
    names<TileReach>({{"three_sigma", TileReach::kThreeSigma}, {"visible", TileReach::kVisible}}),
    "of boxes: as published, or to where alpha falls below 1/255, which loses nothing");
  v("test", c.test, names<TileTest>({{"box", TileTest::kBox}, {"oriented", TileTest::kOriented}}),
    "along the screen; or along the ellipse too, where it is long and has several tiles");
  v("subtiles_across", c.subtiles_across, in_range(1, 4),
    "parts of a tile with a bit each, in a row: 1, 2 or 4");
  const auto formats =
      names<NumberFormat>({{"fp32", NumberFormat::kSingle}, {"fp16", NumberFormat::kHalf}});
  v("features", c.features, formats, "of projected Gaussians in memory");
  v("keys", c.keys, formats, "of depth");
}

// What is culled before its Gaussians are fetched.
enum class CullingBy : std::uint8_t {
  kGaussians,   // nothing: every first half is read
  kChunkBoxes,  // chunks, by the tree of their boxes
};

struct CullingConfig {
  CullingBy by = CullingBy::kGaussians;
  std::uint32_t nodes_in_flight = 8, nodes_in_test = 8, nodes_tested = 32;
  std::uint32_t test_lanes = 10;
  std::uint32_t tree_levels = 64;
};

inline void visit(ConfigVisitor& v, CullingConfig& c) {
  v("by", c.by,
    names<CullingBy>(
        {{"gaussians", CullingBy::kGaussians}, {"chunk_boxes", CullingBy::kChunkBoxes}}),
    "frustum culling of each Gaussian; or of chunks first, by the tree of their boxes, with scenes "
    "stored by chunks");
  v("nodes_in_flight", c.nodes_in_flight, in_range(1, 1024),
    "by chunk_boxes: nodes on their way from DRAM at a time");
  v("nodes_in_test", c.nodes_in_test, in_range(1, 1024),
    "by chunk_boxes: nodes whose children are in the test's pipeline");
  v("nodes_tested", c.nodes_tested, in_range(1, 1024),
    "by chunk_boxes: most nodes on their way, in test, or tested ahead of their turn");
  v("test_lanes", c.test_lanes, in_range(1, 10000),
    "by chunk_boxes: MAC lanes of the test of a box");
  v("tree_levels", c.tree_levels, in_range(1, 65536),
    "by chunk_boxes: levels of the deepest tree that the walk has room for");
}

struct CcuConfig {
  std::uint32_t cull_lanes = 8, convert_lanes = 18;
  std::uint32_t slice_gaussians = 8;
  std::uint32_t input_slots = 4;
  std::uint32_t candidates = 16;
  std::uint32_t second_half_slots = 16;
  std::uint32_t output_entries = 16;
};

inline void visit(ConfigVisitor& v, CcuConfig& c) {
  v("cull_lanes", c.cull_lanes, in_range(1, 256), "MAC lanes that test centres");
  v("convert_lanes", c.convert_lanes, in_range(1, 1024), "MAC lanes that project and colour");
  v("slice_gaussians", c.slice_gaussians, in_range(1, 256), "first halves read at once");
  v("input_slots", c.input_slots, in_range(1, 64), "slices on their way or waiting");
  v("candidates", c.candidates, in_range(1, 1024),
    "Gaussians that wait for their second halves to be asked for");
  v("second_half_slots", c.second_half_slots, in_range(1, 256),
    "second halves on their way or waiting");
  v("output_entries", c.output_entries, in_range(1, 1024), "converted Gaussians that wait");
}

struct ListsConfig {
  std::uint32_t tiles_at_once = 4;
  std::uint32_t tile_lanes = 20, part_lanes = 18;
  std::uint32_t tested_entries = 4;
  std::uint32_t tiles = 0, lines = 0;
  std::uint32_t line_bytes = 32, block_lines = 16;
  std::uint64_t pool_bytes = 268435456;
  std::uint32_t sets = 1;
};

inline void visit(ConfigVisitor& v, ListsConfig& c) {
  v("tiles_at_once", c.tiles_at_once, in_range(1, 16), "neighbours in a row, tested together");
  v("tile_lanes", c.tile_lanes, in_range(1, 1024), "MAC lanes that test these");
  v("part_lanes", c.part_lanes, in_range(1, 1024), "MAC lanes that test the parts of a tile");
  v("tested_entries", c.tested_entries, in_range(1, 1024), "listed tiles that wait");
  v("tiles", c.tiles, in_range(0, 1 << 20),
    "of one pass; a frame with more takes several passes; 0: as many as the frame has and fit");
  v("lines", c.lines, in_range(0, 1 << 20),
    "of lists that are combined on chip; 0: as many as fit, one a tile at most");
  v("line_bytes", c.line_bytes, in_range(32, 256), "of a line, a power of two");
  v("block_lines", c.block_lines, in_range(1, 64), "lines behind one link");
  v("pool_bytes", c.pool_bytes, in_range(4096, std::int64_t{1} << 40),
    "lists in memory; a pass that takes more is made again with half of its tiles");
  v("sets", c.sets, in_range(1, 2),
    "of projected Gaussians and their lists; with 2 a pass is projected while the one before it is "
    "drawn");
}

struct SortingConfig {
  std::uint32_t list_entries = 0;
  std::uint32_t list_buffers = 2;
  std::uint32_t chunk_entries = 256;
};

inline void visit(ConfigVisitor& v, SortingConfig& c) {
  v("list_entries", c.list_entries, in_range(0, 65536),
    "of a list on chip; longer ones are split in memory; 0: as many as fit");
  v("list_buffers", c.list_buffers, in_range(1, 16), "such lists in a core");
  v("chunk_entries", c.chunk_entries, in_range(16, 4096), "sorted by the network at once");
}

struct RenderingConfig {
  BlendPrecision precision = BlendPrecision::kHalf;
  std::uint32_t core_lanes = 0;
  std::uint32_t sorted_entries = 256;
  std::uint32_t record_slots = 48;
  std::uint32_t pixel_buffers = 2;
  std::uint32_t drain_pixels_per_cycle = 1;
  bool skip_finished = true;
  std::uint32_t feedback_latency_cycles = 2;
};

inline void visit(ConfigVisitor& v, RenderingConfig& c) {
  v("precision", c.precision,
    names<BlendPrecision>({{"fp32", BlendPrecision::kSingle},
                           {"fp16", BlendPrecision::kHalf},
                           {"fixed16", BlendPrecision::kFixed}}),
    "of blending and of the pixels on chip");
  v("core_lanes", c.core_lanes, in_range(0, 4096),
    "MAC lanes of the 16 VRUs of a core; 0: a pixel a cycle each");
  v("sorted_entries", c.sorted_entries, in_range(1, 65536),
    "sorted entries that wait for their records");
  v("record_slots", c.record_slots, in_range(1, 1024), "records on their way or waiting");
  v("pixel_buffers", c.pixel_buffers, in_range(1, 2), "tiles whose pixels are in a core");
  v("drain_pixels_per_cycle", c.drain_pixels_per_cycle, in_range(1, 4),
    "finished pixels converted a cycle; a row of a tile lies in four memories");
  v("skip_finished", c.skip_finished,
    "parts of a tile in which every pixel is finished are not blended");
  v("feedback_latency_cycles", c.feedback_latency_cycles, in_range(1, 1000),
    "until a sorter sees that a tile is finished");
}

struct SramConfig {
  std::uint32_t buffer_bytes = 8 * 34 * 1024;
};

inline void visit(ConfigVisitor& v, SramConfig& c) {
  v("buffer_bytes", c.buffer_bytes, in_range(0, 1 << 30),
    "all buffers, published as 8 x 34 KB; 0: as large as the other parameters need");
}

struct GscoreConfig {
  double clock_mhz = 1000;
  std::uint32_t lane_latency_cycles = 3, half_lane_latency_cycles = 2;
  FrameFormat framebuffer = FrameFormat::kRgb8;
  std::uint32_t ccus = 4, cores = 4;
  std::uint32_t eyes = 1;
  TilesConfig tiles;
  SramConfig sram;
  CullingConfig culling;
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
  bool culls_chunks() const { return culling.by == CullingBy::kChunkBoxes; }
  StorageOrder storage_order() const {
    return culls_chunks() ? StorageOrder::kChunks : StorageOrder::kFile;
  }
  // The most of any scene that it takes.
  std::uint32_t first_half_bytes() const;
  std::uint32_t carried_words() const;
  TileOrderConfig order() const;
  std::uint32_t pool_blocks() const {
    return static_cast<std::uint32_t>(lists.pool_bytes / blocks().block_bytes());
  }
};

inline void visit(ConfigVisitor& v, GscoreConfig& c) {
  v("clock_mhz", c.clock_mhz, in_range(1, 10000), "clock of all units");
  v("lane_latency_cycles", c.lane_latency_cycles, in_range(1, 64),
    "of a multiply-add in single precision: depths of pipelines follow");
  v("half_lane_latency_cycles", c.half_lane_latency_cycles, in_range(1, 64), "in half precision");
  v("framebuffer", c.framebuffer,
    names<FrameFormat>({{"rgb8", FrameFormat::kRgb8}, {"rgb32f", FrameFormat::kRgb32f}}),
    "pixels in DRAM");
  v("ccus", c.ccus, in_range(1, 64), "culling and conversion units");
  v("cores", c.cores, in_range(1, 64), "with two QSUs, a BSU and 16 VRUs each");
  v("eyes", c.eyes, in_range(1, 2),
    "2, set by --stereo: Gaussians are fetched once and converted for both, with lists for each");
  v.section("tiles", c.tiles, "how Gaussians come to tiles");
  v.section("sram", c.sram, "on-chip memory");
  v.section("culling", c.culling, "what is culled ahead of the CCUs");
  v.section("ccu", c.ccu, "each culling and conversion unit");
  v.section("lists", c.lists, "lists of tiles");
  v.section("sorting", c.sorting, "sorter of each core");
  v.section("rendering", c.rendering, "volume rendering units of each core");
  v.section("memory_port", c.memory_port, "how units talk to memory");
}

// The one on-chip memory.
constexpr const char* kBuffer = "buffer";

// SRAM of the whole machine.
SramUses sram_uses(const GscoreConfig& config);

// Combinations that cannot be built. Throws InputError.
void check(const GscoreConfig& config);

}  // namespace sgs::gscore
