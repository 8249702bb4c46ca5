// Brute force over every Gaussian of every chunk.
#include "tests/algorithm/voxel/chunk_bound_checks.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <limits>

#include "algorithm/render/group_state.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/make_splat.h"
#include "algorithm/splat/visible_extents.h"
#include "algorithm/voxel/chunk_test.h"
#include "algorithm/voxel/chunk_tree.h"
#include "tests/algorithm/voxel/stored_clouds.h"

namespace sgs::test {
namespace {

// What brute force finds among some Gaussians, for one group.
struct Found {
  bool blended = false;                                    // one of them could change a pixel
  float nearest = std::numeric_limits<float>::infinity();  // depth, of those in front
  int x0 = 1 << 20, y0 = 1 << 20, x1 = -1, y1 = -1;        // sub-tiles of the group that may change
  void add(const Found& other) {
    blended = blended || other.blended;
    nearest = std::min(nearest, other.nearest);
    x0 = std::min(x0, other.x0);
    y0 = std::min(y0, other.y0);
    x1 = std::max(x1, other.x1);
    y1 = std::max(y1, other.y1);
  }
  bool within(const GroupReach& reach) const {
    return !blended || (x0 >= reach.x0 && y0 >= reach.y0 && x1 <= reach.x1 && y1 <= reach.y1);
  }
};

// A view, and that of a second eye where it has one.
std::vector<View<float>> eyes_of(const View<float>& view) {
  if (view.eyes < 2) return {view};
  return {view, right_eye(view)};
}

bool could_blend(const View<float>& view, const Gaussian<float>& g, const PixelRect& group) {
  Splat splat{};
  return make_geometry(view, g, splat) && reaches_group(splat, group);
}

// Notes the sub-tiles of the group in which the Gaussian could change a pixel.
void find_subtiles(const View<float>& view, const Gaussian<float>& g, const PixelRect& group,
                   Found& found) {
  Splat splat{};
  if (!make_geometry(view, g, splat)) return;
  for (int y = group.y0; y < group.y1; y += kSubtilePx) {
    for (int x = group.x0; x < group.x1; x += kSubtilePx) {
      const PixelRect subtile = intersection({x, y, x + kSubtilePx, y + kSubtilePx}, group);
      if (!reaches_group(splat, subtile)) continue;
      const int column = (x - group.x0) / kSubtilePx, row = (y - group.y0) / kSubtilePx;
      found.x0 = std::min(found.x0, column);
      found.y0 = std::min(found.y0, row);
      found.x1 = std::max(found.x1, column);
      found.y1 = std::max(found.y1, row);
    }
  }
}

// The bound of an HFU that streams chunks.
ExtentBound stored_bound(const View<float>& view, const Gaussian<float>& g) {
  const VisibleExtents known = decode_extents(encode_extents(visible_extents(g)));
  return extent_bound(view, g.mean, known.extent, known.scale_max);
}

class Checker {
 public:
  Checker(const View<float>& view, const ActivatedCloud& cloud, const ChunkTree& tree,
          BoundTally& tally)
      : view_(view), cloud_(cloud), tree_(tree), tally_(tally) {}

  void check(const PixelRect& group) {
    if (!tree_.nodes.empty()) check_node(0, group);
  }

 private:
  Found check_node(std::uint32_t at, const PixelRect& group) {
    const ChunkNode& node = tree_.nodes[at];
    const GroupFrustum frustum(view_, group);
    Found all;
    std::uint32_t slot = node.first_slot, inner = node.first_node;
    for (int c = 0; c < node.children; ++c) {
      Found found;
      const std::uint32_t count = node.count[c];
      for (std::uint32_t i = 0; i < count; ++i) found.add(look_at(slot++, group));
      if (count == 0) found = check_node(inner++, group);
      compare(frustum.test(child_bound(node, c)), found, count);
      all.add(found);
    }
    return all;
  }

  Found look_at(std::uint32_t slot, const PixelRect& group) {
    const Gaussian<float>& g = cloud_.gaussians[slot];
    Found found;
    std::vector<ReachedPixelsOf<float>> reached;
    for (const View<float>& eye : eyes_) {
      const CoarseBound coarse =
          coarse_bound(eye, g.mean, std::max({g.scale.x, g.scale.y, g.scale.z}));
      if (!coarse.in_front) continue;
      if (&eye != &eyes_.front() && coarse.depth != found.nearest) {
        tally_.failure = "depths of two eyes";
      }
      found.nearest = coarse.depth;
      const ExtentBound bound = stored_bound(eye, g);
      if (touches(bound, group)) reached.push_back(reached_pixels(bound, group));
      if (!could_blend(eye, g, group)) continue;
      found.blended = true;
      ++tally_.splats;
      if (!touches(coarse, group)) tally_.failure = "coarse filter";
      if (!touches(bound, group)) tally_.failure = "coarse filter by extents";
      find_subtiles(eye, g, group, found);
    }
    if (!found.blended || !tally_.failure.empty()) return found;
    const auto pixels = reached.size() > 1 ? of_both(reached[0], reached[1]) : reached[0];
    if (!found.within(group_reach(pixels, group))) tally_.failure = "a Gaussian's reach";
    return found;
  }

