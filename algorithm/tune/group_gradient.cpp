// An observer of the blend pass.
#include "algorithm/tune/group_gradient.h"

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
    const glm::vec3 &by = by_pixel.colour.pixels[at], &colour = picture.pixels[at];
    out.red[lane] = by.x;
    out.green[lane] = by.y;
    out.blue[lane] = by.z;
    out.rest[lane] = by.x * colour.x + by.y * colour.y + by.z * colour.z;
    if (by_pixel.transmittance.empty()) continue;
    out.rest[lane] += by_pixel.transmittance[at] * scene.picture.transmittance[at];
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

}  // namespace

GroupPartials group_gradient(const DrawnScene& scene, std::size_t group,
                             const PixelGradient& by_pixel, GradientRule rule) {
  const GroupSequences& sequences = scene.sequences;
  const auto add = rule == GradientRule::kOriginal ? add_original_gradient : add_gradient;
  std::vector<SubtileAdjoint> adjoints = make_adjoints(scene, sequences.groups[group], by_pixel);
  GroupState state(sequences.groups[group], sequences.width, sequences.height, scene.precision);
  GroupPartials out;
  out.splats.reserve(sequences.first[group + 1] - sequences.first[group]);
  out.gradients.reserve(out.splats.capacity());
  for (std::size_t i = sequences.first[group]; i != sequences.first[group + 1]; ++i) {
    if (state.saturated()) break;
    const Splat& splat = sequences.splat_of(i);
    LaneMoments moments;
    bool seen = false;
    state.blend(splat, [&](const SubtileBlend& blend) {
      seen |= add(blend.shares, blend.x, blend.y, splat, adjoints[blend.at], moments);
    });
    if (!seen) continue;
    out.splats.push_back(sequences.entries[i]);
    out.gradients.push_back(splat_gradient(total(moments), splat.opacity));
  }
  return out;
}

}  // namespace sgs
