// Exact order, one task a group.
#include "algorithm/render/exact_renderer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "algorithm/order/tree_in_memory.h"
#include "algorithm/render/blend_watch.h"
#include "algorithm/render/group_state.h"
#include "algorithm/splat/group_reach.h"
#include "algorithm/splat/make_splat.h"
#include "algorithm/splat/visible_extents.h"

namespace sgs {
namespace {

// Of the walk of a group whose work is counted: entries are put aside beyond any machine's queues.
constexpr WalkRoom kRoomForEverything{1U << 14U, 1U << 14U};

struct Key {
  float depth;
  std::uint32_t slot;  // breaks ties of depth
  GroupReach reach;
  std::uint32_t number;  // among the counted keys
};
struct Behind {
  bool operator()(const Key& a, const Key& b) const {
    return a.depth > b.depth || (a.depth == b.depth && a.slot > b.slot);
  }
};

// One group's frame: keys wait, are released, become splats and are blended.
class GroupStream {
 public:
  GroupStream(const View<float>& view, const ActivatedCloud& cloud,
              const std::vector<VisibleExtents>& known, const PixelRect& pixels,
              const ExactOrderConfig& config, Flags& contributing, StreamingStats& stats,
              ExactGroupWork* work)
      : view_(view),
        cloud_(cloud),
        known_(known),
        config_(config),
        contributing_(contributing),
        stats_(stats),
        work_(work),
        state_(pixels, view.width, view.height, config.precision, config.subtile_test),
        watch_(state_.subtile_count()) {}

  void visit(const WalkEntry& chunk) {
    ++stats_.visits;
    stats_.first_halves += chunk.count;
    for_each_passed(chunk, [&](const Key& key) {
      pending_.push(key);
      ++stats_.coarse_passed;
      count_key(key);
    });
    count_visit(chunk);
  }
  // What nothing of is needed: a machine may find out too late.
  void count_unneeded(const WalkEntry& chunk) {
    for_each_passed(chunk, [&](const Key& key) { count_key(key); });
    count_visit(chunk);
  }

  // Nothing nearer than `nearest` will come any more.
  void release_below(float nearest) {
    while (!pending_.empty() && pending_.top().depth < nearest && !state_.saturated()) release();
    if (config_.on_overflow == OnOverflow::kBlendEarly) {
      while (pending_.size() > config_.merge_entries && !state_.saturated()) {
        release();
        ++stats_.forced_early;
      }
    }
    stats_.pending_keys_max = std::max<std::uint64_t>(stats_.pending_keys_max, pending_.size());
  }

  bool saturated() const { return state_.saturated(); }
  bool any_unfinished(const GroupReach& reach) const { return state_.any_unfinished(reach); }

  void finish(RenderResult& frame) {
    stats_.contributors = state_.contributors();
    stats_.misordered = watch_.misordered();
    state_.store(config_.background, frame);
  }

 private:
  template <class Take>
  void for_each_passed(const WalkEntry& chunk, const Take& take) {
    for (std::uint32_t slot = chunk.at; slot < chunk.at + chunk.count; ++slot) {
      const Gaussian<float>& g = cloud_.gaussians[slot];
      const VisibleExtents& known = known_[slot];
      const ExtentBound bound = extent_bound(view_, g.mean, known.extent, known.scale_max);
      if (config_.coarse_filter && (!bound.in_front || !touches(bound, state_.pixels()))) continue;
      const bool tested = config_.coarse_filter;
      take(Key{bound.depth, slot, tested ? group_reach(bound, state_.pixels()) : GroupReach{},
               work_ == nullptr ? 0 : static_cast<std::uint32_t>(work_->keys.size())});
    }
  }
  void count_key(const Key& key) {
    if (work_ == nullptr) return;
    work_->keys.push_back({key.depth, key.slot, KeyWork::kNoSplat, key.reach});
  }
  void count_visit(const WalkEntry& chunk) {
    if (work_ == nullptr) return;
    work_->visits.push_back({chunk.at, chunk.count, chunk.nearest,
                             static_cast<std::uint32_t>(work_->nodes.size()),
                             static_cast<std::uint32_t>(work_->keys.size()), chunk.reach});
  }

