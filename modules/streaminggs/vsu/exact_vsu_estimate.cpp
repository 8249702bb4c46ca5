// Nodes and chunks of one walk after the other.
#include "modules/streaminggs/vsu/exact_vsu_estimate.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "algorithm/voxel/chunk_node.h"
#include "modules/datapath/work_rates.h"
#include "modules/streaminggs/vsu/chunk_tester.h"

namespace sgs {
namespace {

constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kWindowCycles = 16;  // in which the queues' operations come as if at once

}  // namespace

ExactVsuEstimate::ExactVsuEstimate(const ExactVsuConfig& config, const Datapath& lanes,
                                   const RecordArray& table,
                                   const std::vector<ExactGroupWork>& groups,
                                   const PortEstimate& port, Hidden hidden)
    : config_(config),
      lanes_(lanes),
      table_(table),
      port_(port),
      hidden_(std::move(hidden)),
      walk_(kWindowCycles),
      ready_(kReadyVisits),
      room_(kReadyVisits),
      fetched_(config.nodes_in_flight),
      tested_(config.nodes_in_test),
      groups_(groups) {
  const std::uint64_t upper = std::min<std::uint64_t>(config.upper_nodes, table.count);
  if (upper == 0) return;
  last_read_ =
      port_.read(0, table.base, static_cast<std::uint32_t>(upper * sizeof(ChunkNode)), table.region)
          .answered;
}

// An operation of a queue, or a step that has none, takes a cycle at least.
std::uint64_t ExactVsuEstimate::queue_cycles(std::uint64_t operations) const {
  return std::max<std::uint64_t>(1, operations * config_.cycles_per_queue_operation);
}

void ExactVsuEstimate::begin_group() {
  if (walks_.empty()) begin_walk(last_read_);
}

void ExactVsuEstimate::begin_walk(std::uint64_t cycle) {
  Walk& walk = walks_.emplace_back();
  walk.group = next_group_;
  walk.work = &groups_[next_group_++];
  walk.nodes.resize(walk.work->nodes.size());
  for (auto number = static_cast<std::uint32_t>(walk.nodes.size()); number-- > 1;) {
    Node& parent = walk.nodes[walk.work->nodes[number].parent];
    walk.nodes[number].next_child = parent.first_child;
    parent.first_child = number;
  }
  last_read_ = walk_.book(cycle, queue_cycles(1));
  if (!walk.nodes.empty()) walk.coming.emplace(last_read_, 0);
}

// As ChunkWalk::has_room_for_another(), and needs_node().
bool ExactVsuEstimate::has_room(const Walk& walk, std::uint64_t cycle) const {
  const bool of_first = &walk == &walks_.front() && cycle >= ended_;
  const bool has_chunk = chunks_taken_ < taken_.size() && final_[chunks_taken_] <= cycle;
  const bool starves = of_first && !has_chunk;
  if (starves && opening_.empty()) return true;
  std::uint64_t nodes = 0;
  for (const Walk& of : walks_) nodes += of.known.size();
  const std::uint64_t children = (opening_.size() + 1) * kChunkNodeWidth;
  const auto fit = [&](std::uint64_t entries, std::uint64_t capacity) {
    return capacity >= entries + children + (starves ? 0 : capacity / 4);
  };
  return fit(chunks_known_ - std::min(chunks_known_, chunks_taken_), config_.queue_entries) &&
         fit(nodes, config_.node_queue_entries);
}

void ExactVsuEstimate::look_around(std::uint64_t cycle) {
  for (; !opening_.empty() && opening_.front().entered <= cycle; opening_.pop_front()) {
    chunks_known_ += opening_.front().chunks;
  }
  while (chunks_taken_ < taken_.size() && taken_[chunks_taken_] <= cycle) ++chunks_taken_;
  for (Walk& walk : walks_) {
    for (; !walk.coming.empty() && walk.coming.top().first <= cycle; walk.coming.pop()) {
      walk.known.push(walk.coming.top().second);
    }
  }
}

// The nearest node that is known, of the group at hand or, where of that none is, of the next.
void ExactVsuEstimate::read_next() {
  for (std::uint64_t at = last_read_;;) {
    look_around(at);
    std::uint64_t next = opening_.empty() ? kNever : opening_.front().entered;
    Walk* nearest = nullptr;
    for (Walk& walk : walks_) {
      if (!walk.coming.empty()) next = std::min(next, walk.coming.top().first);
      if (nearest == nullptr && !walk.known.empty()) nearest = &walk;
    }
    if (nearest == nullptr && walks_.size() == 1 && next_group_ < groups_.size()) {
      if (at >= ended_) {
        begin_walk(at);
        at = last_read_;
        continue;
      }
      next = std::min(next, ended_);
    }
    if (nearest != nullptr) {
      const std::uint32_t number = nearest->known.top();
      if (has_room(*nearest, at)) {
        nearest->known.pop();
        read(*nearest, number, at);
        return;
      }
      if (chunks_taken_ < taken_.size()) next = std::min(next, taken_[chunks_taken_]);
      if (chunks_taken_ < final_.size() && final_[chunks_taken_] > at) {
        next = std::min(next, final_[chunks_taken_]);
      }
      if (at < ended_) next = std::min(next, ended_);
    }
    at = next;
  }
}

bool ExactVsuEstimate::leave_out(const Walk& walk, const NodeWork& node, std::uint64_t cycle) {
  ++work_.counters.looked_up;
  if (&walk != &walks_.front() || !hidden_(node.reach, cycle)) return false;
  ++work_.counters.nodes_hidden;
  return true;
}

void ExactVsuEstimate::read(Walk& walk, std::uint32_t number, std::uint64_t cycle) {
  const NodeWork& node = walk.work->nodes[number];
  Node& own = walk.nodes[number];
  own.read = true;
  const bool on_chip = node.at < config_.upper_nodes;
  std::uint64_t& slot = fetched_[fetches_ % fetched_.size()];
  const std::uint64_t place = tested_[puts_ % tested_.size()];
  const std::uint64_t at = std::max(cycle, on_chip ? place : slot);
  own.left_out = leave_out(walk, node, at);
  last_read_ = walk_.book(at, queue_cycles(1));
  if (!own.left_out) {
    std::uint64_t put = last_read_;
    if (on_chip) {
      ++work_.counters.upper_reads;
    } else {
      ++work_.counters.nodes_read;
      ++fetches_;
      port_.charge_to(walk.group);
      const auto [sent, answered] =
          port_.read(put, table_.address(node.at), sizeof(ChunkNode), table_.region);
      slot = std::max({answered + 1, place, last_put_});
      last_read_ = std::max(last_read_, sent);
      put = walk_.book(slot, 1);
    }
    own.entered = test(node, put);
    const std::uint32_t known_before = number == 0 ? 0 : walk.work->nodes[number - 1].chunks_known;
    opening_.push_back({own.entered, node.chunks_known - known_before, walk.group});
    for (std::uint32_t child = own.first_child; child > 0; child = walk.nodes[child].next_child) {
      walk.coming.emplace(own.entered, child);
    }
  } else {
    // Nothing below is ever known.
    for (std::uint32_t child = own.first_child; child > 0; child = walk.nodes[child].next_child) {
      leave_out_below(walk, child);
    }
  }
  while (walk.read < walk.nodes.size() && walk.nodes[walk.read].read) ++walk.read;
}

void ExactVsuEstimate::leave_out_below(Walk& walk, std::uint32_t number) {
  walk.nodes[number].read = true;
  for (std::uint32_t child = walk.nodes[number].first_child; child > 0;
       child = walk.nodes[child].next_child) {
    leave_out_below(walk, child);
  }
}

// The cycle in which its children are in the queues.
std::uint64_t ExactVsuEstimate::test(const NodeWork& node, std::uint64_t put) {
  last_put_ = put;
  const std::uint64_t interval = lanes_.interval_cycles();
  const std::uint64_t comes = std::max(put + 1, tests_free_);
  tests_free_ = next_turn(comes, interval) + node.children * interval;
  test_busy_ += tests_free_ - comes;
  ++work_.walked.walk.nodes;
  work_.walked.walk.tests += node.children;
  const std::uint64_t left =
      tests_free_ + ChunkTester::cycles_behind_lanes(config_.test_depth_cycles, interval);
  const std::uint64_t entered = walk_.book(left, queue_cycles(node.entered));
  tested_[puts_++ % tested_.size()] = entered;
  return entered;
}

std::uint64_t ExactVsuEstimate::take_chunk(const VisitWork& chunk) {
  Walk& walk = walks_.front();
  while (walk.read < chunk.nodes) read_next();
  for (; walk.open < chunk.nodes; ++walk.open) {
    walk.entered = std::max(walk.entered, walk.nodes[walk.open].entered);
  }
  const std::uint64_t room = room_[ready_.pushed() % room_.size()];
  final_.push_back(std::max(walk.entered, last_take_));
  last_take_ = walk_.book(std::max(final_.back(), room), queue_cycles(1));
  taken_.push_back(last_take_);
  return last_take_;
}

bool ExactVsuEstimate::hidden(const VisitWork& chunk, std::uint64_t cycle) {
  ++work_.counters.looked_up;
  if (!hidden_(chunk.reach, cycle)) return false;
  ++work_.counters.chunks_hidden;
  return true;
}

std::uint64_t ExactVsuEstimate::give(std::uint64_t now) {
  std::uint64_t& room = room_[ready_.pushed() % room_.size()];
  ready_.push(now);
  const std::uint64_t popped = ready_.pop(hand_out_);
  room = popped + 1;
  hand_out_ = popped + 1;
  ++handed_out_;
  return hand_out_;
}

void ExactVsuEstimate::end_group(std::uint64_t now, bool saturated) {
  const Walk& walk = walks_.front();
  work_.counters.groups_saturated += saturated ? 1 : 0;
  work_.counters.groups_empty += walk.work->visits.empty() ? 1 : 0;
  ended_ = last_take_ = walk_.book(std::max(now, last_take_), 1);
  walks_.pop_front();
  // What is left of it in the queue is dropped: there are those of the next group alone.
  for (Opening& node : opening_) {
    if (node.group + 1 < next_group_ || walks_.empty()) node.chunks = 0;
  }
  std::uint64_t of_next = 0;
  for (const Walk& next : walks_) {
    for (std::size_t n = 0; n < next.nodes.size(); ++n) {
      if (!next.nodes[n].read || next.nodes[n].left_out) continue;
      of_next +=
          next.work->nodes[n].chunks_known - (n == 0 ? 0 : next.work->nodes[n - 1].chunks_known);
    }
  }
  for (const Opening& node : opening_) of_next -= node.chunks;
  chunks_taken_ = taken_.size();
  chunks_known_ = chunks_taken_ + of_next;
}

ExactVsu::Work ExactVsuEstimate::work() const {
  ExactVsu::Work work = work_;
  work.walk_cycles = walk_.busy_cycles();
  work.test_cycles = test_busy_;
  work.hand_out_cycles = handed_out_;
  work.ready_entries = ready_.pushed();
  work.traffic = port_.traffic();
  return work;
}

}  // namespace sgs
