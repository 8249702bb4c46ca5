// The thread of VSU in exact order.
#include "modules/streaminggs/vsu/exact_vsu.h"

#include <limits>

#include "algorithm/voxel/chunk_work.h"
#include "modules/streaminggs/counted_datapath.h"

namespace sgs {
namespace {

Datapath chunk_test(const ExactVsuConfig& config) {
  Datapath path = counted_datapath("chunk_test", "vsu", chunk_work(longest_chunk_case()));
  path.lanes = config.test_lanes;
  return path;
}

// Levels of the walk's queue, a heap; each has its memory and its comparator.
std::uint32_t queue_levels(std::uint32_t entries) {
  std::uint32_t levels = 0;
  while ((std::uint64_t{1} << levels) < entries) ++levels;
  return levels;
}

}  // namespace

ExactVsu::ExactVsu(const sc_core::sc_module_name& name, const ExactVsuConfig& config,
                   const UnitContext& context, const RegionSpan& aside)
    : sc_module(name),
      memory("memory", context.built_for.memory_port),
      config_(config),
      built_for_(context.built_for),
      job_(context.job),
      walk_("walk", context.clock),
      tests_(chunk_test(config)),
      nodes_(config.node_cache_bytes, job_.layout.chunk_table().nodes),
      source_(*this, aside),
      chunk_walk_(job_.view, source_, config.queue_entries) {
  SC_THREAD(run_walk);
}

void ExactVsu::run_walk() {
  for (std::uint32_t group = 0; group < job_.groups.size(); ++group) {
    current_group_ = group;
    chunk_walk_.start(job_.groups[group], job_.layout.chunk_table().nodes.count == 0);
    std::optional<WalkEntry> chunk = next();
    counters_.groups_empty += chunk ? 0 : 1;
    while (chunk && !finished->finished(group)) {
      // A visit goes out once its successor is known: that bounds what may still come.
      const std::optional<WalkEntry> following = next();
      hand_out(group, *chunk,
               following ? following->nearest : std::numeric_limits<float>::infinity());
      chunk = following;
    }
    counters_.groups_saturated += chunk ? 1 : 0;
    mark_end(group);
  }
  walk_.idles();
}

std::optional<WalkEntry> ExactVsu::next() {
  const WalkCounters before = chunk_walk_.counters();
  const std::optional<WalkEntry> chunk = chunk_walk_.next();
  const WalkCounters& after = chunk_walk_.counters();
  walk_.work(1 + (after.nodes - before.nodes) + tests_.cycles(after.tests - before.tests));
  return chunk;
}

void ExactVsu::hand_out(std::uint32_t group, const WalkEntry& chunk, float release_below) {
  current_chunk_ = chunk.at;
  in_turn(visits, next_visit_)
      .push({group, next_visit_, chunk.at, chunk.count, Mark::kEndOfVisit, release_below}, walk_);
  ++next_visit_;
  ++counters_.visits;
}

void ExactVsu::mark_end(std::uint32_t group) {
  in_turn(visits, next_visit_)
      .push({group, next_visit_, 0, 0, Mark::kEndOfGroup, std::numeric_limits<float>::infinity()},
            walk_);
  ++next_visit_;
}

SramUses ExactVsu::sram_uses(const ExactVsuConfig& config, const BuiltFor& built_for) {
  SramUses uses = TableCache<ChunkNode>::sram_uses("node cache", "node cache tags", kSharedSram,
                                                   config.node_cache_bytes);
  uses.push_back(sram_use(
      "walk queue", kSharedSram, {{config.queue_entries, "entries"}, {kWalkEntryBytes, "B"}},
      {8 * kWalkEntryBytes, SramPorts::kReadAndWrite, queue_levels(config.queue_entries)}));
  uses.push_back(
      unanswered_writes("entries put aside", kSharedSram, built_for.memory_port, kWalkEntryBytes));
  return uses;
}

void ExactVsu::publish(DataSheet& sheet) {
  const WalkCounters& walk = chunk_walk_.counters();
  sheet.unit(*this);
  sheet.activity(walk_, "vsu", "walks the chunk tree, one group after the other");
  sheet.counter("nodes", "nodes", "of the chunk tree opened", walk.nodes);
  sheet.counter("node_cache_misses", "nodes", "of these read from DRAM", nodes_.misses());
  sheet.counter("tests", "children", "tested against a group", walk.tests);
  sheet.counter("visits", "chunks", "handed out, once for each group", counters_.visits);
  sheet.counter("groups_saturated", "groups", "finished before their walk ended",
                counters_.groups_saturated);
  sheet.counter("groups_empty", "groups", "that no chunk can touch", counters_.groups_empty);
  sheet.counter("queue_entries_max", "entries", "most in the walk's queue", walk.queue_max);
  sheet.counter("queue_entries_put_aside", "entries", "that went to DRAM: the queue was full",
                walk.overflowed);
  sheet.datapath(tests_, walk.tests);
  sheet.left_out("saturated_groups", "every pixel was finished before the walk ended",
                 counters_.groups_saturated, "the rest of the tree is not walked");
  sheet.left_out("empty_groups", "no block of Gaussians can touch them", counters_.groups_empty,
                 "no visit, no blending");
  sheet.sram(sram_uses(config_, built_for_));
  nodes_.publish_accesses(sheet, "node cache", "node cache tags");
  const std::uint32_t levels = queue_levels(config_.queue_entries);
  const std::uint64_t moves = walk.queue_operations * levels;
  sheet.part("vsu", "comparator", levels, 1);
  sheet.operations("vsu", "comparator", static_cast<double>(moves));
  sheet.accesses("walk queue", moves, moves);
  sheet.port(memory, "entries put aside");
  sheet.remedy(walk_, "vsu.test_lanes");
  sheet.remedy(memory, WaitFor::kReads, "vsu.node_cache_bytes");
  sheet.remedy(memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.signal("group", current_group_);
  sheet.signal("chunk", current_chunk_);
}

ChunkNode ExactVsu::Source::node(std::uint32_t index) {
  return vsu_.nodes_.get(index, vsu_.memory, vsu_.walk_);
}

void ExactVsu::Source::put_aside(const WalkEntry& entry) {
  static_assert(sizeof(WalkEntry) == kWalkEntryBytes);
  start_write(vsu_.memory, vsu_.walk_, aside_.base + std::uint64_t{aside_count_} * kWalkEntryBytes,
              &entry, kWalkEntryBytes, aside_.region);
  ++aside_count_;
}

std::vector<WalkEntry> ExactVsu::Source::take_back() {
  std::vector<WalkEntry> entries(aside_count_);
  await_all(vsu_.memory, vsu_.walk_);  // they have been written
  await(vsu_.memory, vsu_.walk_,
        start_read(vsu_.memory, vsu_.walk_, aside_.base, entries.data(),
                   aside_count_ * kWalkEntryBytes, aside_.region));
  aside_count_ = 0;
  return entries;
}

void ExactVsu::Source::forget_aside() {
  await_all(vsu_.memory, vsu_.walk_);  // or they could overtake the next group's
  aside_count_ = 0;
}

}  // namespace sgs
