// Schedule of the rendering unit: which cluster blends which sub-tile in which cycle.
//
// A splat's spans are begun on `begin_lanes`, `begin_depth_cycles` late; then its rows of sub-tiles
// get theirs on `span_lanes`, `span_depth_cycles` late; both in their turns. As many splats as
// there are `span_slots` are under way or wait there for a dispatcher. It takes them in order, one
// row a cycle at most, with or without sub-tiles in it. It ands the row's span with that row of the
// mask of finished sub-tiles. Each cluster's queue takes at most one of the remaining sub-tiles a
// cycle: the first of its own. The row stands, and is anded again, until none remains. The mask
// says at once if a splat's whole footprint is finished when it comes; it then takes one cycle of
// the lanes, no spans and no slot.
//
// Sub-tile (x, y) belongs to cluster (x + 2 y) mod clusters, whose bank holds its pixels:
// neighbours lie in different banks. A cluster takes one sub-tile from its queue, in order, in each
// of its turns, every `cluster_interval_cycles()`. It waits until the splat ahead on the same
// sub-tile has left the loop through the pixel state: a scoreboard says which sub-tiles are in it.
// A sub-tile is known to be finished when the blend that finished it has left the pipeline; until
// then splats go on being blended into it, which changes nothing and costs the same.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "algorithm/render/group_state.h"
#include "modules/datapath/work_rates.h"
#include "modules/streaminggs/rendering/rendering_config.h"
#include "tlm/counter.h"

namespace sgs {

// The cluster, of so many, that has the pixels of a sub-tile of a group.
constexpr std::size_t cluster_at(int x, int y, std::size_t clusters) {
  return static_cast<std::size_t>(x + 2 * y) % clusters;
}

class ClusterSchedule {
 public:
  struct Counters : CounterSet {
    Counter rows{*this, "rows", "rows", "of sub-tiles that the dispatcher took"};
    Counter subtile_blends{*this, "subtile_blends", "sub-tiles", "blended"};
    Counter subtile_blends_late{*this, "subtile_blends_late", "sub-tiles",
                                "of these finished already, which was not known yet"};
    Counter hazard_cycles{*this, "hazard_cycles", "cycles",
                          "that clusters waited for the splat ahead on a sub-tile"};
    Counter queue_cycles{*this, "queue_cycles", "cycles",
                         "that sub-tiles waited for room at their cluster"};
    std::uint64_t row_cycles = 0;    // in which the dispatcher held rows
    std::uint64_t finished = 0;      // sub-tiles
    std::uint64_t begin_cycles = 0;  // in which the lanes that begin spans were taken
    std::uint64_t span_cycles = 0;   // in which the lanes of the rows were taken
  };

  explicit ClusterSchedule(const RenderingConfig& config)
      : config_(config),
        begin_interval_(config.begin_interval_cycles()),
        span_interval_(config.span_interval_cycles()),
        spans_at_once_(config.spans_at_once()),
        cluster_interval_(config.cluster_interval_cycles()),
        clusters_(config.clusters,
                  Cluster{0, 0, 0, std::vector<std::uint64_t>(config.cluster_queue_entries)}),
        slot_free_(config.span_slots, 0) {}

  void begin_group(std::size_t subtiles, std::size_t columns) {
    free_from_.assign(subtiles, 0);
    finished_from_.assign(subtiles, std::numeric_limits<std::uint64_t>::max());
    columns_ = columns;
  }

  // True if some sub-tile of the box is not known to be finished in cycle `now`.
  bool any_unfinished(const SubtileRect& box, std::uint64_t now) const {
    for (std::size_t y = box.y0; y < box.y1; ++y) {
      for (std::size_t x = box.x0; x < box.x1; ++x) {
        if (finished_from_[y * columns_ + x] > now) return true;
      }
    }
    return false;
  }

  // A splat is there in cycle `now`. spanned: its rows get spans.
  void begin_splat(std::uint64_t now, bool spanned) {
    begin_ = now;
    spanned_ = spanned;
    rows_ = 0;
    if (!spanned) return;
    begin_ = next_turn(std::max(now, begins_free_), begin_interval_);
    begins_free_ = begin_ + begin_interval_;
    spans_from_ =
        next_turn(std::max(begin_ + config_.begin_depth_cycles, spans_free_), span_interval_);
    counters_.begin_cycles += begin_interval_;
  }