  void release() {
    const Key key = pending_.top();
    const std::uint32_t slot = key.slot;
    pending_.pop();
    if (!state_.any_unfinished(key.reach)) return;
    ++stats_.second_halves;
    ++stats_.fine_tests;
    const Gaussian<float>& g = cloud_.gaussians[slot];
    Splat splat;
    if (!make_geometry(view_, g, splat) || !reaches_group(splat, state_.pixels())) return;
    add_colour(view_, cloud_.sh_degree, g.mean, cloud_.sh(slot), splat);
    ++stats_.splats;
    const auto observe = [&](const SubtileBlend& blend) {
      if (watch_.see(blend, splat.depth)) contributing_.set(slot);
    };
    stats_.subtile_blends +=
        (work_ == nullptr ? state_.blend(splat, observe) : count_blend(splat, key.number, observe))
            .blended;
  }
  template <class Observe>
  BlendWork count_blend(const Splat& splat, std::uint32_t key, const Observe& observe) {
    BlendRecord& blends = work_->blends;
    work_->keys[key].splat = static_cast<std::uint32_t>(blends.splats().size());
    blends.begin(state_.box_of(splat));
    const BlendWork work = state_.blend_scheduled(
        splat, observe, [&](const SubtileReach& subtile) { blends.reach(subtile); });
    blends.end(work);
    return work;
  }

  const View<float>& view_;
  const ActivatedCloud& cloud_;
  const std::vector<VisibleExtents>& known_;  // [slot]
  const ExactOrderConfig& config_;
  Flags& contributing_;
  StreamingStats& stats_;
  ExactGroupWork* const work_;  // null: it is not counted
  GroupState state_;
  BlendWatch watch_;
  std::priority_queue<Key, std::vector<Key>, Behind> pending_;
};

// [slot] as the units know them: through the code that is stored.
std::vector<VisibleExtents> stored_extents(const ActivatedCloud& cloud) {
  std::vector<VisibleExtents> out(cloud.size());
  tbb::parallel_for(std::size_t{0}, out.size(), [&](std::size_t slot) {
    const Gaussian<float>& g = cloud.gaussians[slot];
    out[slot] = decode_extents(encode_extents(visible_extents(g)));
  });
  return out;
}

// As ChunkWalk::next(), counted: the nodes that are opened.
class CountedWalk {
 public:
  // work: null: they are not counted.
  CountedWalk(ChunkWalk<TreeInMemory>& walk, const ChunkTree& tree, ExactGroupWork* work)
      : walk_(walk), tree_(tree), work_(work) {}

  std::optional<WalkEntry> next() {
    if (work_ == nullptr) return walk_.next();
    while (true) {
      if (const std::optional<WalkEntry> chunk = walk_.take_chunk()) return chunk;
      if (!walk_.has_node()) return std::nullopt;
      open(walk_.take_node());
    }
  }

 private:
  void open(const WalkEntry& entry) {
    const ChunkNode& node = tree_.nodes[entry.at];
    const auto entered = [&] {
      return walk_.node_queue().work().inserts + walk_.chunk_queue().work().inserts;
    };
    const std::uint64_t before = entered();
    walk_.open(entry, node);
    NodeWork counted;
    counted.at = entry.at;
    counted.parent = parent_of(entry.at);
    counted.children = node.children;
    counted.entered = static_cast<std::uint8_t>(entered() - before);
    counted.chunks_known = static_cast<std::uint32_t>(walk_.chunk_queue().work().inserts);
    counted.reach = entry.reach;
    const auto place = static_cast<std::uint32_t>(work_->nodes.size());
    const std::uint16_t* const end = node.count + node.children;
    if (std::find(node.count, end, 0) != end) opened_[node.first_node] = place;
    work_->nodes.push_back(counted);
  }
  // Inner children of a node lie behind each other in the table.
  std::uint32_t parent_of(std::uint32_t at) const {
    const auto behind = opened_.upper_bound(at);
    return behind == opened_.begin() ? NodeWork::kRoot : std::prev(behind)->second;
  }

