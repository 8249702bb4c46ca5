// Workloads of the rendering core: what comes in, for the unit and for its clocked reference.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "algorithm/render/tile_renderer.h"
#include "modules/datapath/rendering_flows.h"
#include "modules/gscore/gscore_datapaths.h"
#include "testbench/units/gscore_bench.h"
#include "testbench/units/random_scene.h"
#include "tests/modules/gscore/clocked/clocked_render_core.h"

namespace sgs::test {

using namespace gscore;

constexpr int kCoreWidth = 76, kCoreHeight = 40;  // px

struct CoreWorkload {
  const char* name;
  std::size_t entries = 60;  // of a tile
  float opacity = 0.3F;
  bool whole_tiles = false;
  CoreHardware hardware;
  std::uint32_t in_one_in = 1, in_longest = 1, sorted_entries = 8;
  BlendPrecision precision = BlendPrecision::kHalf;
  FrameFormat frame = FrameFormat::kRgb8;
};

// The schedules' depths; all else is the workload's.
inline CoreHardware scheduled(const CoreWorkload& load, const GscoreConfig& config) {
  CoreHardware hw = load.hardware;
  const Datapath blending = blend_pipeline(config);
  const std::optional<Datapath> conic = conic_pipeline(config);
  constexpr std::uint32_t kReadAndWrite = 2;  // of the pixels' memory
  REQUIRE(blending.interval_cycles() == hw.blend_interval);
  const PixelWrites writes = pixel_writes(blending, ports_of_pixels(config));
  hw.depth = std::max(conic ? conic->depth_cycles : 0, corner_pipeline(config).depth_cycles) +
             blending.depth_cycles + writes.wait_cycles + kReadAndWrite;
  hw.conic_interval = conic ? static_cast<std::uint32_t>(conic->interval_cycles()) : 1;
  hw.state_loop = writes.loop_cycles + kReadAndWrite;
  hw.drain_depth = drain_pipeline(config).depth_cycles;
  return hw;
}

inline GscoreConfig config_of(const CoreWorkload& load) {
  GscoreConfig config;
  config.cores = 1;
  config.lists.pool_bytes = 1 << 20;
  config.tiles.subtiles_across = static_cast<int>(load.hardware.parts_across);
  config.framebuffer = load.frame;
  config.rendering.precision = load.precision;
  config.rendering.record_slots = load.hardware.record_slots;
  config.rendering.pixel_buffers = load.hardware.pixel_buffers;
  config.rendering.skip_finished = load.hardware.skip_finished;
  const std::uint32_t all = blend_pipeline(config).used_macs, turn = load.hardware.blend_interval;
  config.rendering.core_lanes = (all + turn - 1) / turn;
  return config;
}

struct CorePlan {
  std::vector<Splat> records;
  std::vector<std::vector<SortedEntry>> tiles;  // [tile]
};

inline CorePlan plan_of(const CoreWorkload& load, const GscoreConfig& config, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  FrameJob frame;
  frame.view.width = kCoreWidth;
  frame.view.height = kCoreHeight;
  const auto groups = pixel_groups(kCoreWidth, kCoreHeight, square_of(kTilePx));
  const int across = config.tiles.subtiles_across;
  const std::uint32_t all_parts = (1U << (across * across)) - 1;
  CorePlan plan;
  plan.tiles.resize(groups.size());
  for (std::uint32_t t = 0; t < groups.size(); ++t) {
    const std::size_t entries = random() % 5 == 0 ? random() % 3 : load.entries;
    for (std::size_t e = 0; e < entries; ++e) {
      const auto number = static_cast<std::uint32_t>(plan.records.size());
      plan.records.push_back(tb::random_splat(random, groups[t], frame, number, load.opacity));
      const auto some = 1 + static_cast<std::uint32_t>(random() % all_parts);
      plan.tiles[t].push_back({EntryMark::kEntry, t, number, load.whole_tiles ? all_parts : some});
    }
  }
  return plan;
}

// A row of pixels comes out of its memories a pixel a cycle; a pixel a turn of the lanes where the
// next tile is blended in these, too; with one port each pixel is cleared in a cycle of its own.
inline std::uint32_t row_cycles_of(const CoreHardware& hw, std::uint32_t px) {
  if (hw.blend_interval == 1) return px;
  return hw.pixel_buffers > 1 ? hw.blend_interval * px : std::max(px, 2 * ((px + 3) / 4));
}

inline std::vector<CoreTile> tiles_of(const GscoreJob& job, const CoreHardware& hw) {
  std::vector<CoreTile> tiles;
  for (std::uint32_t t = 0; t < job.tile_count; ++t) {
    const PixelRect pixels = job.pixels(t);
    CoreTile tile;
    for (std::uint32_t block = 0; block < 16; ++block) {
      const int x = static_cast<int>(block) % 4 * 4, y = static_cast<int>(block) / 4 * 4;
      tile.outside |= x >= pixels.width() || y >= pixels.height() ? 1U << block : 0;
    }
    const auto width = static_cast<std::uint32_t>(pixels.width());
    tile.row_cycles = row_cycles_of(hw, width);
    for (int y = pixels.y0; y < pixels.y1; ++y) {
      tile.rows.push_back(
          {job.pixel_address(pixels.x0, y), std::uint64_t{width} * pixel_bytes(job.frame_format)});
    }
    tiles.push_back(tile);
  }
  return tiles;
}

inline std::vector<SortedEntry> stream_of(const CorePlan& plan) {
  std::vector<SortedEntry> stream;
  for (std::uint32_t t = 0; t < plan.tiles.size(); ++t) {
    stream.insert(stream.end(), plan.tiles[t].begin(), plan.tiles[t].end());
    stream.push_back({EntryMark::kEndOfTile, t});
  }
  stream.push_back({EntryMark::kEndOfFrame});
  return stream;
}

// What a splat finishes depends on those before it in its tile.
inline std::vector<CoreItem> items_of(const CorePlan& plan, const GscoreConfig& config,
                                      const GscoreJob& job) {
  std::vector<CoreItem> items;
  for (std::uint32_t t = 0; t < plan.tiles.size(); ++t) {
    GroupState state(job.pixels(t), kCoreWidth, kCoreHeight, config.rendering.precision,
                     SubtileTest::kBox);
    const auto finished = [&](std::uint32_t block) {
      const auto x = static_cast<std::uint8_t>(block % 4), y = static_cast<std::uint8_t>(block / 4);
      return !state.any_unfinished({x, y, x, y});
    };
    for (const SortedEntry& entry : plan.tiles[t]) {
      CoreItem item{CoreMark::kEntry, t, entry.bitmap};
      item.record = {job.projected.address(entry.record), record_bytes(config.tiles.features)};
      for (std::uint32_t b = 0; b < 16; ++b) item.finishes |= finished(b) ? 0 : 1U << b;
      std::byte bytes[kRecordPlaceBytes];
      encode_projected(config.tiles.features, plan.records[entry.record], bytes);
      with_record(config.tiles.features, config.rendering.precision, bytes, entry.opacity,
                  [&](const auto& splat) {
                    for_each_part(config.tiles.rules(), job.tile_x(t), job.tile_y(t), entry.bitmap,
                                  splat, [&](const auto& part, int) { state.blend(part); });
                  });
      for (std::uint32_t b = 0; b < 16; ++b) item.finishes &= finished(b) ? ~0U : ~(1U << b);
      items.push_back(item);
    }
    items.push_back({CoreMark::kEndOfTile, t});
  }
  items.push_back({CoreMark::kEndOfFrame});
  return items;
}

}  // namespace sgs::test
