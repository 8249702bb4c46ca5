// Turns at what the rays share, and what it takes.
#include "modules/streaminggs/vsu/ray_unit.h"

#include <algorithm>
#include <utility>

#include "algorithm/voxel/ray_path.h"
#include "modules/datapath/work_rates.h"
#include "modules/streaminggs/built_for.h"
#include "modules/streaminggs/vsu/vsu_datapaths.h"

namespace sgs {
namespace {

// Of a ray: direction and its reciprocals, which only steps read; its cell, its level and its
// signs, its pixel, the ends of its chain; a node; a voxel that it met, with its distance and its
// round.
constexpr std::uint32_t kDirectionBytes = 24, kPositionBytes = 16;
constexpr std::uint32_t kNodeBytes = 12, kMetBytes = 8;
constexpr std::uint32_t kRoundBytes = 2;
constexpr std::uint32_t kRayBanks = 4;   // of what steps and look-ups share: by the ray's number
constexpr std::uint32_t kTagBytes = 4;   // of a line on its way
constexpr std::uint32_t kNameBytes = 2;  // the number of a voxel
constexpr std::uint32_t kNamesWord = 8, kReadyWord = 4;

std::uint64_t names_bytes(const PaperVsuConfig& config) {
  return kNameBytes * Renaming::slots_for(OrderingTable::most_voxels(config.table_bytes));
}
std::uint64_t ready_words(const PaperVsuConfig& config) {
  return ReadyVoxels::all_words_for(OrderingTable::most_voxels(config.table_bytes));
}

// The first of two things that share something gets it first.
std::uint64_t turn(std::uint64_t& free, std::uint64_t cycle, std::uint64_t cycles) {
  const std::uint64_t start = std::max(free, cycle);
  free = start + cycles;
  return start;
}

}  // namespace

RayUnit::RayUnit(const PaperVsuConfig& c, const OperationLatencies& latencies,
                 const ClockDomain& clock, Activity& activity, MemoryPort& port,
                 const RecordArray& table, HandOver to)
    : config(c),
      nodes(c.node_cache_bytes, table),
      hand_over(std::move(to)),
      clock_(clock),
      activity_(activity),
      port_(port),
      begins_(pixel_ray_pipeline(c, latencies)),
      steps_(ray_step_pipeline(c, latencies)) {}

void RayUnit::advance_to(std::uint64_t cycle) {
  if (cycle > now()) clock_.wait_cycles(cycle - now());
}

void RayUnit::begin_pass() {
  activity_.works();
  pass_from_ = begins_free_ = steps_free_ = look_ups_free_ = table_free_ = now();
}

// Of lanes, the same in their turns. No ray is under way when a pass begins, so that they count
// from there.
std::uint64_t RayUnit::turn_of(const Datapath& lanes, std::uint64_t& free, std::uint64_t cycle) {
  const std::uint64_t interval = lanes.interval_cycles();
  const std::uint64_t of_pass = next_turn(std::max(free, cycle) - pass_from_, interval);
  return turn(free, pass_from_ + of_pass, interval);
}

std::uint64_t RayUnit::begin_ray(std::uint64_t cycle) {
  ++rays_;
  return turn_of(begins_, begins_free_, cycle) + config.ray_depth_cycles;
}

std::uint64_t RayUnit::step(std::uint64_t cycle, std::uint32_t log2_block) {
  ++steps_taken_;
  return turn_of(steps_, steps_free_, cycle) + config.step_cycles(log2_block) + kMaskCycles;
}

std::uint64_t RayUnit::look_up(std::uint64_t cycle) { return turn(look_ups_free_, cycle, 1); }

std::vector<NodeFetches::Waiting>& RayUnit::waiting_for(std::uint64_t tag, std::uint64_t cycle) {
  if (auto* const others = fetches.waiting_for(tag)) return *others;
  advance_to(cycle);
  auto& waiting = fetches.ask(tag, nodes, port_, activity_);
  look_ups_free_ = std::max(look_ups_free_, now());
  return waiting;
}

void RayUnit::wait_for_nodes(std::uint64_t cycle) {
  if (cycle == kNever) {
    activity_.waits_for(WaitFor::kReads, port_);
    sc_core::wait(fetches.news());
  } else {
    sc_core::wait(static_cast<double>(cycle - now()) * clock_.period(), fetches.news());
  }
  clock_.jitter();
  activity_.works();
}

void RayUnit::take_what_comes() {
  while (!fetches.empty()) {
    while (!fetches.any_come()) wait_for_nodes(kNever);
    advance_to(fetches.ready_cycle());
    nodes.fill(fetches.take().line);
  }
}

std::uint64_t RayUnit::cycles_since(const OrderingAccesses& all) {
  return all.cycles - std::exchange(accesses_, all).cycles;
}

std::uint64_t RayUnit::enter(const OrderingTable& table, std::uint64_t cycle) {
  ++entered_;
  const std::uint64_t cycles = std::max<std::uint64_t>(
      first_of_rounds_cycles(config.rays_in_flight), cycles_since(table.accesses()));
  return turn(table_free_, cycle, cycles) + cycles;
}

void RayUnit::order(const OrderingTable& table) {
  const std::uint64_t clearing = names_bytes(config) / kNamesWord;
  activity_.work(std::max(cycles_since(table.accesses()), clearing));
  names_cleared_ += clearing;
}

void RayUnit::clear(const OrderingTable& table) {
  cycles_since(table.accesses());
  const std::uint64_t names = names_bytes(config) / kNamesWord, ready = ready_words(config);
  activity_.work(std::max(names, ready));
  names_cleared_ += names;
  ready_cleared_ += ready;
}

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
  // In registers: the first of all is found at once, a line that is missed looked for among all.
  of_rays("rounds of rays", {{kRoundBytes, "B"}}, {8 * kRoundBytes, SramPorts::kReadAndWrite, rays},
          {rays, rays});
  of_rays("node fetches", {{kTagBytes, "B"}}, {8 * kTagBytes, SramPorts::kReadAndWrite, rays},
          {rays, 1});
  // In order() an edge is read beside the record that the one before it names.
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
  const Shared all[] = {{"vsu.step_lanes", steps_taken_, steps_taken_ * steps_.interval_cycles()},
                        {"vsu.ray_lanes", rays_, rays_ * begins_.interval_cycles()}};
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
  sheet.datapath(begins_, rays_);
  sheet.datapath(steps_, steps_taken_);
  nodes.publish_accesses(sheet, "node cache", "node cache tags");
  const std::uint64_t lookups = nodes.lookups();
  sheet.accesses("ray directions", steps_taken_, rays_);
  sheet.accesses("ray positions", steps_taken_ + lookups, rays_ + steps_taken_ + lookups);
  sheet.accesses("rounds of rays", entered_ * config.rays_in_flight,
                 rays_ + steps_taken_ + entered_);
  sheet.accesses("ray nodes", steps_taken_, lookups);
  sheet.accesses("ray chains", entered_, entered_);
  sheet.accesses("node fetches", nodes.misses() * config.rays_in_flight, nodes.misses());
  sheet.accesses("ordering table", accesses_.reads, accesses_.writes);
  sheet.accesses("renamed voxels", accesses_.names_read, accesses_.names_written + names_cleared_);
  sheet.accesses("ready voxels", accesses_.ready_read, accesses_.ready_written + ready_cleared_);
  // What is read of the table is compared with the voxel; a voxel that is met with the bounds of
  // the window, one that is entered with the nearest and the farthest, and its round with those of
  // the other rays; a miss with all lines on their way; a look-up with the tags of a set.
  sheet.part("vsu", "comparator",
             config.table_banks + 4.0 + 2.0 * config.rays_in_flight + kCacheWays, 1);
  sheet.operations("vsu", "comparator",
                   static_cast<double>(accesses_.reads + 2 * met_ + 2 * entered_ +
                                       (nodes.misses() + entered_) * config.rays_in_flight +
                                       kCacheWays * lookups));
}

}  // namespace sgs
