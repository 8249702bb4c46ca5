// The threads of VSU.
#include "modules/streaminggs/vsu/exact_vsu.h"

#include <algorithm>
#include <limits>

#include "modules/streaminggs/vsu/vsu_datapaths.h"

namespace sgs {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

ExactVsu::ExactVsu(const sc_core::sc_module_name& name, const ExactVsuConfig& config,
                   const UnitContext& context, const RegionSpan& aside)
    : sc_module(name),
      memory("memory", context.built_for.memory_port, context.clock.period()),
      config_(config),
      built_for_(context.built_for),
      job_(context.job),
      walk_("walk", context.clock),
      hand_out_("hand_out", context.clock),
      upper_(std::min<std::uint64_t>(config.upper_nodes, job_.layout.chunk_table().nodes.count)),
      nodes_(config.nodes_in_flight, job_.layout.chunk_table().nodes),
      tester_(context.clock,
              chunk_test_pipeline(config, context.built_for.eyes, context.built_for.single),
              config.nodes_in_test, config.test_depth_cycles),
      numbers_in_turn_(group_numbers(group_flow(GroupUse::kWalk), context.built_for.single)),
      aside_(memory, walk_, aside),
      chunk_walk_(aside_, config.walk_room()),
      ready_("ready", context.clock, kReadyVisits),
      taken_("taken", context.clock, kReadyVisits),
      room_(kReadyVisits),
      saturated_(job_.groups.size()) {
  taken_.announce_to(news_);
  tester_.announce_to(news_);
  SC_THREAD(run_walk);
  SC_THREAD(run_arrivals);
  SC_THREAD(run_tests);
  SC_THREAD(run_hand_out);
}

void ExactVsu::run_walk() {
  make_numbers(0);
  load_upper_nodes();
  while (group_ < job_.groups.size()) {
    take_up_group(walk_, memory, group_);
    while (taken_.can_pop()) {
      taken_.pop(walk_);
      ++room_;
    }
    if (!step()) wait_for_news();
  }
  drop(nodes_.used() + tester_.used());
  walk_.idles();
}

void ExactVsu::load_upper_nodes() {
  const RecordArray& nodes = job_.layout.chunk_table().nodes;
  if (upper_.empty()) return;
  await(memory, walk_,
        start_read(memory, walk_, nodes.base, upper_.data(),
                   static_cast<std::uint32_t>(upper_.size() * sizeof(ChunkNode)), nodes.region));
}

// Reads first: the longest way. Nothing else is done in the same step, so that what comes meanwhile
// is seen.
bool ExactVsu::step() {
  return begin_group() || read_node() || give_chunk() || enter_children() || test_node();
}

// For `first` and the group behind it, as soon as their poses are known and registers are free.
void ExactVsu::make_numbers(std::uint32_t first) {
  const std::size_t end = std::min(first + registers_free_.size(), job_.groups.size());
  for (; made_groups_ < end && pose_known(host, job_.frame_of(made_groups_)); ++made_groups_) {
    const std::size_t at = made_groups_ % registers_free_.size();
    const std::uint64_t from = std::max(registers_free_[at], walk_.clock().now_cycles());
    numbers_stand_[at] = numbers_in_turn_.stand(from);
  }
}

// Once its numbers stand.
bool ExactVsu::may_begin_group() const {
  return next_group_ < job_.groups.size() &&
         (chunk_walk_.begun() == 0 || chunk_walk_.has_read_ahead());
}

bool ExactVsu::begin_group() {
  if (!may_begin_group() || waits_for_pose()) return false;
  make_numbers(group_);
  if (walk_.clock().now_cycles() < numbers_stand_[next_group_ % numbers_stand_.size()]) {
    return false;
  }
  if (host.size() > 0 && job_.begins_frame(next_group_)) {
    host->takes_pose(job_.frame_of(next_group_));
  }
  chunk_walk_.begin(job_.view_of(next_group_), job_.groups[next_group_],
                    job_.layout.chunk_table().nodes.count == 0);
  ++next_group_;
  work_on_queues(1);
  return true;
}

bool ExactVsu::waits_for_pose() const {
  return next_group_ < job_.groups.size() && !pose_known(host, job_.frame_of(next_group_));
}

// Ahead of need as long as no entry is put aside for it.
bool ExactVsu::read_node() {
  if (!chunk_walk_.has_node()) return false;
  if (!chunk_walk_.has_room_for_another() && !chunk_walk_.needs_node()) return false;
  const bool on_chip = chunk_walk_.next_node().at < upper_.size();
  if (on_chip ? tester_.full() : nodes_.full()) return false;
  const WalkEntry entry = chunk_walk_.take_node();
  if (hidden(entry)) {
    ++counters_.nodes_hidden;
    chunk_walk_.leave_out(entry);
    work_on_queues(1);
  } else if (on_chip) {
    ++counters_.upper_nodes_opened;
    work_on_queues(1);
    tester_.put({entry, upper_[entry.at]}, walk_);
  } else {
    work_on_queues(1);
    ++counters_.nodes_read;
    memory.charge_to(chunk_walk_.of_first(entry) ? group_ : group_ + 1);
    nodes_.ask(entry, memory, walk_);
  }
  return true;
}

// True if all sub-tiles that the entry reaches are finished. In the next group none is yet.
bool ExactVsu::hidden(const WalkEntry& entry) {
  ++counters_.looked_up;
  return chunk_walk_.of_first(entry) && unfinished_eyes(masks, group_, entry.reach) == 0;
}

bool ExactVsu::enter_children() {
  if (!tester_.can_take()) return false;
  const NodeInTest<WalkEntry> tested = tester_.take(walk_);
  const std::uint64_t opened = chunk_walk_.counters().nodes;
  chunk_walk_.open(tested.entry, tested.record);
  if (chunk_walk_.counters().nodes == opened) drop(1);
  work_on_queues(1);
  return true;
}

bool ExactVsu::test_node() {
  if (!nodes_.can_take() || tester_.full()) return false;
  const auto [entry, node] = nodes_.take();
  work_on_queues(1);
  if (chunk_walk_.has_ended(entry)) {
    drop(1);
  } else {
    tester_.put({entry, node}, walk_);
  }
  return true;
}

// A visit goes out once its successor is known: that bounds what may still come.
bool ExactVsu::give_chunk() {
  if (room_ == 0 || chunk_walk_.begun() == 0) return false;
  if (all_finished(finished, group_) && !chunk_walk_.exhausted()) {
    end_group(true);
    return true;
  }
  if (const std::optional<WalkEntry> next = chunk_walk_.take_chunk()) {
    any_chunk_ = true;
    if (hidden(*next)) {
      ++counters_.chunks_hidden;
      work_on_queues(1);
      return true;
    }
    if (held_) give(*held_, next->nearest);
    held_ = next;
    work_on_queues(1);
    return true;
  }
  // Entries that were put aside may have come back: there is a node to read then.
  if (!chunk_walk_.exhausted()) return work_on_queues(0);
  if (held_) {
    give(*held_, kInfinity);
    held_.reset();
    work_on_queues(1);
  } else {
    counters_.groups_empty += any_chunk_ ? 0 : 1;
    end_group(false);
  }
  return true;
}

void ExactVsu::give(const WalkEntry& chunk, float release_below) {
  current_chunk_ = chunk.at;
  ready_.push({group_, 0, chunk.at, chunk.count, Mark::kEndOfVisit, release_below}, walk_);
  --room_;
}

void ExactVsu::end_group(bool saturated) {
  if (saturated) mark_saturated(group_);
  held_.reset();
  any_chunk_ = false;
  chunk_walk_.end();
  registers_free_[group_ % registers_free_.size()] = walk_.clock().now_cycles() + 1;
  make_numbers(group_ + 1);
  ready_.push({group_, 0, 0, 0, Mark::kEndOfGroup, kInfinity}, walk_);
  --room_;
  ++group_;
  work_on_queues(1);
}

void ExactVsu::mark_saturated(std::uint32_t group) {
  counters_.groups_saturated += saturated_[group] ? 0 : 1;
  saturated_[group] = true;
}

// Spends the cycles of the queues' operations since the last call, and `other_cycles` beside them.
// True if there were any.
bool ExactVsu::work_on_queues(std::uint64_t other_cycles) {
  const std::uint64_t operations = chunk_walk_.queue_operations();
  const std::uint64_t queues =
      (operations - queue_operations_) * config_.cycles_per_queue_operation;
  queue_operations_ = operations;
  const std::uint64_t cycles = std::max(queues, other_cycles);
  walk_.work(cycles);
  return cycles > 0;
}

// A node that could be read ahead waits for room, whatever else is under way.
void ExactVsu::say_what_is_missing() {
  const bool could_read = chunk_walk_.has_node() && !nodes_.full();
  if (room_ == 0) {
    walk_.waits_for(WaitFor::kRoom, ready_);
  } else if (chunk_walk_.begun() == 0 && waits_for_pose()) {
    walk_.waits_for(WaitFor::kInput, host);
  } else if (chunk_walk_.begun() == 0) {
    walk_.waits_for(WaitFor::kInput, numbers_);
  } else if (could_read && !chunk_walk_.chunks_have_room()) {
    walk_.waits_for(WaitFor::kRoom, chunk_room_);
  } else if (could_read && !chunk_walk_.nodes_have_room()) {
    walk_.waits_for(WaitFor::kRoom, node_room_);
  } else if (tester_.full()) {
    walk_.waits_for(WaitFor::kRoom, tester_.slots());
  } else if (nodes_.used() > 0) {
    walk_.waits_for(WaitFor::kReads, memory);
  } else {
    walk_.waits_for(WaitFor::kInput, tester_.pipeline());
  }
}

void ExactVsu::wait_for_news() {
  say_what_is_missing();
  std::optional<sc_core::sc_time> first;
  const auto may_come = [&](const sc_core::sc_time& at) {
    if (!first || at < *first) first = at;
  };
  if (nodes_.any_arrived() && !tester_.full()) may_come(nodes_.ready_at());
  if (!taken_.empty()) may_come(taken_.ready_at());
  if (tester_.any_tested()) may_come(tester_.ready_at());
  if (may_begin_group() && !waits_for_pose()) {
    const std::uint64_t stand = numbers_stand_[next_group_ % numbers_stand_.size()];
    may_come(sc_core::sc_time::from_value(stand * walk_.clock().period().value()));
  }
  if (waits_for_pose()) {
    const sc_core::sc_event_or_list news = news_ | host->news();
    first ? sc_core::wait(*first - sc_core::sc_time_stamp(), news) : sc_core::wait(news);
    walk_.clock().align();
  } else {
    first ? sc_core::wait(*first - sc_core::sc_time_stamp(), news_) : sc_core::wait(news_);
    walk_.clock().jitter();
  }
  walk_.works();
}

// Nodes may be of the group behind that which is walked: a walk's number is its group's, cut short.
void ExactVsu::run_tests() {
  tester_.run([this](const WalkEntry& entry) {
    tester_.activity().takes_up_group(group_ + static_cast<std::uint16_t>(entry.walk - group_));
  });
}

void ExactVsu::run_arrivals() { nodes_.run_arrivals(memory, walk_.clock(), news_); }

void ExactVsu::run_hand_out() {
  while (true) {
    VisitShare visit = ready_.pop(hand_out_);
    hand_out_.takes_up_group(visit.group, next_visit_);
    taken_.push(0, hand_out_);
    const bool dropped = visit.mark == Mark::kEndOfVisit && all_finished(finished, visit.group);
    hand_out_.work(1);
    if (dropped) {
      ++counters_.visits_dropped;
      mark_saturated(visit.group);
      continue;
    }
    visit.visit = next_visit_;
    in_turn(visits, next_visit_).push(visit, hand_out_);
    ++next_visit_;
    counters_.visits += visit.mark == Mark::kEndOfVisit ? 1 : 0;
  }
}

}  // namespace sgs
