// Nodes and chunks of one walk after the other.
#include "modules/streaminggs/vsu/exact_vsu_estimate.h"

#include <algorithm>
#include <utility>

#include "algorithm/voxel/chunk_node.h"
#include "modules/datapath/work_rates.h"

namespace sgs {
namespace {

constexpr std::uint64_t kWindowCycles = 64;  // in which the queues' operations come as if at once

}  // namespace

ExactVsuEstimate::ExactVsuEstimate(const ExactVsuConfig& config, const Datapath& lanes,
                                   const RecordArray& table, const PortEstimate& port,
                                   Hidden hidden)
    : config_(config),
      lanes_(lanes),
      table_(table),
      port_(port),
      hidden_(std::move(hidden)),
      walk_(kWindowCycles),
      ready_(kReadyVisits),
      room_(kReadyVisits),
      fetched_(config.nodes_in_flight),
      tested_(config.nodes_in_test) {
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

void ExactVsuEstimate::begin_group(std::uint32_t group, const ExactGroupWork& work) {
  group_ = group;
  of_ = &work;
  opened_.clear();
  any_chunk_ = !work.visits.empty();
  chunks_before_ = taken_.size();
  known_ = 0;
  last_read_ = walk_.book(std::max(last_read_, ended_[group % 2]), queue_cycles(1));
}

// Read ahead, a node leaves a quarter of the queue free and a place for each of its children. What
// cannot be had before the chunk at hand is taken is needed for it, and is read all the same.
std::uint64_t ExactVsuEstimate::room_for_chunks() const {
  const std::uint64_t capacity = config_.queue_entries;
  const std::uint64_t most =
      capacity - std::min<std::uint64_t>(capacity, capacity / 4 + kChunkNodeWidth);
  const std::size_t node = opened_.size();
  const std::uint64_t known =
      chunks_before_ + (node == 0 ? 0 : of_->nodes[node - 1].chunks_known);
  if (known <= most || taken_.empty()) return 0;
  return taken_[std::min<std::uint64_t>(known - most, taken_.size()) - 1];
}

ExactVsuEstimate::Opened ExactVsuEstimate::open(const NodeWork& node) {
  const bool root = node.parent == NodeWork::kRoot;
  if (!root && opened_[node.parent].left_out) return {0, true};
  std::uint64_t at = std::max(last_read_, root ? 0 : opened_[node.parent].entered);
  at = std::max(at, room_for_chunks());
  const bool on_chip = node.at < config_.upper_nodes;
  std::uint64_t& slot = fetched_[fetches_ % fetched_.size()];
  std::uint64_t& place = tested_[puts_ % tested_.size()];
  at = std::max(at, on_chip ? place : slot);
  ++work_.counters.looked_up;
  if (hidden_(node.reach, at)) {
    ++work_.counters.nodes_hidden;
    last_read_ = walk_.book(at, queue_cycles(1));
    return {0, true};
  }
  std::uint64_t put = last_read_ = walk_.book(at, queue_cycles(1));
  if (on_chip) {
    ++work_.counters.upper_reads;
  } else {
    ++work_.counters.nodes_read;
    ++fetches_;
    port_.charge_to(group_);
    const auto [sent, answered] =
        port_.read(put, table_.address(node.at), sizeof(ChunkNode), table_.region);
    const std::uint64_t taken = std::max({answered + 1, place, last_put_});
    slot = taken;
    last_read_ = std::max(last_read_, sent);
    put = walk_.book(taken, 1);
  }
  last_put_ = put;
  ++puts_;
  const std::uint64_t interval = lanes_.interval_cycles();
  const std::uint64_t comes = std::max(put + 1, tests_free_);
  tests_free_ = next_turn(comes, interval) + node.children * interval;
  test_busy_ += tests_free_ - comes;
  ++work_.walked.walk.nodes;
  work_.walked.walk.tests += node.children;
  place = walk_.book(tests_free_ + config_.test_depth_cycles, queue_cycles(node.entered));
  return {place, false};
}

std::uint64_t ExactVsuEstimate::take_chunk(const VisitWork& chunk) {
  while (opened_.size() < chunk.nodes) {
    opened_.push_back(open(of_->nodes[opened_.size()]));
    known_ = std::max(known_, opened_.back().entered);
  }
  const std::uint64_t room = room_[ready_.pushed() % room_.size()];
  last_take_ = walk_.book(std::max({known_, last_take_, room}), queue_cycles(1));
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
  work_.counters.groups_saturated += saturated ? 1 : 0;
  work_.counters.groups_empty += any_chunk_ ? 0 : 1;
  ended_[group_ % 2] = last_take_ = walk_.book(std::max(now, last_take_), 1);
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
