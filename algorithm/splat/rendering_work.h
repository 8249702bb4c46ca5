// What rendering does for a splat, counted by running it.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/splat/blend.h"
#include "algorithm/splat/lane_steps.h"
#include "algorithm/splat/longest_path.h"
#include "algorithm/splat/operation_counts.h"

namespace sgs {

// Of rendering: a splat's spans are begun once; each row of sub-tiles adds one; each sub-tile is
// blended. What its 16 pixels share (a column's A dx^2, a row's C dy^2) counts once. Ahead of all
// log2(e) goes into the splat's conic, in single precision; for blending in half its square is
// completed there.
struct RenderingWork {
  OperationCounts conic, spans_begin, span, subtile_blend;
  // The same with lanes of its own for where the splat's centre is beside the sub-tile: always in
  // single precision, as the centre is.
  OperationCounts corner, blend_from_corner;
};
RenderingWork rendering_work(BlendPrecision precision);

// Of a splat's spans until its first row can begin, of a row's, of its conic, of a pixel's blend,
// and from a pixel's state to what is written back. Latencies of lanes in single and in half
// precision.
struct RenderingPaths {
  LongestPath spans_begin, span, conic, blend, state_loop;
};
RenderingPaths rendering_paths(BlendPrecision precision, const OperationLatencies& single,
                               const OperationLatencies& half);

// Words that a splat's rows take of its beginning.
constexpr std::uint32_t kBegunSpanWords = 10;

// Of the beginning of a splat's spans, to the words that its rows take; of a row's span, the edge
// above it coming when it is needed, its own kept to the end, for the next; of the conic; of a
// sub-tile's blend, each pixel's state coming at once when it is needed.
std::vector<LaneStep> spans_begin_steps(const OperationLatencies& single);
std::vector<LaneStep> span_steps(const OperationLatencies& single);
std::vector<LaneStep> conic_steps(BlendPrecision precision, const OperationLatencies& single);
std::vector<LaneStep> blend_steps(BlendPrecision precision, const OperationLatencies& latencies);
// The same in two parts.
std::vector<LaneStep> corner_steps(const OperationLatencies& single);
std::vector<LaneStep> blend_from_corner_steps(BlendPrecision precision,
                                              const OperationLatencies& latencies);

// The same from the corner on of a splat whose numbers come as halves, its square completed
// (algorithm/memory/tile_records.h): nothing is rounded but where its centre is.
OperationCounts blend_of_halves_work();
std::vector<LaneStep> blend_of_halves_steps(const OperationLatencies& half);

// Such a splat for blending in single: its conic's terms come back, and log2(e) into them.
DataFlow terms_of_square_flow();

}  // namespace sgs
