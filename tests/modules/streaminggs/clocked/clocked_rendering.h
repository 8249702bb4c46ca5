// The rendering unit register by register: the lanes that begin spans and those of rows, the slots
// of splats, the dispatcher with the row that it holds, queue, bank and scoreboard of each cluster,
// the mask of finished sub-tiles, and the draining of the group before.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "tests/modules/clocked/clocked_fifo.h"
#include "tests/modules/clocked/clocked_port.h"

namespace sgs::test {

struct RenderingHardware {
  std::uint32_t clusters = 4, blend_interval = 3, queue_entries = 8;
  std::uint32_t depth = 47, state_loop = 9;
  std::uint32_t begin_interval = 7, begin_depth = 77, rows_at_once = 1, row_interval = 2;
  std::uint32_t row_depth = 39, slots = 48;
  std::uint32_t pixel_buffers = 1, drain_depth = 10;
  bool one_port = false;  // of a memory of pixels
  PortHardware port = {};
};

// A sub-tile that a splat reaches, by its place in the group.
struct ClockedReach {
  std::uint32_t at = 0, row = 0, cluster = 0;
  bool finishes = false;
};
struct RenderingItem {
  bool is_splat = false, ends_group = false;
  std::uint32_t rows = 0, spans = 0;
  std::vector<std::uint32_t> footprint;
  std::vector<ClockedReach> reaches;
};
// A group's pixels on their way out, row by row.
struct DrainedGroup {
  std::uint32_t subtiles = 0;
  std::uint32_t row_cycles = 0;  // of a row of pixels
  std::vector<ClockedTransfer> rows;
};
// A group, and from which cycle on all of its sub-tiles are known to be finished.
struct GroupNews {
  std::uint32_t group;
  std::uint64_t cycle;
};

class ClockedRendering {
 public:
  ClockedRendering(const RenderingHardware& hardware, std::vector<DrainedGroup> groups)
      : hw_(hardware),
        port_(hardware.port),
        groups_(std::move(groups)),
        free_buffers_(hardware.pixel_buffers) {
    clusters_.resize(hw_.clusters);
  }

  bool done() const { return drained_ == groups_.size() && port_.idle(); }
  const std::vector<GroupNews>& finished() const { return finished_groups_; }

  void step(std::vector<ClockedFifo<RenderingItem>>& in) {
    port_.begin_cycle();
    drain();
    if (!open_) open_group();
    if (open_) {
      for (Cluster& cluster : clusters_) blend(cluster);
      if (ended_ && all_done()) close_group();
    }
    if (!open_) open_group();
    if (open_) {
      take(in);
      dispatch();
    }
    ++now_;
    for (Cluster& cluster : clusters_) {
      cluster.busy -= cluster.busy > 0 ? 1 : 0;
      cluster.visible = cluster.queue.size();
      write(cluster);
    }
    for (std::uint32_t& left : loop_) left -= left > 0 ? 1 : 0;
    for (std::uint32_t& left : known_in_) left -= left > 0 && left != kNever ? 1 : 0;
    for (std::uint32_t& left : blended_) --left;
    while (!blended_.empty() && blended_.front() == 0) {
      blended_.pop_front();
      ++waiting_;
    }
  }

 private:
  static constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();
  struct Cluster {
    std::deque<ClockedReach> queue;
    std::size_t visible = 0;  // entries that were there at the last edge
    std::uint32_t busy = 0;
    std::deque<std::uint32_t> writes;  // of blends under way: cycles left
  };
  struct Slot {
    RenderingItem item;
    std::uint64_t rows_from = 0;  // its first row is on the lanes
  };

  void open_group() {
    if (group_ == groups_.size() || free_buffers_ == 0) return;
    --free_buffers_;
    open_ = true;
    ended_ = false;
    unfinished_ = groups_[group_].subtiles;
    loop_.assign(groups_[group_].subtiles, 0);
    known_in_.assign(groups_[group_].subtiles, kNever);
  }
  bool all_done() const {
    return slots_.empty() && now_ > last_token_ && now_ > dispatched_ &&
           std::all_of(clusters_.begin(), clusters_.end(),
                       [](const Cluster& c) { return c.queue.empty() && c.busy == 0; });
  }
  void close_group() {
    blended_.push_back(hw_.depth + hw_.drain_depth);
    ++group_;
    open_ = false;
  }
  bool turn(std::uint32_t interval) const { return now_ % interval == 0; }

  void blend(Cluster& cluster) {
    if (cluster.visible == 0 || cluster.busy > 0 || !turn(hw_.blend_interval)) return;
    const ClockedReach reach = cluster.queue.front();
    if (loop_[reach.at] > 0) return;
    cluster.queue.pop_front();
    cluster.busy = hw_.blend_interval;
    loop_[reach.at] = hw_.state_loop;
    cluster.writes.push_back(hw_.state_loop - 1);
    if (!reach.finishes) return;
    known_in_[reach.at] = hw_.depth;
    if (--unfinished_ == 0) {
      finished_groups_.push_back({static_cast<std::uint32_t>(group_), now_ + hw_.depth});
    }
  }

  // In the last cycle of the loop; a blend that begins in this cycle has the only port.
  void write(Cluster& cluster) {
    const bool writes = !cluster.writes.empty() && cluster.writes.front() == 0;
    const bool reads = !cluster.writes.empty() && cluster.writes.back() == hw_.state_loop - 1;
    if (hw_.one_port && reads && writes) {
      throw std::logic_error("a memory of pixels is read and written in one cycle");
    }
    if (writes) cluster.writes.pop_front();
    for (std::uint32_t& left : cluster.writes) --left;
  }