  void compare(const ChunkTest& test, const Found& found, std::uint32_t count) {
    if (count > 0) {
      ++tally_.chunks;
      tally_.accepted += test.touches ? 1 : 0;
      tally_.in_vain += test.touches && !found.blended ? 1 : 0;
    }
    if (found.blended && !test.touches) tally_.failure = "a splat was missed";
    if (test.touches && !found.within(test.reach)) tally_.failure = "a chunk's reach";
    // Also false for a depth that is not a number.
    if (test.touches && !(test.nearest <= found.nearest)) {
      tally_.failure = fmt::format("nearest {}, but one is at {}", test.nearest, found.nearest);
    }
  }

  const View<float>& view_;
  const std::vector<View<float>> eyes_ = eyes_of(view_);
  const ActivatedCloud& cloud_;
  const ChunkTree& tree_;
  BoundTally& tally_;
};

}  // namespace

bool holds(const ChunkBound& outer, const ChunkBound& inner) {
  bool all = outer.scale_max >= inner.scale_max;
  for (int k = 0; k < 3; ++k) {
    all = all && outer.low[k] <= inner.low[k] && outer.high[k] >= inner.high[k] &&
          outer.extent[k] >= inner.extent[k];
  }
  return all;
}

void check_chunk_bounds(const HardScene& scene, std::uint32_t chunk, const PixelSize& group_size,
                        BoundTally& tally) {
  const auto [cloud, tree] = by_chunks(activate(scene.cloud), chunk, Stored::kAll);
  const View<float> view = make_view<float>(scene.camera);
  Checker checker(view, cloud, tree, tally);
  for (const PixelRect& group : pixel_groups(view.width, view.height, group_size)) {
    checker.check(group);
  }
}

void fuzz_chunk_bounds(unsigned first_seed, unsigned scenes, double most_apart) {
  BoundTally tally;
  for (unsigned seed = first_seed; seed < first_seed + scenes; ++seed) {
    HardScenes hard(seed);
    const int longest_px = hard.pick(50) == 0 ? 4000 : 100;
    HardScene scene = hard.next(1 + static_cast<std::size_t>(hard.pick(100)), longest_px);
    if (most_apart > 0) scene.camera.eyes_apart = most_apart * std::exp(hard.uniform(-12, 0));
    const auto chunk = static_cast<std::uint32_t>(1 + hard.pick(16));
    check_chunk_bounds(scene, chunk,
                       longest_px > 100
                           ? square_of(512)
                           : PixelSize{4 * (1 + hard.pick(16)), 4 * (1 + hard.pick(16))},
                       tally);
    if (!tally.failure.empty()) FAIL("seed " << seed << ": " << tally.failure);
  }
  fmt::print("{} tests of chunks, {} splats; {:.1f} % accepted, {:.1f} % of these in vain\n",
             tally.chunks, tally.splats,
             100.0 * static_cast<double>(tally.accepted) / static_cast<double>(tally.chunks),
             100.0 * static_cast<double>(tally.in_vain) / static_cast<double>(tally.accepted));
  CHECK(tally.splats > 10 * scenes);
  CHECK(tally.accepted < tally.chunks);
}

int check_bounds_at_the_edge(unsigned seed, int gaussians) {
  HardScenes hard(seed);
  int edges = 0;
  for (int k = 0; k < gaussians; ++k) {
    // From a ball or a needle to a scale that only tiles cut; opaque, so that the reach is largest.
    Camera camera;
    camera.width = camera.height = 256;
    camera.focal_x = camera.focal_y = hard.uniform(100, 400);
    const View<float> view = make_view<float>(camera);
    const int side = 4 * (1 + hard.pick(16));
    const int x0 = 4 * hard.pick(48), y0 = 4 * hard.pick(48);
    const PixelRect group{x0, y0, std::min(x0 + side, 256), std::min(y0 + side, 256)};
    Gaussian<float> g{};
    g.quat = {1, 0, 0, 0};
    g.opacity = 1;
    g.mean.z = static_cast<float>(hard.uniform(0.21, 20));
    const double sigma_px = std::exp(hard.uniform(-8, 7));
    g.scale = glm::vec3(static_cast<float>(sigma_px * g.mean.z / camera.focal_x));
    if (hard.pick(2) == 0) g.scale[hard.pick(3)] *= 1e-3F;
    const double middle[2] = {0.5 * (group.x0 + group.x1), 0.5 * (group.y0 + group.y1)};
    for (int axis = 0; axis < 2; ++axis) {
      g.mean[axis] = static_cast<float>((middle[axis] - 127.5) / camera.focal_x * g.mean.z);
    }
    const int axis = hard.pick(2);
    if (!could_blend(view, g, group)) continue;
    float reached = g.mean[axis];
    float beyond = reached + (hard.pick(2) == 0 ? 1.0F : -1.0F) *
                                 static_cast<float>((400 + 8 * sigma_px) * g.mean.z / 100);
    g.mean[axis] = beyond;
    if (could_blend(view, g, group)) continue;
    for (int step = 0; step < 40; ++step) {
      const float between = 0.5F * (reached + beyond);
      g.mean[axis] = between;
      (could_blend(view, g, group) ? reached : beyond) = between;
    }
    g.mean[axis] = reached;
    ++edges;
    const ChunkTest test = GroupFrustum(view, group).test(gaussian_bound(g));
    if (!touches(stored_bound(view, g), group)) FAIL("extents of Gaussian " << k);
    if (!test.touches) FAIL("Gaussian " << k << ", sigma " << sigma_px << " px");
  }
  return edges;
}

}  // namespace sgs::test
