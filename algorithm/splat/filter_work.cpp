// The filters run with the counting scalar.
#include "algorithm/splat/filter_work.h"

#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <tuple>

#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/counting.h"
#include "algorithm/splat/counting_half.h"
#include "algorithm/splat/group_reach.h"
#include "algorithm/splat/lane_input.h"
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

void keep(DataFlow& flow, std::initializer_list<Counting> values) {
  for (const Counting& value : values) {
    if (value.flow != nullptr) flow.keep(value.node);
  }
}

// Words that go along with an item.
constexpr std::size_t kBesideCoarse = 3;  // storage slot, two words of the first half
constexpr std::size_t kBesideFine = 2;    // storage slot, visit
constexpr std::size_t kBesideBlend = 1;   // number of the sub-tile

// What blending does for 16 pixels, in the arithmetic T; state(value): of a pixel, from outside.
template <class T, class State>
void blend_work(const LaneInput<T>& in, const State& state) {
  for (int lane = 0; lane < kSubtilePixels; ++lane) {
    const T dx = in.left - T(static_cast<float>(lane % kSubtilePx) * in.pixel_px);
    const T dy = in.top - T(static_cast<float>(lane / kSubtilePx) * in.pixel_px);
    const T exponent = log2_falloff(in.conic, dx, dy);
    const T alpha = alpha_of(exponent, exp2_of(exponent), in.opacity);
    const LightShare<T> light = take_light(alpha, T(state(0.5F)));
    static_cast<void>(light.after < constant<T>(kTransmittanceMin));
    for (const T& colour : {in.red, in.green, in.blue}) {
      static_cast<void>(T(state(0.25F)) + colour * light.weight);
    }
  }
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
    keep(flow, {bound.depth});
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
  keep(flow, {mean.x, mean.y, mean.z});
  flow.pass_beside(kBesideCoarse);
  return flow;
}

// With where its parts end, and the inputs that are pixel state.
struct RenderingFlow {
  DataFlow flow;
  std::size_t spans_begun = 0, spanned = 0, in_base_2 = 0, cornered = 0;
  std::vector<std::uint32_t> state, edge;  // of a pixel; of the spans above the row
};

// An ellipse that leans, some 20 px wide, and a row through its middle: every step is taken.
SplatOf<Counting> leaning_splat(DataFlow& flow) {
  SplatOf<Counting> splat{};
  splat.x = input(flow, 101.5F);
  splat.y = input(flow, 57.25F);
  splat.conic_a = input(flow, 0.03F);
  splat.conic_b = input(flow, 0.01F);
  splat.conic_c = input(flow, 0.05F);
  splat.opacity = input(flow, 0.9F);
  splat.rgb = input(flow, glm::vec3(0.1F, 0.2F, 0.3F));
  return splat;
}
constexpr int kFirstRowPx = 52;

constexpr std::size_t kEdgeWords = 2;  // the last of RowSpans::carried()

// A splat's beginning alone: what its rows take is what it is for.
DataFlow spans_begin_flow() {
  DataFlow flow;
  RowSpans<Counting> spans(leaning_splat(flow));
  spans.start(kFirstRowPx);
  const auto carried = spans.carried();
  static_assert(std::tuple_size_v<decltype(spans.carried())> == kBegunSpanWords);
  for (const Counting& value : carried) keep(flow, {value});
  return flow;
}

RenderingFlow rendering_flow(BlendPrecision precision) {
  RenderingFlow out;
  DataFlow& flow = out.flow;
  const SplatOf<Counting> splat = leaning_splat(flow);
  const auto state = [&](float value) {
    const Counting of_pixel = input(flow, value);
    out.state.push_back(of_pixel.node);
    return of_pixel;
  };
  RowSpans<Counting> spans(splat);
  // The edge above is that of another line, or the graph would find there where the row's top lies.
  spans.start(kFirstRowPx - 1);
  out.spans_begun = flow.size();
  const auto above = spans.carried();
  for (std::size_t i = above.size() - kEdgeWords; i < above.size(); ++i) {
    if (above[i].flow != nullptr) out.edge.push_back(above[i].node);
  }
  static_cast<void>(spans.next(kFirstRowPx, kFirstRowPx + kSubtilePx));
  const auto below = spans.carried();
  for (std::size_t i = below.size() - kEdgeWords; i < below.size(); ++i) keep(flow, {below[i]});
  out.spanned = flow.size();
  static_cast<void>(log2_conic(splat.conic_a, splat.conic_b, splat.conic_c));
  out.in_base_2 = flow.size();
  flow.pass_beside(kBesideBlend);
  const Counting left = splat.x - Counting(96.0F), top = splat.y - Counting(52.0F);
  out.cornered = flow.size();
  if (precision == BlendPrecision::kHalf) {
    blend_work(lane_input_in_half<CountingHalf>(splat, left, top), state);
  } else {
    blend_work(lane_input(splat, left, top), state);
  }
  return out;
}

}  // namespace

