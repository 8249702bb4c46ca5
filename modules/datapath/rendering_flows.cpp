// Rendering runs with the counting scalar.
#include "modules/datapath/rendering_flows.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <tuple>
#include <vector>

#include "algorithm/splat/blend.h"
#include "algorithm/splat/counting.h"
#include "algorithm/splat/row_span.h"
#include "algorithm/splat/square_conic.h"

namespace sgs {
namespace {

constexpr std::size_t kBesideBlend = 1;  // a word that goes along: the sub-tile's number

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
constexpr float kSubtileLeftPx = 96, kSubtileTopPx = 52;

constexpr std::size_t kEdgeWords = 2;  // the last of RowSpans::carried()

// The beginning of a splat's spans alone: its results are the words that its rows take.
FlowPart spans_begin_flow() {
  const auto flow = std::make_shared<DataFlow>();
  RowSpans<Counting> spans(leaning_splat(*flow));
  spans.start(kFirstRowPx);
  const auto carried = spans.carried();
  static_assert(std::tuple_size_v<decltype(spans.carried())> == kBegunSpanWords);
  for (const Counting& value : carried) keep(*flow, {value});
  return whole(flow);
}

// Offset of a sub-tile's first pixel from the splat's centre, alone: its results are the sums.
FlowPart corner_flow() {
  const auto flow = std::make_shared<DataFlow>();
  static_cast<void>(input(*flow, 101.5F) - Counting(kSubtileLeftPx));
  static_cast<void>(input(*flow, 57.25F) - Counting(kSubtileTopPx));
  return whole(flow);
}

// The numbers of each pixel's state, which come together when the first of them is taken, if the
// comparisons ahead of it let them.
class PixelStates {
 public:
  explicit PixelStates(DataFlow& flow) : flow_(flow) {}
  // Begins the next pixel, whose alpha is computed from here on.
  void begin_pixel() { alpha_from_ = flow_.size(); }
  // Alpha is there: its comparisons say whether the pixel is read.
  void ask() {
    pixels_.emplace_back();
    for (std::size_t node = alpha_from_; node < flow_.size(); ++node) {
      if (flow_.nodes()[node].operation != Operation::kCompare) continue;
      pixels_.back().push_back(static_cast<std::uint32_t>(node));
    }
  }
  // The pixel's next number.
  Counting operator()(float value) {
    const Counting of_pixel = input(flow_, value);
    pixels_.back().push_back(of_pixel.node);
    return of_pixel;
  }
  const std::vector<std::vector<std::uint32_t>>& pixels() const { return pixels_; }

