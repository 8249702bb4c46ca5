// The filters run with the counting scalar.
#include "algorithm/splat/filter_work.h"

#include <array>
#include <glm/geometric.hpp>

#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/counting.h"
#include "algorithm/splat/group_reach.h"
#include "algorithm/splat/half_scalar.h"
#include "algorithm/splat/make_splat.h"
#include "algorithm/splat/row_span.h"
#include "algorithm/splat/visible_extents.h"

namespace sgs {
namespace {

glm::vec<3, Counting> input(DataFlow& flow, const glm::vec3& v) {
  return {input(flow, v.x), input(flow, v.y), input(flow, v.z)};
}

Gaussian<Counting> input(DataFlow& flow, const Gaussian<float>& g) {
  Gaussian<Counting> out{};
  out.mean = input(flow, g.mean);
  out.scale = input(flow, g.scale);
  for (std::size_t k = 0; k < g.quat.size(); ++k) out.quat[k] = input(flow, g.quat[k]);
  out.opacity = input(flow, g.opacity);
  return out;
}

// In half a line for each step of 2^t stands in place of a parabola, and the conic and the centre of
// a splat are scaled by powers of two, which are looked for in A and C.
OperationCounts in_half(OperationCounts c) {
  const auto saved = static_cast<std::uint32_t>(Exp2TableOf<Counting>::kCoefficients -
                                                Exp2TableOf<HalfScalar>::kCoefficients) *
                     kSubtilePixels;
  c.multiplies -= saved;
  c.adds -= saved;
  c.fused -= saved;
  c.comparisons += 1;
  c.scalings += 3 + 2;
  return c;
}

}  // namespace

// No two values of the camera are equal and none is 0, so that no two operations coincide.
FilterCase longest_case() {
  FilterCase out;
  out.camera.width = 256;
  out.camera.height = 192;
  out.camera.focal_x = 250;
  out.camera.focal_y = 240;
  out.camera.position = {1, 2, 3};
  const glm::dvec3 z = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
  const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(0.2, 0.9, 0.1)));
  out.camera.world_from_camera = glm::dmat3(x, glm::cross(z, x), z);
  // In the middle of the frame, some 20 px wide; the group begins 10 px farther right and below.
  const glm::dvec3 mean = out.camera.position + 4.0 * z;
  out.gaussian = {glm::vec3(mean), {0.3F, 0.25F, 0.35F}, {0.8F, 0.36F, 0.48F, 0}, 0.9F};
  out.group = {138, 106, 170, 138};
  return out;
}

