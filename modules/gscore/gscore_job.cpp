// Layout of a frame's working regions.
#include "modules/gscore/gscore_job.h"

#include <fmt/format.h>

#include <stdexcept>

#include "algorithm/files/input_error.h"
#include "modules/datapath/work_rates.h"
#include "modules/gscore/sorting/pivots.h"
#include "modules/machine_design.h"

namespace sgs::gscore {
namespace {

constexpr const char *kProjected = "projected", *kTileLists = "tile_lists",
                     *kSubsetLists = "subsets";

// Blocks of `lists` lists that hold so many entries together: a link is taken ahead.
std::uint64_t blocks_for(const BlockFormat& format, std::uint64_t entries, std::uint64_t lists) {
  return entries / format.block_entries() + 2 * lists;
}

const Region& region_of(const Regions& regions, const char* name, RegionId& id) {
  for (std::size_t r = 0; r < regions.size(); ++r) {
    id = static_cast<RegionId>(r);
    if (regions[id].name == name) return regions[id];
  }
  throw std::invalid_argument(fmt::format("no region {} in the job", name));
}

RegionSpan span_of(const Regions& regions, const char* name) {
  RegionSpan span;
  const Region& region = region_of(regions, name, span.region);
  span.base = region.base;
  span.bytes = region.bytes;
  return span;
}

}  // namespace

void add_regions(const GscoreConfig& config, FrameJob& job) {
  const BlockFormat blocks = config.blocks();
  const std::uint64_t count = job.layout.gaussian_count();
  const std::uint64_t least = blocks_for(blocks, count, 1) + 1;
  if (config.pool_blocks() < least) {
    throw InputError(fmt::format(
        "lists.pool_bytes: got {}, expected {} or more: one tile may list all {} Gaussians",
        config.lists.pool_bytes, least * blocks.block_bytes(), count));
  }
  if (config.eyes > 1 && config.eyes * count > config.entries().records()) {
    throw InputError(
        fmt::format("eyes: got {} with {} Gaussians, expected at most {} projected for both: an "
                    "entry of a list tells no more apart",
                    config.eyes, count, config.entries().records()));
  }
  Regions& regions = job.layout.regions;
  regions.add_records(kProjected, kRecordPlaceBytes,
                      std::uint64_t{config.eyes} * config.lists.sets * count);
  regions.add(kTileLists, config.lists.sets * config.lists.pool_bytes);
  // A list is split once a level, into 8.
  const bool splits = count > config.sorting.list_entries;
  const std::uint64_t of_level = blocks_for(blocks, count, kSubsets);
  regions.add(
      kSubsetLists,
      splits ? config.cores * most_levels(config.tiles.keys) * of_level * blocks.block_bytes() : 0);
  add_frame_buffers(job);
}

GscoreJob gscore_job(const GscoreConfig& config, const FrameJob& job) {
  GscoreJob out;
  out.sets = config.lists.sets;
  static_cast<FrameJob&>(out) = job;
  out.columns = job.eyes * static_cast<std::uint32_t>(cycles_for(job.view.width, kTilePx));
  out.tile_count =
      out.columns * static_cast<std::uint32_t>(cycles_for(job.view.height, kTilePx)) * job.frames();
  const Regions& regions = job.layout.regions;
  out.projected = span_of(regions, kProjected)
                      .records(0, kRecordPlaceBytes,
                               std::uint64_t{job.eyes} * out.sets * job.layout.gaussian_count());
  out.lists = span_of(regions, kTileLists);
  out.subsets = span_of(regions, kSubsetLists);
  return out;
}

}  // namespace sgs::gscore
