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
  std::uint64_t taken;         // cycle
  std::uint64_t row_from = 0;  // its first row begins; 0: it has no spans
};

struct ClusterModel {
  std::deque<Job> queue;
  std::uint64_t busy_until = 0;
};

class GroupModel {
 public:
  GroupModel(const RenderingConfig& config, std::size_t subtiles,
             const std::vector<RenderingToken>& tokens, std::uint64_t from)
      : config_(config),
        from_(from),
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
    if (now_ < cluster.busy_until || !turn_of(config_.cluster_interval_cycles())) return;
    const SubtileReach subtile = cluster.queue.front().subtile;
    if (now_ < loop_until_[subtile.at]) {
      times_.hazard_cycles += config_.cluster_interval_cycles();
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
    if (begins_ != nullptr) {
      begin();
      return;
    }
    if (now_ < next_from_ || slots_.size() == config_.span_slots) return;
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
      if (token.spans > 0) {
        begins_ = &slots_.back();
        begin();
      }
    }
    ++next_;
    tokens_end_ = now_ + 1;
  }

  // The splat that was taken last begins its spans, in the lanes' turn; its rows follow, in theirs.
  void begin() {
    if (now_ < begins_free_ || !turn_of(config_.begin_interval_cycles())) return;
    begins_free_ = now_ + config_.begin_interval_cycles();
    std::uint64_t row = std::max(now_ + config_.begin_depth_cycles, rows_free_);
    while ((from_ + row) % config_.span_interval_cycles() != 0) ++row;
    begins_->row_from = row;
    for (std::uint32_t at = 0; at < begins_->token->spans; at += config_.spans_at_once()) {
      row += config_.span_interval_cycles();
      ++times_.begun_span_reads;
    }
    rows_free_ = row;
    begins_ = nullptr;
    next_from_ = now_ + 1;
    tokens_end_ = now_ + 1;
  }

  bool turn_of(std::uint64_t interval) const { return (from_ + now_) % interval == 0; }

  // What the dispatcher does in this cycle with the oldest splat.
  void dispatch() {
    const SlotModel& slot = slots_.front();
    const RenderingToken& token = *slot.token;
    if (!row_) {
      if (&slot == begins_) return;
      const std::uint64_t known = slot.row_from +
                                  rows_ / config_.spans_at_once() * config_.span_interval_cycles() +
                                  config_.span_depth_cycles;
      if (now_ < (token.spans == 0 ? slot.taken : known)) return;
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
  const std::uint64_t from_;
  const std::vector<RenderingToken>& tokens_;
  std::vector<ClusterModel> clusters_;
  std::vector<std::uint64_t> loop_until_, known_;  // [sub-tile]
  std::size_t next_ = 0;
  std::deque<SlotModel> slots_;
  SlotModel* begins_ = nullptr;  // has been taken and not begun yet
  std::uint64_t next_from_ = 0, begins_free_ = 0, rows_free_ = 0;
  std::uint32_t rows_ = 0;                        // of the splat ahead, taken so far
  std::optional<std::vector<SubtileReach>> row_;  // what is left of the one that is held
  std::uint64_t now_ = 0, tokens_end_ = 0, dispatched_ = 0;
  RenderingTimes times_;
};

}  // namespace

RenderingTimes step_rendering(const RenderingConfig& config, std::size_t subtiles,
                              const std::vector<RenderingToken>& tokens, std::uint64_t from) {
  return GroupModel(config, subtiles, tokens, from).run();
}

}  // namespace sgs::tb
