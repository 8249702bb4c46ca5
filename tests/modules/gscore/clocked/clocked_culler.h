// The culler register by register: the control of the walk, a cycle for each of its steps; nodes on
// their way from memory; the lanes of the test; nodes that have been tested ahead of their turn;
// the FIFO of visible chunks; and what joins these and cuts them into slices. Which node is next is
// the descent's own (algorithm/order/chunk_descent.h).
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "algorithm/order/chunk_descent.h"
#include "tests/modules/clocked/clocked_chunk_tests.h"
#include "tests/modules/clocked/clocked_fifo.h"
#include "tests/modules/clocked/clocked_port.h"

namespace sgs::test {

struct CullerHardware {
  std::uint32_t nodes_in_flight = 8, nodes_in_test = 8, nodes_tested = 32;
  std::uint32_t slice_gaussians = 8;
  ChunkTestHardware tests;
  PortHardware port = {};
};

class ClockedCuller {
 public:
  // nodes: of the tree, at their places in memory; they outlive it as the view does.
  ClockedCuller(const CullerHardware& hardware, const View<float>& view,
                const std::vector<ChunkNode>& nodes, const RecordArray& places)
      : hw_(hardware),
        port_(hardware.port),
        frustum_(view, {0, 0, view.width, view.height}),
        nodes_(nodes),
        places_(places),
        tests_(hardware.tests, nodes) {}

  // A slice as a number: its first slot, its count, whether it is the last of its pass.
  static std::uint64_t what_of(std::uint32_t first, std::uint32_t count, bool last) {
    return std::uint64_t{first} << 32U | count << 1U | (last ? 1U : 0U);
  }

  // passes: a number for each; slices: one FIFO a CCU, taken in turn in every pass.
  void step(ClockedFifo<std::uint64_t>& passes, std::vector<ClockedFifo<std::uint64_t>>& slices) {
    port_.begin_cycle();
    hand_out(slices);
    walk(passes);
    tests_.step(now_);
    for (InFlight& node : in_flight_) node.came = port_.answered(node.read);
    visible_.step();
    ++now_;
  }

 private:
  struct Node {
    std::uint32_t at = 0;
  };
  struct InFlight {
    Node node;
    ClockedTransfer read;
    bool came = false;  // by the last edge
  };
  struct Tested {
    std::uint32_t at;
    InnerNodes unasked;
  };
  struct Chunk {
    std::uint32_t first = 0, count = 0;
    bool end = false;  // of the pass
  };

  // What the step before gives on. False: it waits for the port, or for room.
  bool finish_step() {
    if (to_test_) tests_.put(*std::exchange(to_test_, std::nullopt));
    if (to_read_) {
      if (!port_.read(to_read_->read)) return false;
      in_flight_.push_back(*std::exchange(to_read_, std::nullopt));
    }
    return true;
  }

