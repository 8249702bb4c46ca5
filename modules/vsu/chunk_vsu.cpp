// The thread of VSU in exact order.
#include "modules/vsu/chunk_vsu.h"

#include <cstring>
#include <limits>

namespace sgs {

ChunkVsu::ChunkVsu(const sc_core::sc_module_name& name, const VsuConfig& config,
                   const ClockDomain& clock, const FrameJob& job, const SaturationBoard& board,
                   MemoryPort& port, std::vector<TimedFifo<VisitShare>*> visits,
                   std::uint64_t aside_base)
    : sc_module(name),
      config_(config),
      job_(job),
      board_(board),
      port_(port),
      visits_(std::move(visits)),
      walk_activity_(std::string(this->name()) + ".walk", clock),
      nodes_(config.node_cache_bytes, job.layout.chunk_node_address(0), job.layout.chunk_node_count,
             region_id(Region::kChunkTable)),
      source_(*this, aside_base),
      chunk_walk_(job.view, source_, config.queue_entries) {
  SC_THREAD(walk);
}

void ChunkVsu::walk() {
  for (std::uint32_t group = 0; group < job_.groups.size(); ++group) {
    current_group_ = group;
    chunk_walk_.start(job_.groups[group], job_.layout.chunk_node_count == 0);
    std::optional<WalkEntry> chunk = next();
    counters_.groups_empty += chunk ? 0 : 1;
    while (chunk && !board_.saturated(group)) {
      // A visit goes out once its successor is known: that bounds what may still come.
      const std::optional<WalkEntry> following = next();
      hand_out(group, *chunk,
               following ? following->nearest : std::numeric_limits<float>::infinity());
      chunk = following;
    }
    counters_.groups_saturated += chunk ? 1 : 0;
    mark_end(group);
  }
  walk_activity_.enter(ActivityState::kStarved);
}

std::optional<WalkEntry> ChunkVsu::next() {
  const WalkCounters before = chunk_walk_.counters();
  const std::optional<WalkEntry> chunk = chunk_walk_.next();
  const WalkCounters& after = chunk_walk_.counters();
  const std::uint64_t tests = after.tests - before.tests;
  const std::uint64_t opened = after.nodes - before.nodes;
  walk_activity_.work(1 + opened + (tests + config_.tests_per_cycle - 1) / config_.tests_per_cycle);
  return chunk;
}

void ChunkVsu::hand_out(std::uint32_t group, const WalkEntry& chunk, float release_below) {
  current_chunk_ = chunk.at;
  VisitShare visit{group, next_visit_, chunk.at, chunk.count, Mark::kEndOfVisit, release_below};
  visits_[next_visit_ % visits_.size()]->push(visit, walk_activity_);
  ++next_visit_;
  ++counters_.visits;
}

void ChunkVsu::mark_end(std::uint32_t group) {
  visits_[next_visit_ % visits_.size()]->push(
      {group, next_visit_, 0, 0, Mark::kEndOfGroup, std::numeric_limits<float>::infinity()},
      walk_activity_);
  ++next_visit_;
}

ChunkVsuCounters ChunkVsu::counters() const {
  ChunkVsuCounters out = counters_;
  const WalkCounters& walk = chunk_walk_.counters();
  out.nodes = walk.nodes;
  out.tests = walk.tests;
  out.queue_max = walk.queue_max;
  out.overflowed = walk.overflowed;
  out.node_misses = nodes_.misses();
  return out;
}

void ChunkVsu::trace(sc_core::sc_trace_file* file) const {
  walk_activity_.trace(file);
  sc_core::sc_trace(file, current_group_, std::string(name()) + ".group");
  sc_core::sc_trace(file, current_chunk_, std::string(name()) + ".chunk");
}

ChunkNode ChunkVsu::Source::node(std::uint32_t index) {
  return vsu_.nodes_.get(index, vsu_.port_, vsu_.walk_activity_);
}

void ChunkVsu::Source::put_aside(const WalkEntry& entry) {
  static_assert(sizeof(WalkEntry) == kWalkEntryBytes);
  start_write(vsu_.port_, vsu_.walk_activity_,
              aside_base_ + std::uint64_t{aside_count_} * kWalkEntryBytes, &entry, kWalkEntryBytes,
              region_id(Region::kSpill));
  ++aside_count_;
}

std::vector<WalkEntry> ChunkVsu::Source::take_back() {
  std::vector<WalkEntry> entries(aside_count_);
  await_all(vsu_.port_, vsu_.walk_activity_);  // they have been written
  await(vsu_.port_, vsu_.walk_activity_,
        start_read(vsu_.port_, vsu_.walk_activity_, aside_base_, entries.data(),
                   aside_count_ * kWalkEntryBytes, region_id(Region::kSpill)));
  aside_count_ = 0;
  return entries;
}

void ChunkVsu::Source::forget_aside() {
  await_all(vsu_.port_, vsu_.walk_activity_);  // or they could overtake the next group's
  aside_count_ = 0;
}

}  // namespace sgs
