// Rendering runs with the counting scalar.
#include "algorithm/splat/rendering_work.h"

#include <cstddef>
#include <tuple>

#include "algorithm/splat/counting_half.h"
#include "algorithm/splat/flow_ends.h"
#include "algorithm/splat/lane_input.h"
#include "algorithm/splat/row_span.h"
#include "algorithm/splat/square_conic.h"

namespace sgs {
namespace {

constexpr std::size_t kBesideBlend = 1;  // a word that goes along: the sub-tile's number

// What blending does for 16 pixels, in the arithmetic T; state(value): of a pixel, from outside.
template <class T, class Conic, class State>
void blend_work(const LaneInput<T, Conic>& in, const State& state) {
  for (int lane = 0; lane < kSubtilePixels; ++lane) {
    const T dx = in.left - T(static_cast<float>(lane % kSubtilePx) * in.pixel_x);
    const T dy = in.top - T(static_cast<float>(lane / kSubtilePx) * in.pixel_y);
    const T exponent = log2_falloff(in.conic, dx, dy);
    const T alpha = alpha_of(exponent, exp2_of(exponent), in.opacity);
    const LightShare<T> light = take_light(alpha, T(state(0.5F)));
    static_cast<void>(light.after < constant<T>(kTransmittanceMin));
    for (const T& colour : {in.red, in.green, in.blue}) {
      static_cast<void>(T(state(0.25F)) + colour * light.weight);
    }
  }
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

// A pixel's numbers come when they are taken.
auto state_into(RenderingFlow& of) {
  return [&of](float value) {
    const Counting of_pixel = input(of.flow, value);
    of.state.push_back(of_pixel.node);
    return of_pixel;
  };
}

// Of a splat whose numbers come as halves, in units of its own, from the corner on.
RenderingFlow halves_flow() {
  RenderingFlow out;
  constexpr AxisUnits kUnits = {0.125F, 0.25F};
  const auto half = [&](float value) { return CountingHalf(input(out.flow, value)); };
  const Counting left = input(out.flow, 5.5F), top = input(out.flow, 5.25F);
  out.flow.pass_beside(kBesideBlend);
  blend_work(
      LaneInput<CountingHalf, SquareConic<CountingHalf>>{{half(-0.7F), half(0.6F), half(-0.6F)},
                                                         half(0.9F),
                                                         half(0.1F),
                                                         half(0.2F),
                                                         half(0.3F),
                                                         CountingHalf(scaled_by(left, kUnits.x)),
                                                         CountingHalf(scaled_by(top, kUnits.y)),
                                                         kUnits.x,
                                                         kUnits.y},
      state_into(out));
  return out;
}

RenderingFlow rendering_flow(BlendPrecision precision) {
  RenderingFlow out;
  DataFlow& flow = out.flow;
  const SplatOf<Counting> splat = leaning_splat(flow);
  const auto state = state_into(out);
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
  if (in_16_bits(precision)) {
    static_cast<void>(square_conic(splat.conic_a, splat.conic_b, splat.conic_c));
  } else {
    static_cast<void>(log2_conic(splat.conic_a, splat.conic_b, splat.conic_c));
  }
  out.in_base_2 = flow.size();
  flow.pass_beside(kBesideBlend);
  const Counting left = splat.x - Counting(96.0F), top = splat.y - Counting(52.0F);
  out.cornered = flow.size();
  if (in_16_bits(precision)) {
    blend_work(lane_input_in_half<CountingHalf>(square_splat(splat), left, top), state);
  } else {
    blend_work(lane_input(splat, left, top), state);
  }
  return out;
}

}  // namespace

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
  const OperationLatencies& blending = in_16_bits(precision) ? half : single;
  RenderingPaths paths;
  const DataFlow begin = spans_begin_flow();
  paths.spans_begin = begin.longest_path(0, begin.size(), single);
  paths.span = of.flow.longest_path(of.spans_begun, of.spanned, single);
  paths.conic = of.flow.longest_path(of.spanned, of.in_base_2, single);
  paths.blend = of.flow.longest_path(of.in_base_2, of.flow.size(), blending);
  paths.state_loop = of.flow.longest_path_from(of.state, blending);
  return paths;
}

std::vector<LaneStep> spans_begin_steps(const OperationLatencies& single) {
  const DataFlow flow = spans_begin_flow();
  return lane_steps(flow, 0, flow.size(), single);
}

std::vector<LaneStep> span_steps(const OperationLatencies& single) {
  const RenderingFlow of = rendering_flow(BlendPrecision::kSingle);
  return lane_steps(of.flow, of.spans_begun, of.spanned, single, {of.edge});
}

std::vector<LaneStep> conic_steps(BlendPrecision precision, const OperationLatencies& single) {
  const RenderingFlow of = rendering_flow(precision);
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

OperationCounts blend_of_halves_work() {
  const RenderingFlow of = halves_flow();
  return of.flow.counts(0, of.flow.size());
}

std::vector<LaneStep> blend_of_halves_steps(const OperationLatencies& half) {
  return blend_steps_from(halves_flow(), 0, half);
}

DataFlow terms_of_square_flow() {
  DataFlow flow;
  const SquareConic<Counting> square = {input(flow, -0.02F), input(flow, 0.3F),
                                        input(flow, -0.03F)};
  const ConicTerms<Counting> terms = conic_terms(square);
  const Log2Conic<Counting> conic = log2_conic(terms.a, terms.b, terms.c);
  keep(flow, {conic.a, conic.b, conic.c});
  return flow;
}

}  // namespace sgs