  ChunkWalk<TreeInMemory>& walk_;
  const ChunkTree& tree_;
  ExactGroupWork* const work_;
  std::map<std::uint32_t, std::uint32_t> opened_;  // first inner child: place
};

struct CountedGroup {
  ExactGroupWork* work = nullptr;  // null: it is not counted
  HeapWork node_queue, chunk_queue;
  std::size_t node_queue_max = 0, chunk_queue_max = 0;
};

void render_group(const View<float>& view, const ActivatedCloud& cloud, const ChunkTree& tree,
                  const std::vector<VisibleExtents>& known, const PixelRect& pixels,
                  const ExactOrderConfig& config, Flags& contributing, Flags& reached,
                  StreamingStats& stats, CountedGroup& counted, RenderResult& frame) {
  stats.groups = 1;
  TreeInMemory source{tree, {}};
  ChunkWalk<TreeInMemory> walk(view, source,
                               counted.work == nullptr ? config.walk_room : kRoomForEverything);
  walk.begin(pixels, tree.nodes.empty());
  GroupStream stream(view, cloud, known, pixels, config, contributing, stats, counted.work);
  CountedWalk chunks(walk, tree, counted.work);
  std::optional<WalkEntry> chunk = chunks.next();
  while (chunk && !stream.saturated()) {
    reached.set(chunk->at);
    // With blend_early what waits decides what is forced out: no key may be missing.
    if (config.on_overflow == OnOverflow::kBlendEarly || stream.any_unfinished(chunk->reach)) {
      stream.visit(*chunk);
    } else if (counted.work != nullptr) {
      stream.count_unneeded(*chunk);
    }
    chunk = chunks.next();
    stream.release_below(chunk ? chunk->nearest : std::numeric_limits<float>::infinity());
  }
  stats.nodes_read = walk.counters().nodes;
  stream.finish(frame);
  if (counted.work != nullptr) {
    for (std::uint32_t behind = 0; chunk && behind < config.visits_behind; ++behind) {
      stream.count_unneeded(*chunk);
      reached.set(chunk->at);
      chunk = chunks.next();
    }
    counted.node_queue = walk.node_queue().work();
    counted.chunk_queue = walk.chunk_queue().work();
    counted.node_queue_max = walk.node_queue().most();
    counted.chunk_queue_max = walk.chunk_queue().most();
  }
  // What is left is behind finished pixels, not out of reach.
  for (; chunk; chunk = walk.next()) reached.set(chunk->at);
}

// work: null: it is not counted.
StreamingResult render(const View<float>& view, const ActivatedCloud& cloud, const ChunkTree& tree,
                       const ExactOrderConfig& config, ExactWork* work) {
  StreamingResult out;
  const auto pixels = static_cast<std::size_t>(view.width) * view.height;
  out.frame.image = Image(view.width, view.height);
  out.frame.transmittance.resize(pixels);
  out.frame.contributors.resize(pixels);
  const std::vector<PixelRect> groups = pixel_groups(view.width, view.height, config.group);
  std::vector<StreamingStats> stats(groups.size());
  std::vector<CountedGroup> counted(groups.size());
  if (work != nullptr) work->groups.resize(groups.size());
  const std::vector<VisibleExtents> known = stored_extents(cloud);
  Flags contributing(cloud.size()), reached(cloud.size());
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
    if (work != nullptr) counted[g].work = &work->groups[g];
    render_group(view, cloud, tree, known, groups[g], config, contributing, reached, stats[g],
                 counted[g], out.frame);
  });
  for (const StreamingStats& s : stats) out.stats += s;
  out.stats.contributing = contributing.count();
  out.stats.blocks_reached = reached.count();
  if (work != nullptr) {
    for (const CountedGroup& group : counted) {
      work->node_queue += group.node_queue;
      work->chunk_queue += group.chunk_queue;
      work->node_queue_max = std::max(work->node_queue_max, group.node_queue_max);
      work->chunk_queue_max = std::max(work->chunk_queue_max, group.chunk_queue_max);
    }
    work->contributors = out.stats.contributors;
  }
  out.of_groups = std::move(stats);
  return out;
}

}  // namespace

StreamingResult render_exact_order(const View<float>& view, const ActivatedCloud& cloud,
                                   const ChunkTree& tree, const ExactOrderConfig& config) {
  return render(view, cloud, tree, config, nullptr);
}

CountedExactFrame count_exact_order(const View<float>& view, const ActivatedCloud& cloud,
                                    const ChunkTree& tree, const ExactOrderConfig& config) {
  CountedExactFrame out;
  out.result = render(view, cloud, tree, config, &out.work);
  return out;
}

}  // namespace sgs