FineFlow fine_flow(const FilterCase& tested, const FineRecord& record) {
  FineFlow out;
  DataFlow& flow = out.flow;
  const auto view = make_view<Counting>(tested.camera);
  Gaussian<Counting> gaussian = input(flow, tested.gaussian);
  std::array<glm::vec<3, Counting>, 16> sh;
  for (auto& coefficient : sh) coefficient = input(flow, glm::vec3(1.0F));
  flow.pass_beside(kBesideFine);
  if (record.quaternion_words < gaussian.quat.size()) {
    auto& [largest, x, y, z] = gaussian.quat;
    largest = moved_by_units(largest_component<Counting>({x, y, z}), input_index(flow, 0));
  }
  out.decoded = flow.size();

  SplatOf<Counting> splat{};
  const bool on_screen = make_geometry(view, gaussian, splat);
  out.geometry_end = flow.size();
  const bool kept = on_screen && reaches_group(splat, tested.group);
  out.test_end = flow.size();
  if (kept) add_colour(view, record.sh_degree, gaussian.mean, sh.data(), splat);
  keep(flow, {splat.x, splat.y, splat.depth, splat.conic_a, splat.conic_b, splat.conic_c,
              splat.opacity, splat.rgb.x, splat.rgb.y, splat.rgb.z});
  return out;
}

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

FineWork fine_work(const FilterCase& tested, const FineRecord& record) {
  const FineFlow fine = fine_flow(tested, record);
  return {fine.flow.counts(0, fine.decoded), fine.flow.counts(fine.decoded, fine.geometry_end),
          fine.flow.counts(fine.geometry_end, fine.test_end),
          fine.flow.counts(fine.test_end, fine.flow.size())};
}

LongestPath fine_path(const FilterCase& tested, const FineRecord& record,
                      const OperationLatencies& latencies) {
  const FineFlow fine = fine_flow(tested, record);
  return fine.flow.longest_path(0, fine.flow.size(), latencies);
}

RenderingWork rendering_work(BlendPrecision precision) {
  const RenderingFlow of = rendering_flow(precision);
  RenderingWork work;
  const DataFlow begin = spans_begin_flow();
  work.spans_begin = begin.counts(0, begin.size());
  work.span = of.flow.counts(of.spans_begun, of.spanned);
  work.conic = of.flow.counts(of.spanned, of.in_base_2);
  work.subtile_blend = of.flow.counts(of.in_base_2, of.flow.size());
  work.corner = of.flow.counts(of.in_base_2, of.cornered);
  work.blend_from_corner = of.flow.counts(of.cornered, of.flow.size());
  return work;
}

RenderingPaths rendering_paths(BlendPrecision precision, const OperationLatencies& single,
                               const OperationLatencies& half) {
  const RenderingFlow of = rendering_flow(precision);
  const OperationLatencies& blending = precision == BlendPrecision::kHalf ? half : single;
  RenderingPaths paths;
  const DataFlow begin = spans_begin_flow();
  paths.spans_begin = begin.longest_path(0, begin.size(), single);
  paths.span = of.flow.longest_path(of.spans_begun, of.spanned, single);
  paths.conic = of.flow.longest_path(of.spanned, of.in_base_2, single);
  paths.blend = of.flow.longest_path(of.in_base_2, of.flow.size(), blending);
  paths.state_loop = of.flow.longest_path_from(of.state, blending);
  return paths;
}

std::vector<LaneStep> coarse_steps(CoarseBoundBy bound_by, const FilterCase& tested,
                                   std::uint32_t across, const OperationLatencies& latencies) {
  const DataFlow flow = coarse_flow(bound_by, tested, across);
  return lane_steps(flow, 0, flow.size(), latencies);
}

std::vector<LaneStep> fine_steps(const FilterCase& tested, const FineRecord& record,
                                 const OperationLatencies& latencies) {
  const DataFlow flow = fine_flow(tested, record).flow;
  return lane_steps(flow, 0, flow.size(), latencies);
}

std::vector<LaneStep> spans_begin_steps(const OperationLatencies& single) {
  const DataFlow flow = spans_begin_flow();
  return lane_steps(flow, 0, flow.size(), single);
}

std::vector<LaneStep> span_steps(const OperationLatencies& single) {
  const RenderingFlow of = rendering_flow(BlendPrecision::kSingle);
  return lane_steps(of.flow, of.spans_begun, of.spanned, single, {of.edge});
}

std::vector<LaneStep> conic_steps(const OperationLatencies& single) {
  const RenderingFlow of = rendering_flow(BlendPrecision::kSingle);
  return lane_steps(of.flow, of.spanned, of.in_base_2, single);
}

namespace {

// From `first` on to the end.
std::vector<LaneStep> blend_steps_from(const RenderingFlow& of, std::size_t first,
                                       const OperationLatencies& latencies) {
  constexpr std::size_t kOfPixel = 4;  // transmittance, red, green, blue
  std::vector<std::vector<std::uint32_t>> pixels;
  for (auto at = of.state.begin(); at != of.state.end(); at += kOfPixel) {
    pixels.emplace_back(at, at + kOfPixel);
  }
  return lane_steps(of.flow, first, of.flow.size(), latencies, pixels);
}

}  // namespace

std::vector<LaneStep> blend_steps(BlendPrecision precision, const OperationLatencies& latencies) {
  const RenderingFlow of = rendering_flow(precision);
  return blend_steps_from(of, of.in_base_2, latencies);
}

std::vector<LaneStep> corner_steps(const OperationLatencies& single) {
  const RenderingFlow of = rendering_flow(BlendPrecision::kSingle);
  std::vector<LaneStep> steps = lane_steps(of.flow, of.in_base_2, of.cornered, single);
  for (LaneStep& step : steps) step.kept = step.by == StepBy::kLane;
  return steps;
}

std::vector<LaneStep> blend_from_corner_steps(BlendPrecision precision,
                                              const OperationLatencies& latencies) {
  const RenderingFlow of = rendering_flow(precision);
  return blend_steps_from(of, of.cornered, latencies);
}

OperationCounts FineWork::total() const { return decode + geometry + group_test + colour; }

}  // namespace sgs
