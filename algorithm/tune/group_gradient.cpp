// An observer of the blend pass notes what each splat took; then the notes are read backward.
#include "algorithm/tune/group_gradient.h"

#include <cstring>
#include <glm/geometric.hpp>

#include "algorithm/render/group_state.h"
#include "algorithm/tune/lane_gradient.h"

namespace sgs {
namespace {

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

}  // namespace

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

}  // namespace sgs