  // Sub-tiles that it reaches, row by row.
  void reach(const SubtileReach& subtile) {
    take_rows(subtile.row + 1);
    Cluster& cluster = cluster_of(subtile.x, subtile.y);
    const std::uint64_t in_turn = std::max(row_begin_, cluster.next_push);
    std::uint64_t& slot = cluster.taken[cluster.jobs % cluster.taken.size()];
    const std::uint64_t room = std::max(in_turn, slot);
    const std::uint64_t known = finished_from_[subtile.at];
    const std::uint64_t leaves = std::max(row_begin_, std::min(room, known));
    counters_.queue_cycles += std::max(in_turn, leaves) - in_turn;
    row_end_ = std::max(row_end_, leaves);
    if (room >= known) {
      cluster.next_push = std::max(cluster.next_push, leaves);
      return;
    }
    cluster.next_push = room + 1;
    const std::uint64_t free = next_turn(std::max(room + 1, cluster.free_from), cluster_interval_);
    const std::uint64_t taken =
        next_turn(std::max(free, free_from_[subtile.at]), cluster_interval_);
    counters_.hazard_cycles += taken - free;
    slot = taken;
    ++cluster.jobs;
    cluster.free_from = taken + cluster_interval_;
    free_from_[subtile.at] = taken + config_.state_loop_cycles;
    done_ = std::max(done_, cluster.free_from);
    if (subtile.finishes) {
      finished_from_[subtile.at] = taken + config_.depth_cycles;
      ++counters_.finished;
    }
    ++counters_.subtile_blends;
    counters_.subtile_blends_late += subtile.blends ? 0 : 1;
  }

  // The cycle in which the next splat can be taken: this one has begun, and there is a slot. rows:
  // of this one, 1 or more, whose slot is free when its last row is dispatched; spans: of them, or
  // 0.
  std::uint64_t end_splat(std::uint32_t rows, std::uint32_t spans) {
    take_rows(rows);
    end_row();
    dispatched_ = row_end_ + 1;
    slot_free_[splats_++ % slot_free_.size()] = dispatched_;
    if (spanned_) {
      const std::uint64_t cycles = cycles_for(spans, spans_at_once_) * span_interval_;
      spans_free_ = spans_from_ + cycles;
      counters_.span_cycles += cycles;
    }
    return std::max(begin_ + 1, slot_free_[splats_ % slot_free_.size()]);
  }

  // The cycle in which every splat is dispatched and every cluster is free again.
  std::uint64_t all_done() const { return std::max(done_, dispatched_); }
  // Cycle from which on this sub-tile is known to be finished.
  std::uint64_t subtile_finished_from(std::size_t at) const { return finished_from_[at]; }
  // Cycle from which on every sub-tile of the group is known to be finished; 0 for none.
  std::uint64_t group_finished_from() const {
    const auto last = std::max_element(finished_from_.begin(), finished_from_.end());
    return last == finished_from_.end() ? 0 : *last;
  }
  const Counters& counters() const { return counters_; }
  // Cycles in which the mean cluster blended, or waited for the splat ahead.
  std::uint64_t cluster_cycles() const {
    return (counters_.subtile_blends * cluster_interval_ + counters_.hazard_cycles) /
           config_.clusters;
  }

 private:
  struct Cluster {
    std::uint64_t next_push, free_from, jobs;
    std::vector<std::uint64_t> taken;  // ring: when the last entries of its queue were taken
  };

  Cluster& cluster_of(int x, int y) { return clusters_[cluster_at(x, y, clusters_.size())]; }

  // The dispatcher holds the last of so many rows.
  void take_rows(std::uint32_t rows) {
    for (; rows_ < rows; ++rows_) {
      if (rows_ > 0) end_row();
      const std::uint64_t free = rows_ > 0 ? row_end_ + 1 : dispatched_;
      const std::uint64_t known = spanned_ ? spans_from_ + rows_ / spans_at_once_ * span_interval_ +
                                                 config_.span_depth_cycles
                                           : begin_;
      row_begin_ = std::max(free, known);
      row_end_ = row_begin_;
    }
  }
  void end_row() {
    ++counters_.rows;
    counters_.row_cycles += row_end_ + 1 - row_begin_;
  }

  const RenderingConfig& config_;
  const std::uint64_t begin_interval_, span_interval_, spans_at_once_, cluster_interval_;
  std::vector<Cluster> clusters_;
  std::vector<std::uint64_t> free_from_;      // [sub-tile] its state can be read again
  std::vector<std::uint64_t> finished_from_;  // [sub-tile] it is known to be finished
  std::size_t columns_ = 0;                   // columns of sub-tiles in the group
  std::vector<std::uint64_t> slot_free_;      // ring: from when on, of the last splats
  std::uint64_t splats_ = 0;
  // dispatched_: from when on the dispatcher is free for the next splat.
  std::uint64_t begin_ = 0, dispatched_ = 0, done_ = 0;
  std::uint64_t begins_free_ = 0, spans_free_ = 0;  // the lanes
  std::uint64_t spans_from_ = 0;                    // the splat's first row begins
  std::uint64_t row_begin_ = 0, row_end_ = 0;       // first and last cycle of the row that is held
  std::uint32_t rows_ = 0;                          // rows of the splat taken so far
  bool spanned_ = false;
  Counters counters_;
};

}  // namespace sgs
