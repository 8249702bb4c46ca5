// Data sheet of the rays: their memories and lanes.
#include <algorithm>

#include "modules/datapath/selection.h"
#include "modules/streaminggs/built_for.h"
#include "modules/streaminggs/vsu/ray_unit.h"
#include "modules/streaminggs/vsu/vsu_datapaths.h"

namespace sgs {
namespace {

// Bytes kept of a ray: direction and its reciprocals, which only steps read; position: its cell,
// level, signs, pixel and the ends of its chain; a node; a voxel that it met, with its distance and
// its round.
constexpr std::uint32_t kDirectionBytes = 24, kPositionBytes = 16;
constexpr std::uint32_t kNodeBytes = 12, kMetBytes = 8;
constexpr std::uint32_t kRoundBytes = 2;
constexpr std::uint32_t kRayBanks = 4;  // banks of memories shared by steps and look-ups, by ray
constexpr std::uint32_t kTagBytes = 4;  // tag of a line on its way

// Bytes kept of a ray that waits: its line, or its place among those that found none for theirs.
std::uint32_t waiting_bytes(const PaperVsuConfig& config) {
  const std::uint32_t places = std::max(config.node_fetches, config.rays_in_flight);
  return (1 + counter_bits(places - 1) + 7) / 8;
}

}  // namespace

SramUses RayUnit::sram_uses(const PaperVsuConfig& config) {
  SramUses uses = TableCache<VoxelNode>::sram_uses("node cache", "node cache tags", kSharedSram,
                                                   config.node_cache_bytes);
  const std::uint32_t rays = config.rays_in_flight;
  const auto of_rays = [&](const char* name, const SramFactors& each, const SramShape& shape,
                           const SramPeak& peak) {
    SramFactors factors = {{rays, "rays"}};
    factors.insert(factors.end(), each.begin(), each.end());
    uses.push_back(sram_use(name, kSharedSram, factors, shape, peak));
  };
  of_rays("ray directions", {{kDirectionBytes, "B"}}, {8 * kDirectionBytes}, kOneOfEach);
  // A step and a look-up begin in a cycle, and what began earlier ends: a step out of a block, one
  // out of a cell, a look-up, a ray's beginning.
  const std::uint32_t banks = std::min(rays, kRayBanks);
  const std::uint32_t ends = std::min(banks, 4U);
  of_rays("ray positions", {{kPositionBytes, "B"}},
          {8 * kPositionBytes, SramPorts::kReadAndWrite, banks}, {std::min(banks, 2U), ends});
  of_rays("ray nodes", {{kNodesOfRay, "nodes"}, {kNodeBytes, "B"}}, {8 * kNodeBytes}, kOneOfEach);
  of_rays("ray chains", {{config.chain_entries, "voxels"}, {kMetBytes, "B"}},
          {8 * kMetBytes, SramPorts::kReadAndWrite, banks}, {1, std::min(banks, 3U)});
  // Kept in registers: the first round of all is found at once, and so is a ray that waits for a
  // line that has come.
  of_rays("rounds of rays", {{kRoundBytes, "B"}}, {8 * kRoundBytes, SramPorts::kReadAndWrite, rays},
          {rays, rays});
  of_rays("rays that wait for nodes", {{waiting_bytes(config), "B"}},
          {8 * waiting_bytes(config), SramPorts::kReadAndWrite, rays}, {rays, 1});
  // A line that is missed is looked for among all of them.
  const std::uint32_t lines = config.node_fetches;
  uses.push_back(sram_use("tags of node fetches", kSharedSram, {{lines, "lines"}, {kTagBytes, "B"}},
                          {8 * kTagBytes, SramPorts::kReadAndWrite, lines}, {lines, 1}));
  uses.push_back(sram_use("node fetches", kSharedSram,
                          {{lines, "lines"}, {TableCache<VoxelNode>::kCacheLineBytes, "B"}},
                          {8 * kPortBytes}, kOneOfEach));
  // order() reads an edge beside the record that the edge before it names.
  uses.push_back(sram_use("ordering table", kSharedSram, {{config.table_bytes, "B"}},
                          {8 * kTableWordBytes, SramPorts::kReadAndWrite, config.table_banks},
                          {std::min(config.table_banks, 2U), config.table_banks}));
  const std::uint64_t names = names_bytes(config);
  uses.push_back(sram_use(
      "renamed voxels", kSharedSram, {{names / kNameBytes, "slots"}, {kNameBytes, "B"}},
      {8 * static_cast<std::uint32_t>(std::min<std::uint64_t>(kNamesWord, names))}, kOneOfEach));
  uses.push_back(sram_use("ready voxels", kSharedSram,
                          {{ready_words(config), "words"}, {kReadyWord, "B"}}, {8 * kReadyWord},
                          kOneOfEach));
  return uses;
}

// More of it leaves one cycle each time.
Remedy RayUnit::remedy() const {
  struct Shared {
    const char* key;
    std::uint64_t times, cycles;
  };
  const Shared all[] = {{"vsu.step_lanes", counts_.steps, counts_.steps * steps_.interval_cycles()},
                        {"vsu.ray_lanes", counts_.rays, counts_.rays * begins_.interval_cycles()}};
  const char* key = "vsu.rays_in_flight";
  std::uint64_t most = activity_.busy_cycles() / 3;
  for (const Shared& shared : all) {
    if (shared.cycles - shared.times <= most) continue;
    most = shared.cycles - shared.times;
    key = shared.key;
  }
  return key;
}

void RayUnit::publish(DataSheet& sheet) const {
  sheet.datapath(begins_, counts_.rays);
  sheet.datapath(steps_, counts_.steps);
  nodes.publish_accesses(sheet, "node cache", "node cache tags");
  const std::uint64_t lookups = nodes.lookups(), results = lookups - counts_.called;
  sheet.accesses("ray directions", counts_.steps, counts_.rays);
  sheet.accesses("ray positions", counts_.steps + lookups, counts_.rays + counts_.steps + results);
  sheet.accesses("rounds of rays", counts_.found * config.rays_in_flight,
                 counts_.rays + counts_.steps + counts_.entered);
  sheet.accesses("ray nodes", counts_.steps, results);
  sheet.accesses("ray chains", counts_.entered, counts_.entered);
  const std::uint64_t misses = nodes.misses();
  const std::uint64_t line = sram_words(TableCache<VoxelNode>::kCacheLineBytes, {8 * kPortBytes});
  // A look-up that misses is looked for among the lines on their way, and its ray waits; who waits
  // is looked for when a line comes, and when a place is free.
  const std::uint64_t missed = misses + counts_.joined + counts_.without_place;
  sheet.accesses("rays that wait for nodes", (misses + counts_.called) * config.rays_in_flight,
                 missed);
  sheet.accesses("tags of node fetches", missed * config.node_fetches, misses);
  sheet.accesses("node fetches", misses * line, misses * line);
  sheet.accesses("ordering table", counts_.accesses.reads, counts_.accesses.writes);
  sheet.accesses("renamed voxels", counts_.accesses.names_read,
                 counts_.accesses.names_written + counts_.names_cleared);
  sheet.accesses("ready voxels", counts_.accesses.ready_read,
                 counts_.accesses.ready_written + counts_.ready_cleared);
  // Comparisons: words read of the table with the voxel; a voxel that is met with the bounds of the
  // window; one that is entered with the nearest and the farthest; the round of the first ray with
  // those of the others; a miss with all lines on their way; a line that has come with the lines
  // that rays wait for; a look-up with the tags of a set.
  sheet.part(
      "vsu", "comparator",
      config.table_banks + 4.0 + 2.0 * config.rays_in_flight + config.node_fetches + kCacheWays, 1);
  sheet.operations(
      "vsu", "comparator",
      static_cast<double>(counts_.accesses.reads + 2 * counts_.met + 2 * counts_.entered +
                          (misses + counts_.called + counts_.found) * config.rays_in_flight +
                          missed * config.node_fetches + kCacheWays * lookups));
}

}  // namespace sgs
