// Stepping of dispatcher and clusters.
#include "testbench/units/rendering_timing_model.h"

#include <algorithm>
#include <limits>

namespace sgs::tb {
namespace {

struct Job {
  SubtileReach subtile;
  std::uint64_t pushed;
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
    while (next_ < tokens_.size() || waiting()) {
      for (ClusterModel& cluster : clusters_) take(cluster);
      if (next_ < tokens_.size()) dispatch();
      ++now_;
    }
    times_.cycles = tokens_end_;
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

  // What the dispatcher does in this cycle.
  void dispatch() {
    const RenderingToken& token = tokens_[next_];
    if (!begun_) begin(token);
    if (dropping_ || token.rows == 0) return end();
    if (!row_) {
      if (now_ < *begun_ + config_.span_cycles(token.spans > 0 ? rows_ + 1 : 0)) return;
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
    if (rows_ == token.rows) end();
  }

  void begin(const RenderingToken& token) {
    begun_ = now_;
    rows_ = 0;
    const auto is_known = [&](std::size_t at) { return known_[at] <= now_; };
    dropping_ = token.is_splat &&
                std::all_of(token.footprint.begin(), token.footprint.end(), is_known);
    if (dropping_) {
      const bool over = std::all_of(known_.begin(), known_.end(),
                                    [&](std::uint64_t from) { return from <= now_; });
      ++(over ? times_.splats_dropped : times_.splats_hidden);
    } else {
      times_.spans += token.spans;
      times_.splats_spanned += token.spans > 0 ? 1 : 0;
    }
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

  void end() {
    begun_.reset();
    ++next_;
    tokens_end_ = now_ + 1;
  }

  const RenderingConfig& config_;
  const std::vector<RenderingToken>& tokens_;
  std::vector<ClusterModel> clusters_;
  std::vector<std::uint64_t> loop_until_, known_;  // [sub-tile]
  std::size_t next_ = 0;
  std::uint32_t rows_ = 0;                       // of the splat, taken so far
  std::optional<std::vector<SubtileReach>> row_;  // what is left of the one that is held
  std::optional<std::uint64_t> begun_;
  bool dropping_ = false;
  std::uint64_t now_ = 0, tokens_end_ = 0;
  RenderingTimes times_;
};

}  // namespace

RenderingTimes step_rendering(const RenderingConfig& config, std::size_t subtiles,
                              const std::vector<RenderingToken>& tokens) {
  return GroupModel(config, subtiles, tokens).run();
}

}  // namespace sgs::tb