  void walk(ClockedFifo<std::uint64_t>& passes) {
    if (busy_) {
      busy_ = false;
      if (!finish_step()) {
        busy_ = true;
        return;
      }
    }
    if (!to_show_.empty()) {
      if (!visible_.has_room()) return;
      visible_.put(to_show_.front());
      to_show_.pop_front();
      busy_ = true;
      return;
    }
    if (!in_pass_) {
      if (!passes.can_take()) return;
      passes.take();
      descent_.begin(nodes_.empty());
      in_pass_ = true;
    }
    if (descent_.done()) {
      in_pass_ = false;
      to_show_.push_back({0, 0, true});
      walk(passes);
      return;
    }
    busy_ = ask() || open_next() || take_tested() || begin_test();
  }
  bool ask() {
    const std::size_t under_way = in_flight_.size() + tests_.used() + tested_.size();
    if (in_flight_.size() == hw_.nodes_in_flight || under_way == hw_.nodes_tested) return false;
    InnerNodes* from = descent_.unasked_next();
    if (from == nullptr && 2 * under_way >= hw_.nodes_tested) return false;
    if (from == nullptr) {
      std::uint32_t least = ~0U;
      for (Tested& node : tested_) {
        if (node.unasked.empty() || nodes_[node.at].first_slot >= least) continue;
        least = nodes_[node.at].first_slot;
        from = &node.unasked;
      }
    }
    if (from == nullptr) from = descent_.unasked_above();
    if (from == nullptr) return false;
    const std::uint32_t node = from->front();
    from->remove_front();
    to_read_ = InFlight{{node}, {places_.address(node), places_.record_bytes}};
    return true;
  }
  bool open_next() {
    const auto found = std::find_if(tested_.begin(), tested_.end(),
                                    [&](const Tested& t) { return t.at == descent_.next(); });
    if (found == tested_.end()) return false;
    const Tested tested = *found;
    const ChunkNode& node = nodes_[tested.at];
    tested_.erase(found);
    descent_.open(node, touching_children(node, frustum_), tested.unasked,
                  [&](std::uint32_t first, std::uint32_t count) {
                    to_show_.push_back({first, count});
                  });
    return true;
  }
  bool take_tested() {
    if (!tests_.can_take()) return false;
    const std::uint32_t at = tests_.take().at;
    tested_.push_back({at, touching_inner(nodes_[at], touching_children(nodes_[at], frustum_))});
    return true;
  }
  bool begin_test() {
    if (in_flight_.empty() || !in_flight_.front().came) return false;
    if (tests_.used() == hw_.nodes_in_test) return false;
    to_test_ = in_flight_.front().node;
    in_flight_.pop_front();
    tests_.take_place();
    return true;
  }

  // A cycle for a chunk, and one for each slice that it ends.
  void hand_out(std::vector<ClockedFifo<std::uint64_t>>& slices) {
    if (!out_.empty()) {
      ClockedFifo<std::uint64_t>& to = slices[out_.front().first % slices.size()];
      if (!to.has_room()) return;
      to.put(out_.front().second);
      out_.pop_front();
      return;
    }
    if (!visible_.can_take()) return;
    const Chunk chunk = visible_.take();
    const bool joins = !chunk.end && end_ > first_ && chunk.first == end_;
    if (!joins) cut(true);
    if (chunk.end) {
      give(last_.value_or(std::pair{0U, 0U}), true);
      last_.reset();
      first_ = end_ = 0;
      turn_ = 0;
      return;
    }
    if (!joins) first_ = chunk.first;
    end_ = chunk.first + chunk.count;
    cut(false);
  }
  void cut(bool all) {
    while (first_ < end_) {
      std::uint32_t to = first_ / hw_.slice_gaussians * hw_.slice_gaussians + hw_.slice_gaussians;
      if (to > end_) {
        if (!all) return;
        to = end_;
      }
      if (last_) give(*last_, false);
      last_ = std::pair{first_, to - first_};
      first_ = to;
    }
  }
  void give(std::pair<std::uint32_t, std::uint32_t> slice, bool last) {
    out_.emplace_back(turn_++, what_of(slice.first, slice.second, last));
  }

  const CullerHardware hw_;
  ClockedPort port_;
  const GroupFrustum frustum_;
  const std::vector<ChunkNode>& nodes_;
  const RecordArray places_;
  ClockedChunkTests<Node> tests_;
  std::uint64_t now_ = 0;
  bool busy_ = false, in_pass_ = false;
  ChunkDescent descent_;
  std::optional<InFlight> to_read_;
  std::optional<Node> to_test_;
  std::deque<InFlight> in_flight_;
  std::vector<Tested> tested_;
  std::deque<Chunk> to_show_;
  ClockedFifo<Chunk> visible_{8};
  std::uint32_t first_ = 0, end_ = 0;
  std::optional<std::pair<std::uint32_t, std::uint32_t>> last_;
  std::uint64_t turn_ = 0;
  std::deque<std::pair<std::uint64_t, std::uint64_t>> out_;  // turn, slice
};

}  // namespace sgs::test
