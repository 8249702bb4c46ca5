// Keys and on-chip memory of the tile-centric machine.
#include "modules/gscore/gscore_config.h"

#include <fmt/format.h>

#include "algorithm/files/input_error.h"
#include "modules/gscore/ccu/ccu.h"
#include "modules/gscore/gscore_machine.h"
#include "modules/gscore/lists/tile_lister.h"
#include "modules/gscore/rendering/render_core.h"
#include "modules/gscore/sorting/tile_sorter.h"
#include "modules/memory_port_keys.h"

namespace sgs::gscore {
namespace {

ConfigNames<NumberFormat> formats() {
  return names<NumberFormat>({{"fp32", NumberFormat::kSingle}, {"fp16", NumberFormat::kHalf}});
}

}  // namespace

void visit(ConfigVisitor& v, TilesConfig& c) {
  v("reach", c.reach,
    names<TileReach>({{"three_sigma", TileReach::kThreeSigma}, {"visible", TileReach::kVisible}}),
    "of boxes: as published, or to where alpha falls below 1/255, which loses nothing");
  v("test", c.test, names<TileTest>({{"box", TileTest::kBox}, {"oriented", TileTest::kOriented}}),
    "along the screen; or along the ellipse too, where it is long and has several tiles");
  v("subtiles_across", c.subtiles_across, in_range(1, 4),
    "parts of a tile with a bit each, in a row: 1, 2 or 4");
  v("features", c.features, formats(), "of projected Gaussians in memory");
  v("keys", c.keys, formats(), "of depth");
}

void visit(ConfigVisitor& v, SramConfig& c) {
  v("buffer_bytes", c.buffer_bytes, in_range(0, 1 << 30),
    "all buffers, published as 8 x 34 KB; 0: as large as the other parameters need");
}

void visit(ConfigVisitor& v, CcuConfig& c) {
  v("cull_lanes", c.cull_lanes, in_range(1, 256), "MAC lanes that test centres");
  v("convert_lanes", c.convert_lanes, in_range(1, 1024), "MAC lanes that project and colour");
  v("slice_gaussians", c.slice_gaussians, in_range(1, 256), "first halves read at once");
  v("input_slots", c.input_slots, in_range(1, 64), "slices on their way or waiting");
  v("candidates", c.candidates, in_range(1, 1024), "that wait for their second halves");
  v("second_half_slots", c.second_half_slots, in_range(1, 256),
    "second halves on their way or waiting");
  v("output_entries", c.output_entries, in_range(1, 1024), "converted Gaussians that wait");
}

void visit(ConfigVisitor& v, ListsConfig& c) {
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
}

void visit(ConfigVisitor& v, SortingConfig& c) {
  v("list_entries", c.list_entries, in_range(0, 65536),
    "of a list on chip; longer ones are split in memory; 0: as many as fit");
  v("list_buffers", c.list_buffers, in_range(1, 16), "such lists in a core");
  v("chunk_entries", c.chunk_entries, in_range(16, 4096), "sorted by the network at once");
}

void visit(ConfigVisitor& v, RenderingConfig& c) {
  v("precision", c.precision,
    names<BlendPrecision>({{"fp32", BlendPrecision::kSingle},
                           {"fp16", BlendPrecision::kHalf},
                           {"fixed16", BlendPrecision::kFixed}}),
    "of blending and of the pixels on chip");
  v("core_lanes", c.core_lanes, in_range(0, 4096),
    "MAC lanes of the 16 VRUs of a core; 0: a pixel a cycle each");
  v("sorted_entries", c.sorted_entries, in_range(1, 65536), "that wait for their records");
  v("record_slots", c.record_slots, in_range(1, 1024), "records on their way or waiting");
  v("pixel_buffers", c.pixel_buffers, in_range(1, 2), "tiles whose pixels are in a core");
  v("drain_pixels_per_cycle", c.drain_pixels_per_cycle, in_range(1, 4),
    "finished pixels converted a cycle; a row of a tile lies in four memories");
  v("skip_finished", c.skip_finished, "parts of a tile in which every pixel is finished");
  v("feedback_latency_cycles", c.feedback_latency_cycles, in_range(1, 1000),
    "until a sorter sees that a tile is finished");
}

void visit(ConfigVisitor& v, GscoreConfig& c) {
  v("clock_mhz", c.clock_mhz, in_range(1, 10000), "clock of all units");
  v("lane_latency_cycles", c.lane_latency_cycles, in_range(1, 64),
    "of a multiply-add in single precision: depths of pipelines follow");
  v("half_lane_latency_cycles", c.half_lane_latency_cycles, in_range(1, 64), "in half precision");
  v("framebuffer", c.framebuffer,
    names<FrameFormat>({{"rgb8", FrameFormat::kRgb8}, {"rgb32f", FrameFormat::kRgb32f}}),
    "pixels in DRAM");
  v("ccus", c.ccus, in_range(1, 64), "culling and conversion units");
  v("cores", c.cores, in_range(1, 64), "with two QSUs, a BSU and 16 VRUs each");
  v.section("tiles", c.tiles, "how Gaussians come to tiles");
  v.section("sram", c.sram, "on-chip memory");
  v.section("ccu", c.ccu, "each culling and conversion unit");
  v.section("lists", c.lists, "lists of tiles");
  v.section("sorting", c.sorting, "sorter of each core");
  v.section("rendering", c.rendering, "volume rendering units of each core");
  v.section("memory_port", c.memory_port, "how units talk to memory");
}

TileOrderConfig GscoreConfig::order() const {
  TileOrderConfig out;
  out.rules = tiles.rules();
  out.features = tiles.features;
  out.keys = tiles.keys;
  out.precision = rendering.precision;
  out.chunk_entries = sorting.chunk_entries;
  return out;
}

SramUses sram_uses(const GscoreConfig& c) {
  SramUses uses;
  add(uses, Ccu::sram_uses(c), c.ccus);
  add(uses, TileLister::sram_uses(c));
  add(uses, TileSorter::sram_uses(c), c.cores);
  add(uses, RenderCore::sram_uses(c), c.cores);
  add(uses, queue_uses(c));
  return uses;
}

void check(const GscoreConfig& c) {
  if (c.tiles.subtiles_across == 3) {
    throw InputError("tiles.subtiles_across: got 3, expected 1, 2 or 4");
  }
  if ((c.lists.line_bytes & (c.lists.line_bytes - 1)) != 0) {
    throw InputError(
        fmt::format("lists.line_bytes: got {}, expected a power of two", c.lists.line_bytes));
  }
  if (c.sorting.list_entries != 0 && c.sorting.list_entries < c.sorting.chunk_entries) {
    throw InputError(fmt::format("sorting.list_entries: got {}, expected at least a chunk: {}",
                                 c.sorting.list_entries, c.sorting.chunk_entries));
  }
}

}  // namespace sgs::gscore
