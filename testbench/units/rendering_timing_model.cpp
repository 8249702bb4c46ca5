// Stepping of slots, dispatcher and clusters.
#include "testbench/units/rendering_timing_model.h"

#include <algorithm>
#include <limits>

namespace sgs::tb {
namespace {

struct Job {
  SubtileReach subtile;
  std::uint64_t pushed;
};

// A splat in one of the slots, from when it is taken until it is dispatched.
struct SlotModel {
  const RenderingToken* token;
  std::uint64_t taken;  // cycle
};

struct ClusterModel {
  std::deque<Job> queue;
  std::uint64_t busy_until = 0;
};

class GroupModel {
 public:
  GroupModel(const RenderingConfig& config, std::size_t subtiles,
             const std::vector<RenderingToken>& tokens)
      : config_(config),
        tokens_(tokens),
        clusters_(config.clusters),
        loop_until_(subtiles, 0),
        known_(subtiles, std::numeric_limits<std::uint64_t>::max()) {}

  RenderingTimes run() {
    while (next_ < tokens_.size() || !slots_.empty() || waiting()) {
      for (ClusterModel& cluster : clusters_) take(cluster);
      if (next_ < tokens_.size()) take_token();
      if (!slots_.empty()) dispatch();
      ++now_;
    }
    times_.cycles = std::max(tokens_end_, dispatched_);
    for (const ClusterModel& c : clusters_) times_.cycles = std::max(times_.cycles, c.busy_until);
    const std::uint64_t all = *std::max_element(known_.begin(), known_.end());
    if (all != std::numeric_limits<std::uint64_t>::max()) times_.finished = all;
    return times_;
  }

 private:
  bool waiting() const {
    return std::any_of(clusters_.begin(), clusters_.end(),
                       [](const ClusterModel& c) { return !c.queue.empty(); });
  }

  void take(ClusterModel& cluster) {
    if (cluster.queue.empty() || cluster.queue.front().pushed == now_) return;
    if (now_ < cluster.busy_until) return;
    const SubtileReach subtile = cluster.queue.front().subtile;
    if (now_ < loop_until_[subtile.at]) {
      ++times_.hazard_cycles;
      return;
    }
    cluster.queue.pop_front();
    cluster.busy_until = now_ + config_.cluster_interval_cycles();
    loop_until_[subtile.at] = now_ + config_.state_loop_cycles;
    if (subtile.finishes) {
      known_[subtile.at] = now_ + config_.depth_cycles;
      ++times_.subtiles_finished;
    }
    ++times_.blends;
    times_.late_blends += subtile.blends ? 0 : 1;
  }

  // What leaves the FIFO in this cycle: into a slot, or dropped, or it is a mark.
  void take_token() {
    if (now_ < lanes_busy_until_ || slots_.size() == config_.span_slots) return;
    const RenderingToken& token = tokens_[next_];
    const auto is_known = [&](std::size_t at) { return known_[at] <= now_; };
    const bool dropped = std::all_of(token.footprint.begin(), token.footprint.end(), is_known);
    if (token.is_splat && dropped) {
      const bool over = std::all_of(known_.begin(), known_.end(),
                                    [&](std::uint64_t from) { return from <= now_; });
      ++(over ? times_.splats_dropped : times_.splats_hidden);
    } else if (token.is_splat) {
      times_.spans += token.spans;
      times_.splats_spanned += token.spans > 0 ? 1 : 0;
      slots_.push_back({&token, now_});
      lanes_busy_until_ = now_ + config_.span_cycles(token.spans);
    }
    ++next_;
    tokens_end_ = now_ + 1;
  }

  // What the dispatcher does in this cycle with the oldest splat.
  void dispatch() {
    const SlotModel& slot = slots_.front();
    const RenderingToken& token = *slot.token;
    if (!row_) {
      const std::uint64_t spans_after =
          token.spans == 0 ? 0 : config_.span_cycles(rows_ + 1) + config_.span_depth_cycles;
      if (now_ < slot.taken + spans_after) return;
      ++rows_;
      row_.emplace();
      for (const SubtileReach& subtile : token.reaches) {
        if (subtile.row + 1 == rows_) row_->push_back(subtile);
      }
    }
    ++times_.row_cycles;
    issue(*row_);
    if (!row_->empty()) return;
    row_.reset();
    ++times_.rows;
    if (rows_ < token.rows) return;
    rows_ = 0;
    slots_.pop_front();
    dispatched_ = now_ + 1;
  }

  // A cluster takes the first of its own in what is left of the row.
  void issue(std::vector<SubtileReach>& row) {
    std::vector<bool> asked(clusters_.size(), false);
    std::vector<SubtileReach> left;
    for (const SubtileReach& subtile : row) {
      if (known_[subtile.at] <= now_) continue;
      const auto owner = static_cast<std::size_t>(subtile.x + 2 * subtile.y) % clusters_.size();
      ClusterModel& cluster = clusters_[owner];
      const bool full = cluster.queue.size() == config_.cluster_queue_entries;
      if (!asked[owner] && !full) {
        cluster.queue.push_back({subtile, now_});
      } else {
        times_.queue_cycles += asked[owner] ? 0 : 1;
        left.push_back(subtile);
      }
      asked[owner] = true;
    }
    row = std::move(left);
  }

  const RenderingConfig& config_;
  const std::vector<RenderingToken>& tokens_;
  std::vector<ClusterModel> clusters_;
  std::vector<std::uint64_t> loop_until_, known_;  // [sub-tile]
  std::size_t next_ = 0;
  std::deque<SlotModel> slots_;
  std::uint64_t lanes_busy_until_ = 0;
  std::uint32_t rows_ = 0;                        // of the splat ahead, taken so far
  std::optional<std::vector<SubtileReach>> row_;  // what is left of the one that is held
  std::uint64_t now_ = 0, tokens_end_ = 0, dispatched_ = 0;
  RenderingTimes times_;
};

}  // namespace

RenderingTimes step_rendering(const RenderingConfig& config, std::size_t subtiles,
                              const std::vector<RenderingToken>& tokens) {
  return GroupModel(config, subtiles, tokens).run();
}

}  // namespace sgs::tb
