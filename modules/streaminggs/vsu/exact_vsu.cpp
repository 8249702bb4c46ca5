// The threads of VSU, and what it says of itself.
#include "modules/streaminggs/vsu/exact_vsu.h"

#include <algorithm>
#include <limits>

#include "modules/streaminggs/heap_ledger.h"
#include "modules/streaminggs/vsu/vsu_datapaths.h"

namespace sgs {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr HeapLedger kChunkQueue{"chunk queue", "vsu", kWalkEntryBytes, 2};
constexpr HeapLedger kNodeQueue{"node queue", "vsu", kNodeEntryBytes, 2};

// Keys of the nodes that are taken from their queue and not open yet, and of the nearest entry that
// was put aside: depth, node and one of two walks, in registers, since a chunk is compared with all
// of them at once.
constexpr std::uint32_t kOpenNodeBits = 65, kOpenNodeWords = 2;
std::uint32_t open_nodes(const ExactVsuConfig& config) {
  return config.nodes_in_flight + config.nodes_in_test + 1;
}
SramUse open_nodes_use(const ExactVsuConfig& config) {
  const std::uint32_t nodes = open_nodes(config);
  return sram_use("keys of open nodes", kSharedSram, {{(kOpenNodeBits * nodes + 7) / 8, "B"}},
                  {kOpenNodeBits, SramPorts::kReadAndWrite, nodes}, {nodes, 1});
}

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
      tester_(context.clock, chunk_test_pipeline(config, context.built_for.single),
              config.nodes_in_test, config.test_depth_cycles),
      aside_(*this, aside),
      chunk_walk_(job_.view, aside_, config.walk_room()),
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
  load_upper_nodes();
  while (group_ < job_.groups.size()) {
    walk_.takes_up_group(group_);
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

bool ExactVsu::begin_group() {
  if (next_group_ == job_.groups.size()) return false;
  if (chunk_walk_.begun() > 0 && !chunk_walk_.has_read_ahead()) return false;
  chunk_walk_.begin(job_.groups[next_group_], job_.layout.chunk_table().nodes.count == 0);
  ++next_group_;
  work_on_queues(1);
  return true;
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
    ++counters_.upper_reads;
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

// Of the next group nothing is finished yet.
bool ExactVsu::hidden(const WalkEntry& entry) {
  ++counters_.looked_up;
  return chunk_walk_.of_first(entry) && !mask->any_unfinished(group_, entry.reach);
}

bool ExactVsu::enter_children() {
  if (!tester_.can_take()) return false;
  const NodeInTest tested = tester_.take(walk_);
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
  if (finished->finished(group_) && !chunk_walk_.exhausted()) {
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
  // What was put aside may have come back: there is a node to read then.
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
  ready_.push({group_, 0, 0, 0, Mark::kEndOfGroup, kInfinity}, walk_);
  --room_;
  ++group_;
  work_on_queues(1);
}

void ExactVsu::mark_saturated(std::uint32_t group) {
  counters_.groups_saturated += saturated_[group] ? 0 : 1;
  saturated_[group] = true;
}

// The time of the queues' operations since it was last let pass, and of `other_cycles` beside them.
// Whether there was any.
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
  if (first) {
    sc_core::wait(*first - sc_core::sc_time_stamp(), news_);
  } else {
    sc_core::wait(news_);
  }
  walk_.clock().jitter();
  walk_.works();
}

// Nodes may be of the group behind that which is walked: a walk's number is its group's, cut short.
void ExactVsu::run_tests() {
  tester_.run([this](const WalkEntry& entry) {
    return group_ + static_cast<std::uint16_t>(entry.walk - group_);
  });
}

void ExactVsu::run_arrivals() { nodes_.run_arrivals(memory, walk_.clock(), news_); }

void ExactVsu::run_hand_out() {
  while (true) {
    VisitShare visit = ready_.pop(hand_out_);
    hand_out_.takes_up_group(visit.group, next_visit_);
    taken_.push(0, hand_out_);
    const bool dropped = visit.mark == Mark::kEndOfVisit && finished->finished(visit.group);
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

SramUses ExactVsu::sram_uses(const ExactVsuConfig& config, const BuiltFor& built_for) {
  constexpr SramShape kOfPort{8 * kPortBytes};
  SramUses uses = {
      sram_use("upper nodes", kSharedSram,
               {{config.upper_nodes, "nodes"}, {sizeof(ChunkNode), "B"}}, kOfPort, kOneOfEach),
      sram_use("nodes in flight", kSharedSram,
               {{config.nodes_in_flight, "nodes"}, {sizeof(ChunkNode) + kNodeEntryBytes, "B"}},
               kOfPort, kOneOfEach),
      sram_use("nodes in test", kSharedSram,
               {{config.nodes_in_test, "nodes"}, {sizeof(ChunkNode) + kNodeEntryBytes, "B"}},
               kOfPort, kOneOfEach),
      open_nodes_use(config)};
  add(uses, kChunkQueue.sram_uses(config.queue_entries, config.cycles_per_queue_operation));
  add(uses, kNodeQueue.sram_uses(config.node_queue_entries, config.cycles_per_queue_operation));
  uses.push_back(mask_use(built_for.group));
  uses.push_back(fifo_use<VisitShare>("final visits", kSharedSram, kReadyVisits, "visits"));
  uses.push_back(outstanding_table(kSharedSram, built_for.memory_port));
  uses.push_back(
      unanswered_writes("entries put aside", kSharedSram, built_for.memory_port, kWalkEntryBytes));
  return uses;
}

ExactVsu::Walked ExactVsu::walked() const {
  if (assumed_) return *assumed_;
  return {chunk_walk_.counters(), chunk_walk_.node_queue().work(), chunk_walk_.chunk_queue().work(),
          chunk_walk_.node_queue().most(), chunk_walk_.chunk_queue().most()};
}

void ExactVsu::assume(const Work& work) {
  counters_ = work.counters;
  assumed_ = work.walked;
  assumed_->node_queue.levels.resize(heap_levels(config_.node_queue_entries));
  assumed_->chunk_queue.levels.resize(heap_levels(config_.queue_entries));
  walk_.assume(work.walk_cycles);
  hand_out_.assume(work.hand_out_cycles);
  tester_.assume(work.walked.walk.nodes, work.walked.walk.tests, work.test_cycles);
  ready_.assume(work.ready_entries);
  memory.assume(work.traffic);
}

void ExactVsu::publish(DataSheet& sheet) {
  const Walked done = walked();
  const WalkCounters& walk = done.walk;
  sheet.unit(*this);
  sheet.activity(walk_, "vsu", "walks the chunk tree, one group after the other");
  sheet.activity(tester_.activity(), "chunk_tests", "tests the children of nodes");
  sheet.activity(hand_out_, "visits", "hands out what is final");
  sheet.counter("nodes", "nodes", "of the chunk tree opened", walk.nodes);
  sheet.counter("upper_nodes_opened", "nodes", "of these kept on chip", counters_.upper_reads);
  sheet.counter("nodes_read", "nodes", "read from DRAM", counters_.nodes_read);
  sheet.counter("nodes_dropped", "nodes", "not opened: their group had finished",
                counters_.nodes_dropped);
  sheet.counter("looked_up", "entries", "of the queues, in the mask of finished sub-tiles",
                counters_.looked_up);
  sheet.counter("nodes_hidden", "nodes", "not opened: all sub-tiles that they reach were finished",
                counters_.nodes_hidden);
  sheet.counter("chunks_hidden", "chunks", "not handed out, likewise", counters_.chunks_hidden);
  sheet.counter("tests", "children", "tested against a group", tester_.tests());
  sheet.counter("visits", "chunks", "handed out, once for each group", counters_.visits);
  sheet.counter("visits_dropped", "chunks", "that were final when their group had finished",
                counters_.visits_dropped);
  sheet.counter("groups_saturated", "groups", "finished before their walk ended",
                counters_.groups_saturated);
  sheet.counter("groups_empty", "groups", "that no chunk can touch", counters_.groups_empty);
  sheet.counter("chunk_queue_max", "entries", "most in the queue of chunks", done.chunk_queue_max);
  sheet.counter("node_queue_max", "entries", "most in the queue of nodes", done.node_queue_max);
  sheet.counter("chunk_queue_operations", "operations", "insertions and removals",
                done.chunk_queue.operations());
  sheet.counter("node_queue_operations", "operations", "insertions and removals",
                done.node_queue.operations());
  sheet.counter("queue_entries_put_aside", "entries", "that went to DRAM: the queue was full",
                walk.put_aside);
  sheet.datapath(tester_.lanes(), tester_.tests());
  sheet.left_out("saturated_groups", "every pixel was finished before the walk ended",
                 counters_.groups_saturated, "the rest of the tree is not walked");
  sheet.left_out("hidden_nodes", "all sub-tiles that they reach were finished",
                 counters_.nodes_hidden, "the part of the tree below them");
  sheet.left_out("hidden_chunks", "all sub-tiles that they reach were finished",
                 counters_.chunks_hidden, "a visit each");
  sheet.left_out("empty_groups", "no block of Gaussians can touch them", counters_.groups_empty,
                 "no visit, no blending");
  sheet.sram(sram_uses(config_, built_for_));
  const double of_mask = mask_comparators(built_for_.group);
  // Whenever one of the queues has changed the nearest chunk is compared with all open nodes.
  const double of_open = kOpenNodeWords * open_nodes(config_);
  const std::uint64_t compared = done.chunk_queue.operations() + done.node_queue.operations();
  sheet.part("vsu", "comparator", of_mask + of_open, 1);
  sheet.operations(
      "vsu", "comparator",
      of_mask * static_cast<double>(counters_.looked_up) + of_open * static_cast<double>(compared));
  sheet.accesses("finished sub-tiles", mask_bits(built_for_.group) * counters_.looked_up,
                 mask->news());
  sheet.accesses("keys of open nodes", open_nodes(config_) * compared,
                 counters_.upper_reads + counters_.nodes_read + walk.put_aside);
  // A node comes in and goes out whole, eight children and their common numbers.
  constexpr std::uint64_t kWords = sizeof(ChunkNode) / kPortBytes;
  sheet.accesses("upper nodes", kWords * counters_.upper_reads, kWords * upper_.size());
  sheet.accesses("nodes in flight", kWords * counters_.nodes_read, kWords * counters_.nodes_read);
  // A node goes in and its children come out as entries of the queues, in the same slot.
  const std::uint64_t in_test = 2 * kWords * tester_.nodes();
  sheet.accesses("nodes in test", in_test, in_test);
  kChunkQueue.publish(sheet, config_.queue_entries, config_.cycles_per_queue_operation,
                      done.chunk_queue);
  kNodeQueue.publish(sheet, config_.node_queue_entries, config_.cycles_per_queue_operation,
                     done.node_queue);
  sheet.port(memory, "entries put aside");
  sheet.queue(ready_, "final visits");
  if (config_.cycles_per_queue_operation > kFewestHeapCycles) {
    sheet.remedy(walk_, {"vsu.cycles_per_queue_operation", Turn::kDown});
  }
  sheet.remedy(tester_.activity(), "vsu.test_lanes");
  sheet.remedy(chunk_room_, WaitFor::kRoom, "vsu.queue_entries");
  sheet.remedy(node_room_, WaitFor::kRoom, "vsu.node_queue_entries");
  sheet.remedy(tester_.slots(), WaitFor::kRoom, "vsu.nodes_in_test");
  sheet.remedy(memory, WaitFor::kReads, "vsu.nodes_in_flight");
  sheet.remedy(memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.signal("group", group_);
  sheet.signal("chunk", current_chunk_);
}

void ExactVsu::Aside::put_aside(const WalkEntry& entry) {
  static_assert(sizeof(WalkEntry) == kWalkEntryBytes);
  vsu_.memory.charge_to(vsu_.group_);
  start_write(vsu_.memory, vsu_.walk_, span_.base + std::uint64_t{count_} * kWalkEntryBytes, &entry,
              kWalkEntryBytes, span_.region);
  ++count_;
}

std::vector<WalkEntry> ExactVsu::Aside::take_back() {
  std::vector<WalkEntry> entries(count_);
  vsu_.memory.charge_to(vsu_.group_);
  await_all(vsu_.memory, vsu_.walk_);  // they have been written
  await(vsu_.memory, vsu_.walk_,
        start_read(vsu_.memory, vsu_.walk_, span_.base, entries.data(), count_ * kWalkEntryBytes,
                   span_.region));
  count_ = 0;
  return entries;
}

void ExactVsu::Aside::forget_aside() {
  await_all(vsu_.memory, vsu_.walk_);  // or they could overtake the next group's
  count_ = 0;
}

}  // namespace sgs
