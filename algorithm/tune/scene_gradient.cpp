// Groups by themselves, their sums in the groups' order, then one Gaussian at a time.
#include "algorithm/tune/scene_gradient.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <glm/geometric.hpp>
#include <vector>

#include "algorithm/render/group_state.h"
#include "algorithm/splat/blend.h"
#include "algorithm/tune/gaussian_gradient.h"
#include "algorithm/tune/lane_gradient.h"
#include "algorithm/tune/splat_gradient.h"

namespace sgs {
namespace {

// Blending of one group of pixels, done once more and differentiated.

// A group's part of the derivatives of the splats that were blended into it, back to front.
struct GroupPartials {
  std::vector<std::uint32_t> splats;  // positions in the sequences' splats
  std::vector<SplatGradient<float>> gradients;
};

// Keeps its memory from group to group.
class GroupGradient {
 public:
  GroupPartials differentiate(const DrawnScene& scene, std::size_t group,
                              const PixelGradient& by_pixel, GradientRule rule);

 private:
  // One splat in one sub-tile.
  struct Blend {
    std::uint32_t entry;  // entry of the sequences
    std::uint32_t at;     // the sub-tile's place in the group
    std::uint16_t x, y;   // the sub-tile, in the whole frame
  };

  void blend(const DrawnScene& scene, std::size_t group);

  std::vector<Blend> blends_;  // in the order of blending
  std::vector<LaneShares> shares_;
};

// Lanes outside the frame are never blended.
SubtileAdjoint make_adjoint(const DrawnScene& scene, const PixelGradient& by_pixel, int left_px,
                            int top_px) {
  SubtileAdjoint out{};
  const Image& picture = scene.picture.image;
  for (int lane = 0; lane < kSubtilePixels; ++lane) {
    const int x = left_px + lane % kSubtilePx, y = top_px + lane / kSubtilePx;
    if (x >= picture.width || y >= picture.height) continue;
    const auto at = static_cast<std::size_t>(y) * picture.width + x;
    const glm::vec3& by = by_pixel.colour.pixels[at];
    out.red[lane] = by.x;
    out.green[lane] = by.y;
    out.blue[lane] = by.z;
    float by_end = glm::dot(by, scene.background);
    if (!by_pixel.transmittance.empty()) by_end += by_pixel.transmittance[at];
    out.behind[lane] = scene.picture.transmittance[at] * by_end;
  }
  return out;
}

std::vector<SubtileAdjoint> make_adjoints(const DrawnScene& scene, const PixelRect& group,
                                          const PixelGradient& by_pixel) {
  std::vector<SubtileAdjoint> out;
  for (int y = group.y0; y < group.y1; y += kSubtilePx) {
    for (int x = group.x0; x < group.x1; x += kSubtilePx) {
      out.push_back(make_adjoint(scene, by_pixel, x, y));
    }
  }
  return out;
}

// No alpha is negative: any bit will do, two lanes at a time.
bool any_blended(const LaneShares& shares) {
  std::uint64_t pairs[kSubtilePixels / 2], bits = 0;
  std::memcpy(pairs, shares.alpha, sizeof pairs);
  for (const std::uint64_t pair : pairs) bits |= pair;
  return bits != 0;
}

void GroupGradient::blend(const DrawnScene& scene, std::size_t group) {
  const GroupSequences& sequences = scene.sequences;
  GroupState state(sequences.groups[group], sequences.width, sequences.height, scene.precision);
  blends_.clear();
  shares_.clear();
  for (std::size_t i = sequences.first[group]; i != sequences.first[group + 1]; ++i) {
    if (state.saturated()) break;
    state.blend(sequences.splat_of(i), [&](const SubtileBlend& blend) {
      if (!any_blended(blend.shares)) return;
      // Field by field: a copy would wait for its halves to reach memory.
      Blend& noted = blends_.emplace_back();
      noted.entry = static_cast<std::uint32_t>(i - sequences.first[group]);
      noted.at = static_cast<std::uint32_t>(blend.at);
      noted.x = static_cast<std::uint16_t>(blend.x);
      noted.y = static_cast<std::uint16_t>(blend.y);
      shares_.push_back(blend.shares);
    });
  }
}

GroupPartials GroupGradient::differentiate(const DrawnScene& scene, std::size_t group,
                                           const PixelGradient& by_pixel, GradientRule rule) {
  const GroupSequences& sequences = scene.sequences;
  const auto add = rule == GradientRule::kOriginal ? add_original_gradient : add_gradient;
  std::vector<SubtileAdjoint> adjoints = make_adjoints(scene, sequences.groups[group], by_pixel);
  blend(scene, group);
  GroupPartials out;
  out.splats.reserve(sequences.first[group + 1] - sequences.first[group]);
  out.gradients.reserve(out.splats.capacity());
  for (std::size_t i = blends_.size(); i > 0;) {
    const std::uint32_t entry = blends_[i - 1].entry;
    const std::uint32_t position = sequences.entries[sequences.first[group] + entry];
    const Splat& splat = sequences.splats[position];
    LaneMoments moments;
    for (; i > 0 && blends_[i - 1].entry == entry; --i) {
      const Blend& at = blends_[i - 1];
      add(shares_[i - 1], at.x, at.y, splat, adjoints[at.at], moments);
    }
    out.splats.push_back(position);
    out.gradients.push_back(splat_gradient(total(moments), splat.opacity));
  }
  return out;
}

struct SplatSums {
  std::vector<SplatGradient<float>> gradients;  // [splats]
  std::vector<std::uint8_t> seen;               // blended into some pixel
};

// Group after group for each splat, whichever thread does it: each takes its share of the splats
// out of all groups.
void add_partials(const std::vector<GroupPartials>& partials, SplatSums& sums) {
  const std::size_t count = sums.seen.size();
  const auto shares = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  tbb::parallel_for(std::size_t{0}, shares, [&](std::size_t share) {
    const std::size_t begin = count * share / shares, end = count * (share + 1) / shares;
    for (const GroupPartials& group : partials) {
      for (std::size_t i = 0; i != group.splats.size(); ++i) {
        const std::uint32_t splat = group.splats[i];
        if (splat - begin >= end - begin) continue;  // also below, by wrapping around
        sums.gradients[splat] += group.gradients[i];
        sums.seen[splat] = 1;
      }
    }
  });
}

SplatSums splat_gradients(const DrawnScene& scene, const PixelGradient& by_pixel,
                          GradientRule rule) {
  const std::size_t groups = scene.sequences.groups.size();
  std::vector<GroupPartials> partials(groups);
  tbb::enumerable_thread_specific<GroupGradient> gradients;
  tbb::parallel_for(std::size_t{0}, groups, [&](std::size_t group) {
    partials[group] = gradients.local().differentiate(scene, group, by_pixel, rule);
  });
  SplatSums sums;
  sums.gradients.resize(scene.sequences.splats.size());
  sums.seen.resize(scene.sequences.splats.size());
  add_partials(partials, sums);
  return sums;
}

// [Gaussian] position of its splat, or kNoSplat.
std::vector<std::uint32_t> seen_positions(const GroupSequences& sequences, const SplatSums& sums,
                                          std::size_t gaussians) {
  std::vector<std::uint32_t> positions(gaussians, kNoSplat);
  tbb::parallel_for(std::size_t{0}, sums.seen.size(), [&](std::size_t i) {
    if (sums.seen[i] != 0) positions[sequences.splats[i].index] = static_cast<std::uint32_t>(i);
  });
  return positions;
}

void write_gradient(const DrawnScene& scene, const Splat& splat,
                    const SplatGradient<float>& by_splat, GradientRule rule, std::size_t rank,
                    CloudGradient& out) {
  const std::size_t i = splat.index;
  const Gaussian<float>& g = scene.cloud.gaussians[i];
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(scene.cloud.sh_degree));
  GaussianCloud& by = out.parameters;
  const Gaussian<float> by_gaussian =
      gaussian_gradient(scene.view, g, scene.cloud.sh_degree, scene.cloud.sh(i), splat.rgb,
                        by_splat, rule, &by.sh_coeffs[rank * coeffs]);
  const RawGaussian<float> by_raw =
      activation_gradient(raw_gaussian(scene.parameters, i), g, by_gaussian);
  by.means[rank] = by_raw.mean;
  by.log_scales[rank] = by_raw.log_scale;
  by.quats[rank] = by_raw.quat;
  by.opacity_logits[rank] = by_raw.opacity_logit;
  out.centres[rank] = {by_splat.x, by_splat.y};
}

}  // namespace

