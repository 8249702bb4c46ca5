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
  bool pushed_now = false;
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
      for (ClusterModel& cluster : clusters_) {
        cluster.pushed_now = false;
        take(cluster);
      }
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
    if (subtile.finishes) known_[subtile.at] = now_ + config_.depth_cycles;
    ++times_.blends;
    times_.late_blends += subtile.blends ? 0 : 1;
  }

  // What the dispatcher does in this cycle.
  void dispatch() {
    const RenderingToken& token = tokens_[next_];
    if (!begun_) {
      begun_ = now_;
      job_ = 0;
      const bool over = std::all_of(known_.begin(), known_.end(),
                                    [&](std::uint64_t from) { return from <= now_; });
      dropping_ = token.is_splat && over;
      times_.splats_dropped += dropping_ ? 1 : 0;
      times_.spans += dropping_ ? 0 : token.spans;
      times_.splats_spanned += !dropping_ && token.spans > 0 ? 1 : 0;
    }
    while (!dropping_ && job_ < token.reaches.size()) {
      const SubtileReach& subtile = token.reaches[job_];
      if (now_ < *begun_ + config_.span_cycles(subtile.spans)) return;
      if (known_[subtile.at] > now_) {
        ClusterModel& cluster = clusters_[static_cast<std::size_t>(subtile.x + 2 * subtile.y) %
                                          clusters_.size()];
        if (cluster.pushed_now) return;
        if (cluster.queue.size() == config_.cluster_queue_entries) {
          ++times_.queue_cycles;
          return;
        }
        cluster.queue.push_back({subtile, now_});
        cluster.pushed_now = true;
      }
      ++job_;
    }
    if (!dropping_ && now_ + 1 < *begun_ + config_.span_cycles(token.spans)) return;
    begun_.reset();
    ++next_;
    tokens_end_ = now_ + 1;
  }

  const RenderingConfig& config_;
  const std::vector<RenderingToken>& tokens_;
  std::vector<ClusterModel> clusters_;
  std::vector<std::uint64_t> loop_until_, known_;  // [sub-tile]
  std::size_t next_ = 0, job_ = 0;
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
