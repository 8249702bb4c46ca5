// Exact order, one task a group.
#include "algorithm/render/exact_renderer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "algorithm/order/chunk_walk.h"
#include "algorithm/render/blend_watch.h"
#include "algorithm/render/group_state.h"
#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/make_splat.h"
#include "algorithm/splat/visible_extents.h"

namespace sgs {
namespace {

struct Key {
  float depth;
  std::uint32_t slot;  // breaks ties of depth
  GroupReach reach;
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
              const ExactOrderConfig& config, Flags& contributing, StreamingStats& stats)
      : view_(view),
        cloud_(cloud),
        known_(known),
        config_(config),
        contributing_(contributing),
        stats_(stats),
        state_(pixels, view.width, view.height, config.precision, config.subtile_test),
        watch_(state_.subtile_count()) {}

  void visit(const WalkEntry& chunk) {
    ++stats_.visits;
    stats_.first_halves += chunk.count;
    for (std::uint32_t slot = chunk.at; slot < chunk.at + chunk.count; ++slot) {
      const Gaussian<float>& g = cloud_.gaussians[slot];
      const VisibleExtents& known = known_[slot];
      const ExtentBound bound = extent_bound(view_, g.mean, known.extent, known.scale_max);
      if (config_.coarse_filter && (!bound.in_front || !touches(bound, state_.pixels()))) continue;
      const bool tested = config_.coarse_filter;
      pending_.push(
          {bound.depth, slot, tested ? group_reach(bound, state_.pixels()) : GroupReach{}});
      ++stats_.coarse_passed;
    }
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
    stats_.subtile_blends += state_.blend(splat, observe).blended;
  }

  const View<float>& view_;
  const ActivatedCloud& cloud_;
  const std::vector<VisibleExtents>& known_;  // [slot]
  const ExactOrderConfig& config_;
  Flags& contributing_;
  StreamingStats& stats_;
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

void render_group(const View<float>& view, const ActivatedCloud& cloud, const ChunkTree& tree,
                  const std::vector<VisibleExtents>& known, const PixelRect& pixels,
                  const ExactOrderConfig& config, Flags& contributing, Flags& reached,
                  StreamingStats& stats, RenderResult& frame) {
  stats.groups = 1;
  TreeInMemory source{tree, {}};
  ChunkWalk walk(source, config.walk_room);
  walk.begin(view, pixels, tree.nodes.empty());
  GroupStream stream(view, cloud, known, pixels, config, contributing, stats);
  std::optional<WalkEntry> chunk = walk.next();
  while (chunk && !stream.saturated()) {
    reached.set(chunk->at);
    // With blend_early what waits decides what is forced out: no key may be missing.
    if (config.on_overflow == OnOverflow::kBlendEarly || stream.any_unfinished(chunk->reach)) {
      stream.visit(*chunk);
    }
    chunk = walk.next();
    stream.release_below(chunk ? chunk->nearest : std::numeric_limits<float>::infinity());
  }
  stats.nodes_read = walk.counters().nodes;
  stream.finish(frame);
  // The chunks that are left are behind finished pixels, not out of reach.
  for (; chunk; chunk = walk.next()) reached.set(chunk->at);
}

}  // namespace

StreamingResult render_exact_order(const View<float>& view, const ActivatedCloud& cloud,
                                   const ChunkTree& tree, const ExactOrderConfig& config) {
  StreamingResult out;
  out.frame = RenderResult(view.width, view.height);
  const std::vector<PixelRect> groups = pixel_groups(view.width, view.height, config.group);
  std::vector<StreamingStats> stats(groups.size());
  const std::vector<VisibleExtents> known = stored_extents(cloud);
  Flags contributing(cloud.size()), reached(cloud.size());
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
    render_group(view, cloud, tree, known, groups[g], config, contributing, reached, stats[g],
                 out.frame);
  });
  for (const StreamingStats& s : stats) out.stats += s;
  out.stats.contributing = contributing.count();
  out.stats.blocks_reached = reached.count();
  out.of_groups = std::move(stats);
  return out;
}

}  // namespace sgs
