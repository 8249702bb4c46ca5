// What rendering takes: counts that can be told from the formulas.
#include "modules/datapath/rendering_flows.h"

#include <catch2/catch.hpp>

#include "tests/modules/datapath/flow_parts.h"

namespace sgs::test {

TEST_CASE("rendering flows: a splat, counted by hand") {
  const RenderingFlows flows = rendering_flows(BlendPrecision::kSingle);
  const OperationCounts blend = flows.subtile_blend.counts();
  // By hand, a sub-tile: its corner from the centre, 4 columns of dx, A dx^2
  // (2) and B dx, 4 rows of dy and C dy^2 (2). 16 pixels of two sums and a product of the exponent,
  // a parabola, opacity, weight, T behind, and three products and sums of colour; the end of the
  // table, the cap, two selections, the end of T.
  CHECK(blend.multiplies == 4 * 3 + 4 * 2 + 16 * (1 + 2 + 1 + 1 + 3));
  CHECK(blend.adds == 2 + 4 + 4 + 16 * (2 + 2 + 1 + 3));
  CHECK(blend.fused == 16 * (1 + 2 + 3));
  CHECK(folded_macs(blend) == 30 + 16 * 10);
  CHECK(macs(flows.conic) == 3);
  // Where the centre is: two sums that a machine may have lanes of their own for.
  CHECK(macs(flows.corner) == 2);
  CHECK(macs(flows.blend_from_corner) == 28 + 16 * 10);
  CHECK(blend.look_ups == 16);
  CHECK(blend.splits == 16);
  CHECK(blend.scalings == 16);
  CHECK(blend.exponentials == 0);
  CHECK(blend.comparisons == 16 * 5);
  // In half: 4 columns of dx, 4 rows of dy, its part of the length across and the second square
  // (2); a sum and two products for the first square, a line for a parabola. Five numbers scaled by
  // a power of two.
  const RenderingFlows in_half = rendering_flows(BlendPrecision::kHalf);
  const OperationCounts half = in_half.subtile_blend.counts(), conic = in_half.conic.counts();
  CHECK(half.multiplies == 4 * 3 + 16 * (2 + 1 + 1 + 1 + 3));
  CHECK(half.adds == 2 + 4 + 4 + 16 * (2 + 1 + 1 + 3));
  CHECK(half.fused == 16 * (1 + 1 + 3));
  CHECK(folded_macs(half) == 22 + 16 * 10);
  CHECK(macs(in_half.blend_from_corner) == 20 + 16 * 10);
  CHECK(half.comparisons == 16 * 5);
  CHECK(half.scalings == 16 + 5);
  // What nothing has rounded before: opacity and colour.
  CHECK(half.roundings == 4);
  // Once a splat, in single precision: the quotient B/A, the rest C - B (B/A), two products with
  // log2(e); A at least 2^-26 of C, and no 0.
  CHECK(conic.divisions == 1);
  CHECK(conic.divisors == 1);
  CHECK(folded_macs(conic) == kReciprocalMacs + kQuotientMacs + 1 + 2);
  CHECK(conic.comparisons == 2);
  CHECK(conic.scalings == 1);
  // Of a record that holds halves: only where the centre is gets units; nothing is rounded.
  const OperationCounts of_halves = blend_of_halves_flow().counts();
  CHECK(folded_macs(of_halves) == macs(in_half.blend_from_corner));
  CHECK(of_halves.comparisons == 16 * 5);
  CHECK(of_halves.scalings == 16 + 2);
  CHECK(of_halves.roundings == 0);
  // Such a record in single: three products, a sum with one; three products with log2(e).
  CHECK(macs(terms_of_square_flow()) == 4 + 3);
  CHECK(blend.roundings == 0);
  CHECK(flows.span.counts().square_roots == 1);
  CHECK(flows.spans_begin.counts().square_roots == 2);
}

TEST_CASE("rendering flows: a finished pixel, counted by hand") {
  // A channel: background through the light that is left; times 255; two ends and a rounding.
  const OperationCounts bytes = pixel_flow(FrameFormat::kRgb8).counts();
  CHECK(folded_macs(bytes) == 3 * 2);
  CHECK(comparisons(bytes) == 3 * (2 + kRoundingComparisons));
  const OperationCounts floats = pixel_flow(FrameFormat::kRgb32f).counts();
  CHECK(folded_macs(floats) == 3);
  CHECK(comparisons(floats) == 0);
}

}  // namespace sgs::test
