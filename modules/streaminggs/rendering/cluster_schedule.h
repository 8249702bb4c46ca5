// When the clusters of the rendering unit blend which sub-tile.
//
// A splat's rows of sub-tiles get their spans on `span_lanes`, `span_depth_cycles` late; as many
// splats as there are `span_slots` are under way or wait there for a dispatcher. It puts the
// sub-tiles of each row, row by row, into the queues of the clusters, at most one a cycle and
// cluster, a splat behind the other. Sub-tile (x, y) belongs to cluster (x + 2 y) mod clusters, whose bank holds
// its pixels: neighbours lie in different banks. A cluster takes one sub-tile every
// `cluster_interval_cycles()` out of its queue, in order, and not before the splat ahead of it on
// the same sub-tile has left the loop through the pixel state. That a sub-tile is finished is known
// when the blend that finished it has left the pipeline; until then splats go on being blended into
// it, which changes nothing and costs the same.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "algorithm/render/group_state.h"
#include "modules/streaminggs/rendering/rendering_config.h"

namespace sgs {

class ClusterSchedule {
 public:
  struct Counters {
    std::uint64_t blends = 0;         // sub-tiles blended
    std::uint64_t late_blends = 0;    // of these into sub-tiles that were finished already
    std::uint64_t hazard_cycles = 0;  // that a cluster waited for the splat ahead
    std::uint64_t queue_cycles = 0;   // that the dispatcher waited for room in a queue
  };

  explicit ClusterSchedule(const RenderingConfig& config)
      : config_(config),
        clusters_(config.clusters,
                  Cluster{0, 0, 0, std::vector<std::uint64_t>(config.cluster_queue_entries)}),
        slot_free_(config.span_slots, 0) {}

  void begin_group(std::size_t subtiles) {
    free_from_.assign(subtiles, 0);
    finished_from_.assign(subtiles, std::numeric_limits<std::uint64_t>::max());
  }

  // A splat is there in cycle `now`.
  void begin_splat(std::uint64_t now) {
    begin_ = now;
    dispatch_ = std::max(dispatched_, now);
  }

  // Sub-tiles that it reaches, in the order in which they are found.
  void reach(const SubtileReach& subtile) {
    Cluster& cluster = cluster_of(subtile.x, subtile.y);
    const std::uint64_t found = std::max(dispatch_, begin_ + config_.spans_known_after(subtile.spans));
    const std::uint64_t in_turn = std::max(found, cluster.pushed_until);
    std::uint64_t& slot = cluster.taken[cluster.jobs % cluster.taken.size()];
    const std::uint64_t room = std::max(in_turn, slot);
    const std::uint64_t known = finished_from_[subtile.at];
    dispatch_ = std::max(found, std::min(room, known));
    counters_.queue_cycles += std::max(in_turn, dispatch_) - in_turn;
    if (room >= known) return;
    cluster.pushed_until = room + 1;
    const std::uint64_t free = std::max(room + 1, cluster.free_from);
    const std::uint64_t taken = std::max(free, free_from_[subtile.at]);
    counters_.hazard_cycles += taken - free;
    slot = taken;
    ++cluster.jobs;
    cluster.free_from = taken + config_.cluster_interval_cycles();
    free_from_[subtile.at] = taken + config_.state_loop_cycles;
    done_ = std::max(done_, cluster.free_from);
    if (subtile.finishes) finished_from_[subtile.at] = taken + config_.depth_cycles;
    ++counters_.blends;
    counters_.late_blends += subtile.blends ? 0 : 1;
  }

  // The cycle in which the next splat can be taken: the lanes are free, and a slot. spans: of this
  // one, whose slot is free when its last sub-tile, or that no row has any more, is dispatched.
  std::uint64_t end_splat(std::uint32_t spans) {
    dispatched_ = std::max(dispatch_, begin_ + config_.spans_known_after(spans)) + 1;
    slot_free_[splats_++ % slot_free_.size()] = dispatched_;
    return std::max({begin_ + 1, begin_ + config_.span_cycles(spans),
                     slot_free_[splats_ % slot_free_.size()]});
  }

  // The cycle in which every splat is dispatched and every cluster is free again.
  std::uint64_t all_done() const { return std::max(done_, dispatched_); }
  // From which cycle on it is known that this one is.
  std::uint64_t subtile_finished_from(std::size_t at) const { return finished_from_[at]; }
  // From which cycle on it is known that every sub-tile of the group is finished; 0 for none.
  std::uint64_t group_finished_from() const {
    const auto last = std::max_element(finished_from_.begin(), finished_from_.end());
    return last == finished_from_.end() ? 0 : *last;
  }
  const Counters& counters() const { return counters_; }

 private:
  struct Cluster {
    std::uint64_t pushed_until, free_from, jobs;
    std::vector<std::uint64_t> taken;  // ring: when the last entries of its queue were taken
  };

  Cluster& cluster_of(int x, int y) {
    return clusters_[static_cast<std::size_t>(x + 2 * y) % clusters_.size()];
  }

  const RenderingConfig& config_;
  std::vector<Cluster> clusters_;
  std::vector<std::uint64_t> free_from_;      // [sub-tile] its state can be read again
  std::vector<std::uint64_t> finished_from_;  // [sub-tile] it is known to be finished
  std::vector<std::uint64_t> slot_free_;      // ring: from when on, of the last splats
  std::uint64_t splats_ = 0;
  // Of this splat; dispatched_: from when on the dispatcher is free for the next.
  std::uint64_t begin_ = 0, dispatch_ = 0, dispatched_ = 0, done_ = 0;
  Counters counters_;
};

}  // namespace sgs