 private:
  DataFlow& flow_;
  std::size_t alpha_from_ = 0;
  std::vector<std::vector<std::uint32_t>> pixels_;
};

// Blends a splat into 16 pixels, in the arithmetic T.
template <class T, class Conic>
void blend_pixels(const BlendInput<T, Conic>& in, PixelStates& state) {
  for (int lane = 0; lane < kSubtilePixels; ++lane) {
    state.begin_pixel();
    const T dx = in.left - T(static_cast<float>(lane % kSubtilePx) * in.pixel_x);
    const T dy = in.top - T(static_cast<float>(lane / kSubtilePx) * in.pixel_y);
    const T exponent = log2_falloff(in.conic, dx, dy);
    const T alpha = alpha_of(exponent, exp2_of(exponent), in.opacity);
    state.ask();
    const LightShare<T> light = take_light(alpha, T(state(0.5F)));
    static_cast<void>(light.after < constant<T>(kTransmittanceMin));
    for (const T& colour : {in.red, in.green, in.blue}) {
      static_cast<void>(T(state(0.25F)) + colour * light.weight);
    }
  }
}

SquareConic<Counting> square_from_outside(DataFlow& flow) {
  return {input(flow, -0.02F), input(flow, 0.3F), input(flow, -0.03F)};
}

}  // namespace

RenderingFlows rendering_flows(BlendPrecision precision) {
  const auto flow = std::make_shared<DataFlow>();
  const SplatOf<Counting> splat = leaning_splat(*flow);
  RowSpans<Counting> spans(splat);
  // The edge above is that of another line, or the graph would find there where the row's top lies.
  spans.start(kFirstRowPx - 1);
  const std::size_t spans_begun = flow->size();
  const auto above = spans.carried();
  std::vector<std::uint32_t> edge;
  for (std::size_t i = above.size() - kEdgeWords; i < above.size(); ++i) {
    if (above[i].flow != nullptr) edge.push_back(above[i].node);
  }
  static_cast<void>(spans.next(kFirstRowPx, kFirstRowPx + kSubtilePx));
  const auto below = spans.carried();
  for (std::size_t i = below.size() - kEdgeWords; i < below.size(); ++i) keep(*flow, {below[i]});
  const std::size_t spanned = flow->size();
  if (in_16_bits(precision)) {
    static_cast<void>(square_conic(splat.conic_a, splat.conic_b, splat.conic_c));
  } else {
    static_cast<void>(log2_conic(splat.conic_a, splat.conic_b, splat.conic_c));
  }
  const std::size_t in_base_2 = flow->size();
  flow->pass_beside(kBesideBlend);
  const Counting left = splat.x - Counting(kSubtileLeftPx);
  const Counting top = splat.y - Counting(kSubtileTopPx);
  const std::size_t cornered = flow->size();
  PixelStates state(*flow);
  if (in_16_bits(precision)) {
    blend_pixels(blend_input_in_half<CountingHalf>(square_splat(splat), left, top), state);
  } else {
    blend_pixels(blend_input(splat, left, top), state);
  }
  RenderingFlows out;
  out.conic = {flow, spanned, in_base_2, {}};
  out.spans_begin = spans_begin_flow();
  out.span = {flow, spans_begun, spanned, {edge}};
  out.subtile_blend = {flow, in_base_2, flow->size(), state.pixels()};
  out.corner = corner_flow();
  out.blend_from_corner = {flow, cornered, flow->size(), state.pixels()};
  return out;
}

FlowPart blend_of_halves_flow() {
  const auto flow = std::make_shared<DataFlow>();
  constexpr AxisUnits kUnits = {0.125F, 0.25F};
  const auto half = [&](float value) { return CountingHalf(input(*flow, value)); };
  const Counting left = input(*flow, 5.5F), top = input(*flow, 5.25F);
  flow->pass_beside(kBesideBlend);
  PixelStates state(*flow);
  blend_pixels(
      BlendInput<CountingHalf, SquareConic<CountingHalf>>{{half(-0.7F), half(0.6F), half(-0.6F)},
                                                          half(0.9F),
                                                          half(0.1F),
                                                          half(0.2F),
                                                          half(0.3F),
                                                          CountingHalf(scaled_by(left, kUnits.x)),
                                                          CountingHalf(scaled_by(top, kUnits.y)),
                                                          kUnits.x,
                                                          kUnits.y},
      state);
  return {flow, 0, flow->size(), state.pixels()};
}

void ask_where_alpha_passes(Datapath& blend) {
  blend.between.registers += kSubtilePixels;
  blend.between.written += kSubtilePixels;
  blend.between.multiplexers += kSubtilePixels;
  blend.between.selected += kSubtilePixels;
}

PixelWrites pixel_writes(const Datapath& blend, SramPorts ports) {
  PixelWrites out;
  for (const DatapathLoop& pixel : blend.loops) {
    const bool meets = (pixel.cycles() + kAskedReadCycles) % blend.interval_cycles() == 0;
    const std::uint32_t wait = ports == SramPorts::kOne && meets ? 1 : 0;
    const std::uint32_t written = pixel.end + wait;
    out.loop_cycles = std::max(out.loop_cycles, pixel.cycles() + wait);
    if (written <= blend.depth_cycles) continue;
    out.wait_cycles = std::max(out.wait_cycles, written - blend.depth_cycles);
    ++out.held;
  }
  return out;
}

FlowPart conic_terms_flow() {
  constexpr std::size_t kBeside = 5;  // words: centre, opacity and colour as halves, footprint
  const auto flow = std::make_shared<DataFlow>();
  const ConicTerms<Counting> terms = conic_terms(square_from_outside(*flow));
  keep(*flow, {terms.a, terms.b, terms.c});
  flow->pass_beside(kBeside);
  return whole(flow);
}

FlowPart terms_of_square_flow() {
  const auto flow = std::make_shared<DataFlow>();
  const ConicTerms<Counting> terms = conic_terms(square_from_outside(*flow));
  const Log2Conic<Counting> conic = log2_conic(terms.a, terms.b, terms.c);
  keep(*flow, {conic.a, conic.b, conic.c});
  return whole(flow);
}

FlowPart pixel_flow(FrameFormat format) {
  const auto flow = std::make_shared<DataFlow>();
  const Counting transmittance = input(*flow, 0.25F);
  for (const float background : {0.5F, 0.25F, 0.125F}) {
    const Counting channel =
        over_background(input(*flow, 0.5F), transmittance, Counting(background));
    if (format == FrameFormat::kRgb8) static_cast<void>(level_of(channel));
  }
  return whole(flow);
}

}  // namespace sgs