  void take(std::vector<ClockedFifo<RenderingItem>>& in) {
    if (begins_) {
      begin();
      return;
    }
    ClockedFifo<RenderingItem>& from = in[turn_ % in.size()];
    if (ended_ || slots_.size() == hw_.slots || !from.can_take()) return;
    RenderingItem item = from.take();
    ++turn_;
    last_token_ = now_;
    ended_ = item.ends_group;
    if (!item.is_splat) return;
    const bool hidden = std::all_of(item.footprint.begin(), item.footprint.end(),
                                    [&](std::uint32_t at) { return known_in_[at] == 0; });
    if (hidden) return;
    const bool spanned = item.spans > 0;
    slots_.push_back({std::move(item)});
    if (!spanned) return;
    begins_ = true;
    begin();
  }
  // The splat that was taken last, in the lanes' turn; its rows follow in theirs.
  void begin() {
    if (!turn(hw_.begin_interval)) return;
    Slot& slot = slots_.back();
    std::uint64_t row = std::max<std::uint64_t>(now_ + hw_.begin_depth, rows_free_);
    while (row % hw_.row_interval != 0) ++row;
    slot.rows_from = row;
    const std::uint32_t turns = (slot.item.spans + hw_.rows_at_once - 1) / hw_.rows_at_once;
    rows_free_ = row + std::uint64_t{turns} * hw_.row_interval;
    begins_ = false;
    last_token_ = now_;
  }

  void dispatch() {
    if (slots_.empty() || (begins_ && slots_.size() == 1)) return;
    const Slot& slot = slots_.front();
    if (!row_) {
      if (slot.item.spans > 0) {
        const std::uint64_t begun = slot.rows_from + rows_ / hw_.rows_at_once * hw_.row_interval;
        if (now_ < begun + hw_.row_depth) return;
      }
      row_.emplace();
      for (const ClockedReach& reach : slot.item.reaches) {
        if (reach.row == rows_) row_->push_back(reach);
      }
      ++rows_;
    }
    hand_out(*row_);
    if (!row_->empty()) return;
    row_.reset();
    if (rows_ < slot.item.rows) return;
    rows_ = 0;
    slots_.pop_front();
    dispatched_ = now_;
  }
  // Each queue takes the first of its own of what is left and unfinished.
  void hand_out(std::vector<ClockedReach>& row) {
    std::vector<bool> asked(clusters_.size(), false);
    std::vector<ClockedReach> left;
    for (const ClockedReach& reach : row) {
      if (known_in_[reach.at] == 0) continue;
      Cluster& cluster = clusters_[reach.cluster];
      if (!asked[reach.cluster] && cluster.queue.size() < hw_.queue_entries) {
        cluster.queue.push_back(reach);
      } else {
        left.push_back(reach);
      }
      asked[reach.cluster] = true;
    }
    row = std::move(left);
  }

  // A row of pixels, then its transactions. While their words leave, the next row is read, unless
  // that is faster; it stands still while a transaction waits to leave.
  void drain() {
    if (!draining_) {
      if (waiting_ == 0) return;
      --waiting_;
      draining_ = true;
      row_at_ = 0;
      reading_ = groups_[drained_].row_cycles;
    }
    step_drain();
  }
  void step_drain() {
    const DrainedGroup& group = groups_[drained_];
    if (leaving_ && port_.sending()) {
      if (reads_beside_) read();
      return;
    }
    if (!leaving_ && reading_ > 0) {
      read();
      return;
    }
    if (clearing_) {
      clearing_ = draining_ = false;
      ++drained_;
      ++free_buffers_;
      drain();
      return;
    }
    // The row stands in a register: its transactions leave.
    ClockedTransfer& row = groups_[drained_].rows[row_at_];
    const std::uint64_t bytes = row.bytes;
    const bool has_left = port_.write(row);
    if (row.bytes == bytes) return;
    const bool is_last = row_at_ + 1 == group.rows.size();
    if (!leaving_) {
      reading_ = is_last ? 0 : group.row_cycles;
      reads_beside_ = group.row_cycles >= port_.words(bytes);
    }
    leaving_ = !has_left;
    if (has_left || reads_beside_) read();
    if (!has_left) return;
    ++row_at_;
    clearing_ = is_last;
  }
  void read() { reading_ -= reading_ > 0 ? 1 : 0; }

  const RenderingHardware hw_;
  ClockedPort port_;
  std::vector<DrainedGroup> groups_;
  std::vector<GroupNews> finished_groups_;
  std::uint64_t now_ = 0;
  std::size_t group_ = 0, drained_ = 0, waiting_ = 0;
  std::uint32_t free_buffers_, unfinished_ = 0;  // sub-tiles
  bool open_ = false, ended_ = false, begins_ = false;
  std::vector<Cluster> clusters_;
  std::vector<std::uint32_t> loop_, known_in_;  // [sub-tile] cycles left
  std::deque<Slot> slots_;
  std::uint64_t turn_ = 0, last_token_ = 0, rows_free_ = 0, dispatched_ = 0;
  std::uint32_t rows_ = 0;                        // of the first slot, taken so far
  std::optional<std::vector<ClockedReach>> row_;  // what is left of the one that is held
  std::deque<std::uint32_t> blended_;             // groups in the last stages: cycles left
  bool draining_ = false, clearing_ = false;
  std::size_t row_at_ = 0;     // that is read or leaves
  std::uint32_t reading_ = 0;  // cycles left, of it or, while it leaves, of the next
  bool leaving_ = false;       // a part of the row has left
  bool reads_beside_ = false;
};

}  // namespace sgs::test