void scene_gradient(const DrawnScene& scene, const PixelGradient& by_pixel, GradientRule rule,
                    CloudGradient& out) {
  const SplatSums sums = splat_gradients(scene, by_pixel, rule);
  const std::vector<std::uint32_t> positions =
      seen_positions(scene.sequences, sums, scene.cloud.size());
  out.resize(static_cast<std::size_t>(std::count(sums.seen.begin(), sums.seen.end(), 1)),
             scene.cloud.sh_degree);
  std::size_t rank = 0;
  for (std::size_t i = 0; i != positions.size(); ++i) {
    if (positions[i] != kNoSplat) out.indices[rank++] = static_cast<std::uint32_t>(i);
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rank, 256), [&](const auto& range) {
    // Splats lie in the order of depth. Written out here because gcc takes a function of nothing
    // but prefetches for one without effect.
    constexpr std::size_t kAhead = 8;
    for (std::size_t r = range.begin(); r != range.end(); ++r) {
      const std::uint32_t ahead = positions[out.indices[std::min(r + kAhead, rank - 1)]];
      __builtin_prefetch(&scene.sequences.splats[ahead].x);
      __builtin_prefetch(&scene.sequences.splats[ahead].footprint);
      __builtin_prefetch(&sums.gradients[ahead].x);
      __builtin_prefetch(&sums.gradients[ahead].rgb.z);
      const std::uint32_t position = positions[out.indices[r]];
      write_gradient(scene, scene.sequences.splats[position], sums.gradients[position], rule, r,
                     out);
    }
  });
}

}  // namespace sgs
