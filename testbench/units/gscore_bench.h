// The parts that the benches of the tile-centric machine's units have in common.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include "modules/gscore/gscore_job.h"
#include "modules/gscore/line_buffer.h"
#include "testbench/units/case_runner.h"
#include "testbench/units/random_scene.h"
#include "testbench/units/unit_bench.h"

namespace sgs::tb {

using namespace sgs::gscore;

// A configuration with lists so small that every way through the units is taken.
inline GscoreConfig random_gscore(std::mt19937_64& random) {
  GscoreConfig c;
  constexpr int kAcross[] = {1, 2, 4};
  c.tiles.subtiles_across = kAcross[random() % 3];
  c.tiles.reach = random() % 2 == 0 ? TileReach::kThreeSigma : TileReach::kVisible;
  c.tiles.test = random() % 2 == 0 ? TileTest::kBox : TileTest::kOriented;
  c.tiles.features = random() % 2 == 0 ? NumberFormat::kHalf : NumberFormat::kSingle;
  c.tiles.keys = random() % 2 == 0 ? NumberFormat::kHalf : NumberFormat::kSingle;
  c.framebuffer = random() % 2 == 0 ? FrameFormat::kRgb8 : FrameFormat::kRgb32f;
  c.lists.tiles = 1 + static_cast<std::uint32_t>(random() % 12);
  c.lists.lines = 1 + static_cast<std::uint32_t>(random() % 8);
  c.lists.line_bytes = 32U << random() % 3;
  c.lists.block_lines = 1 + static_cast<std::uint32_t>(random() % 4);
  c.lists.pool_bytes = 1 << 20;
  c.sorting.chunk_entries = 16U << random() % 3;
  c.sorting.list_entries = c.sorting.chunk_entries << random() % 3;
  c.sorting.list_buffers = 1 + static_cast<std::uint32_t>(random() % 3);
  c.rendering.precision = static_cast<BlendPrecision>(random() % 3);
  c.rendering.record_slots = 1 + static_cast<std::uint32_t>(random() % 8);
  c.rendering.pixel_buffers = 1 + static_cast<std::uint32_t>(random() % 2);
  c.rendering.skip_finished = random() % 2 == 0;
  c.cores = 1;
  return c;
}

// A frame of this size with the machine's regions behind what is in `layout`; the ports hold
// nothing back that the bench does not.
inline GscoreJob gscore_frame(GscoreConfig& config, const UnitBench& bench, FrameJob job) {
  config.memory_port = bench.context({}).built_for.memory_port;
  job.frame_format = config.framebuffer;
  add_regions(config, job);
  return gscore_job(config, job);
}

// A layout of `gaussians` records that nobody reads.
inline SceneLayout empty_layout(std::uint32_t gaussians) {
  return lay_out_file(SecondHalfFormat{}, gaussians);
}

// Bytes of a memory with room for any job of these benches.
constexpr std::size_t kGscoreMemoryBytes = 24 << 20;

// Entries as a lister would leave them: blocks from `first` on, chained by `next`.
inline std::vector<std::byte> chained_blocks(const BlockFormat& format,
                                             const std::vector<TileEntry>& entries,
                                             const std::vector<std::uint32_t>& blocks,
                                             std::size_t pool_blocks) {
  std::vector<std::byte> bytes(pool_blocks * format.block_bytes());
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const std::size_t number = e / format.block_entries();
    std::byte* block = bytes.data() + std::size_t{blocks[number]} * format.block_bytes();
    if (e % format.block_entries() == 0) {
      const std::uint32_t next = number + 1 < blocks.size() ? blocks[number + 1] : 0;
      std::memcpy(block, &next, sizeof next);
    }
    encode_entry(format.entry, entries[e], block + format.offset(e));
  }
  return bytes;
}

inline std::vector<TileEntry> random_entries(std::mt19937_64& random, const GscoreConfig& config,
                                             std::size_t count, std::uint32_t keys) {
  std::vector<TileEntry> entries(count);
  const int across = config.tiles.subtiles_across;
  const std::uint32_t bits = (1U << (across * across)) - 1;
  for (std::size_t e = 0; e < count; ++e) {
    entries[e].key = depth_key(config.tiles.keys, 0.25F + static_cast<float>(random() % keys));
    entries[e].record = static_cast<std::uint32_t>(e);
    entries[e].bitmap = 1 + static_cast<std::uint32_t>(random() % bits);
    entries[e].opacity = listed_opacity(config.tiles.features, uniform(random, 0, 1));
  }
  return entries;
}

}  // namespace sgs::tb
