// What the tile-centric machine needs, must give, and is built from.
#include "modules/gscore/gscore_design.h"

#include <fmt/format.h>

#include <algorithm>

#include "algorithm/input_error.h"
#include "algorithm/render/tile_renderer.h"
#include "modules/datapath/work_rates.h"
#include "modules/gscore/gscore_machine.h"

namespace sgs::gscore {
namespace {

constexpr const char *kProjected = "projected", *kTileLists = "tile_lists", *kSubsetLists = "subsets";

// Of lists that hold so many entries together, `lists` of them: a link is taken ahead.
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

void GscoreDesign::resolve(const StorageConfig& storage, std::vector<AutoChoice>& chosen) {
  check(config_);
  if (storage.encoding != SecondHalfEncoding::kRaw &&
      storage.encoding != SecondHalfEncoding::kHalf) {
    throw InputError(fmt::format(
        "storage.encoding: got {}, expected raw or half: machine gscore has no codebooks",
        kEncodingNames[static_cast<std::size_t>(storage.encoding)]));
  }
  const SramUses uses = sram_uses(config_);
  const std::uint64_t needed = sram_bytes(uses, kBuffer);
  if (config_.sram.buffer_bytes == 0) {
    config_.sram.buffer_bytes = static_cast<std::uint32_t>(needed);
    chosen.push_back(
        {"sram.buffer_bytes", static_cast<double>(needed), sram_sum(uses, kBuffer)});
  }
  if (needed > config_.sram.buffer_bytes) {
    throw InputError(fmt::format(
        "sram.buffer_bytes: {} bytes are there, {} are needed: {}; expected at least {}, or 0: as "
        "large as must be",
        config_.sram.buffer_bytes, needed, sram_sum(uses, kBuffer), needed));
  }
}

void GscoreDesign::adapt(const SecondHalfFormat&, std::vector<AutoChoice>&) {}

void add_regions(const GscoreConfig& config, FrameJob& job) {
  const BlockFormat blocks = config.blocks();
  const std::uint64_t count = job.layout.gaussian_count();
  const std::uint64_t least = blocks_for(blocks, count, 1) + 1;
  if (config.pool_blocks() < least) {
    throw InputError(fmt::format(
        "lists.pool_bytes: got {}, expected {} or more: one tile may list all {} Gaussians",
        config.lists.pool_bytes, least * blocks.block_bytes(), count));
  }
  Regions& regions = job.layout.regions;
  regions.add_records(kProjected, record_place_bytes(config.tiles.features), count);
  regions.add(kTileLists, config.lists.pool_bytes);
  // A list is split once a level, into 8.
  const bool splits = count > config.sorting.list_entries;
  const std::uint64_t of_level = blocks_for(blocks, count, kSubsets);
  regions.add(kSubsetLists, splits ? config.cores * most_levels(config.tiles.keys) * of_level *
                                         blocks.block_bytes()
                                   : 0);
  job.frame_buffer =
      regions.add("frame_buffer", std::uint64_t{pixel_bytes(job.frame_format)} * job.view.width *
                                      job.view.height);
}

FrameJob GscoreDesign::job(const StoredScene& scene, const Camera& camera) const {
  FrameJob job;
  job.view = make_view<float>(camera);
  job.layout = scene.image.layout;
  job.frame_format = config_.framebuffer;
  add_regions(config_, job);
  return job;
}

GscoreJob gscore_job(const GscoreConfig& config, const FrameJob& job) {
  GscoreJob out;
  static_cast<FrameJob&>(out) = job;
  out.columns = static_cast<std::uint32_t>(cycles_for(job.view.width, kTilePx));
  out.tile_count = out.columns * static_cast<std::uint32_t>(cycles_for(job.view.height, kTilePx));
  const Regions& regions = job.layout.regions;
  out.projected = span_of(regions, kProjected)
                      .records(0, record_place_bytes(config.tiles.features),
                               job.layout.gaussian_count());
  out.lists = span_of(regions, kTileLists);
  out.subsets = span_of(regions, kSubsetLists);
  return out;
}

GoldenFrame GscoreDesign::golden(const StoredScene& scene, const FrameJob& job,
                                 DataSheet& sheet) const {
  TileOrderConfig order = config_.order();
  order.background = job.background;
  TileResult result = render_tiles(job.view, scene.decoded, order);
  const TileStats& stats = result.stats;
  sheet.left_out("tiles_not_touched", "boxes along the ellipses", stats.tile_tests - stats.pairs,
                 "entries of lists");
  constexpr std::uint64_t kWholeTile = kSubtilesPerTile * kSubtilesPerTile;
  sheet.left_out("parts_not_touched", "bits of parts of tiles",
                 kWholeTile * stats.entries_taken - stats.subtile_blends,
                 "16 fragments each, with those that were finished");
  GoldenFrame golden;
  golden.image = std::move(result.frame.image);
  golden.blends = stats.contributors;
  golden.contributing = stats.contributing;
  golden.misordered = stats.misordered;
  return golden;
}

std::unique_ptr<Machine> GscoreDesign::build(const sc_core::sc_module_name& name,
                                             const FrameJob& job,
                                             const BuildOptions& options) const {
  return std::make_unique<GscoreMachine>(name, config_, gscore_job(config_, job), options);
}

}  // namespace sgs::gscore