namespace {

DataFlow coarse_flow(CoarseBoundBy bound_by, const FilterCase& tested, std::uint32_t across) {
  DataFlow flow;
  const auto view = make_view<Counting>(tested.camera);
  const auto mean = input(flow, tested.gaussian.mean);
  const VisibleExtents known = visible_extents(tested.gaussian);
  // Counted whatever it says.
  const auto run = [&](const auto& bound) {
    if (!bound.in_front) return;
    const PixelRect& group = tested.group;
    const int parts = static_cast<int>(across);
    const int width = (group.x1 - group.x0) / parts, height = (group.y1 - group.y0) / parts;
    for (int part = 0; part < parts * parts; ++part) {
      const int x = group.x0 + part % parts * width, y = group.y0 + part / parts * height;
      static_cast<void>(touches(bound, PixelRect{x, y, x + width, y + height}));
    }
  };
  if (bound_by == CoarseBoundBy::kLargestScale) {
    run(coarse_bound(view, mean, input(flow, known.scale_max)));
  } else {
    const auto extent = input(flow, known.extent);
    const auto bound = extent_bound(view, mean, extent, input(flow, known.scale_max));
    run(bound);
    if (bound.in_front) static_cast<void>(group_reach(bound, tested.group));
  }
  return flow;
}

// With where its first two parts end.
struct FineFlow {
  DataFlow flow;
  std::size_t geometry_end = 0, test_end = 0;
};

FineFlow fine_flow(const FilterCase& tested, int sh_degree) {
  FineFlow out;
  DataFlow& flow = out.flow;
  const auto view = make_view<Counting>(tested.camera);
  const Gaussian<Counting> gaussian = input(flow, tested.gaussian);
  std::array<glm::vec<3, Counting>, 16> sh;
  for (auto& coefficient : sh) coefficient = input(flow, glm::vec3(1.0F));

  SplatOf<Counting> splat{};
  const bool on_screen = make_geometry(view, gaussian, splat);
  out.geometry_end = flow.size();
  const bool kept = on_screen && reaches_group(splat, tested.group);
  out.test_end = flow.size();
  if (kept) add_colour(view, sh_degree, gaussian.mean, sh.data(), splat);
  return out;
}

// With where its parts end, and the inputs that are pixel state.
struct RenderingFlow {
  DataFlow flow;
  std::size_t spans_begun = 0, spanned = 0, in_base_2 = 0;
  std::vector<std::uint32_t> state;
};

RenderingFlow rendering_flow() {
  RenderingFlow out;
  DataFlow& flow = out.flow;
  SplatOf<Counting> splat{};
  // An ellipse that leans, some 20 px wide, and a row through its middle: every step is taken.
  splat.x = input(flow, 101.5F);
  splat.y = input(flow, 57.25F);
  splat.conic_a = input(flow, 0.03F);
  splat.conic_b = input(flow, 0.01F);
  splat.conic_c = input(flow, 0.05F);
  splat.opacity = input(flow, 0.9F);
  splat.rgb = input(flow, glm::vec3(0.1F, 0.2F, 0.3F));
  const auto state = [&](float value) {
    const Counting of_pixel = input(flow, value);
    out.state.push_back(of_pixel.node);
    return of_pixel;
  };
  RowSpans<Counting> spans(splat);
  spans.start(52);
  out.spans_begun = flow.size();
  static_cast<void>(spans.next(56));
  out.spanned = flow.size();
  const auto conic = log2_conic(splat.conic_a, splat.conic_b, splat.conic_c);
  out.in_base_2 = flow.size();
  const Counting left = splat.x - Counting(96.0F), top = splat.y - Counting(52.0F);
  for (int lane = 0; lane < kSubtilePixels; ++lane) {
    const Counting dx = left - Counting(static_cast<float>(lane % kSubtilePx));
    const Counting dy = top - Counting(static_cast<float>(lane / kSubtilePx));
    const Counting exponent = log2_falloff(conic, dx, dy);
    const Counting alpha = alpha_of(exponent, exp2_of(exponent), splat.opacity);
    const LightShare<Counting> light = take_light(alpha, state(0.5F));
    static_cast<void>(light.after < constant<Counting>(kTransmittanceMin));
    for (int channel = 0; channel < 3; ++channel) {
      static_cast<void>(state(0.25F) + splat.rgb[channel] * light.weight);
    }
  }
  return out;
}

// In half: the parabola's step is saved; A and C are looked at, and the conic scaled.
LongestPath in_half(LongestPath path) {
  path.lane -= static_cast<std::uint32_t>(Exp2TableOf<Counting>::kCoefficients -
                                          Exp2TableOf<HalfScalar>::kCoefficients);
  path.comparator += 1 + 1;
  return path;
}

}  // namespace

OperationCounts coarse_work(CoarseBoundBy bound_by, const FilterCase& tested,
                            std::uint32_t across) {
  const DataFlow flow = coarse_flow(bound_by, tested, across);
  return flow.counts(0, flow.size());
}

LongestPath coarse_path(CoarseBoundBy bound_by, const FilterCase& tested, std::uint32_t across,
                        const OperationLatencies& latencies) {
  const DataFlow flow = coarse_flow(bound_by, tested, across);
  return flow.longest_path(0, flow.size(), latencies);
}

FineWork fine_work(const FilterCase& tested, int sh_degree) {
  const FineFlow fine = fine_flow(tested, sh_degree);
  return {fine.flow.counts(0, fine.geometry_end),
          fine.flow.counts(fine.geometry_end, fine.test_end),
          fine.flow.counts(fine.test_end, fine.flow.size())};
}

LongestPath fine_path(const FilterCase& tested, int sh_degree,
                      const OperationLatencies& latencies) {
  const FineFlow fine = fine_flow(tested, sh_degree);
  return fine.flow.longest_path(0, fine.flow.size(), latencies);
}

RenderingWork rendering_work(BlendPrecision precision) {
  const RenderingFlow of = rendering_flow();
  RenderingWork work;
  work.spans_begin = of.flow.counts(0, of.spans_begun);
  work.span = of.flow.counts(of.spans_begun, of.spanned);
  work.conic = of.flow.counts(of.spanned, of.in_base_2);
  work.subtile_blend = of.flow.counts(of.in_base_2, of.flow.size());
  if (precision == BlendPrecision::kHalf) work.subtile_blend = in_half(work.subtile_blend);
  return work;
}

RenderingPaths rendering_paths(BlendPrecision precision, const OperationLatencies& single,
                               const OperationLatencies& half) {
  const RenderingFlow of = rendering_flow();
  const bool is_half = precision == BlendPrecision::kHalf;
  const OperationLatencies& blending = is_half ? half : single;
  RenderingPaths paths;
  paths.spans = of.flow.longest_path(0, of.spanned, single);
  paths.conic = of.flow.longest_path(of.spanned, of.in_base_2, single);
  paths.blend = of.flow.longest_path(of.in_base_2, of.flow.size(), blending);
  if (is_half) paths.blend = in_half(paths.blend);
  paths.state_loop = of.flow.longest_path_from(of.state, blending);
  return paths;
}

OperationCounts FineWork::total() const { return geometry + group_test + colour; }

}  // namespace sgs
