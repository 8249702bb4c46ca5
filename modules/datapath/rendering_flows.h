// Operations of rendering a splat, recorded by running it.
#pragma once

#include <cstdint>

#include "algorithm/memory/frame_buffer.h"
#include "algorithm/splat/blend.h"
#include "modules/datapath/lane_steps.h"
#include "tlm/datapath.h"
#include "tlm/sram_use.h"

namespace sgs {

// Words that a splat's rows take of its beginning.
constexpr std::uint32_t kBegunSpanWords = 10;

// A splat's spans are begun once, to the words that its rows take. Each row of sub-tiles adds one:
// the edge above it comes when it is needed, its own is kept for the next. Each sub-tile is
// blended, each pixel's state coming at once when it is needed. Terms that its 16 pixels share (a
// column's A dx^2, a row's C dy^2) count once. Ahead of all, log2(e) goes into the splat's conic,
// in single precision; for blending in half its square is completed there.
struct RenderingFlows {
  FlowPart conic, spans_begin, span, subtile_blend;
  // The blend with lanes of its own for where the splat's centre is beside the sub-tile: always in
  // single precision, as the centre is.
  FlowPart corner, blend_from_corner;
};
RenderingFlows rendering_flows(BlendPrecision precision);

// The blend from the corner on of a splat whose numbers come as halves, its square completed
// (algorithm/memory/tile_records.h): nothing is rounded but where its centre is.
FlowPart blend_of_halves_flow();

// The terms of such a splat's conic, for its spans and for what else takes a whole splat.
FlowPart conic_terms_flow();

// Such a splat for blending in single: its conic's terms come back, and log2(e) into them.
FlowPart terms_of_square_flow();

// Memories of pixels are asked only for those that are not finished and whose alpha passes: a bit
// each, which the schedule waits for. What a blend has finished goes past the memory of finished
// pixels to a blend that asks meanwhile.
void ask_where_alpha_passes(Datapath& blend);

// How a blend writes its pixels. With one port a pixel's write waits a cycle where it would meet
// the read of the same place for another sub-tile.
struct PixelWrites {
  std::uint32_t loop_cycles = 0;  // the longest, from a pixel's arrival to its result and its wait
  std::uint32_t wait_cycles = 0;  // of the last write, behind the end of the schedule
  std::uint32_t held = 0;         // pixels that wait behind that, in registers of their own
};
PixelWrites pixel_writes(const Datapath& blend, SramPorts ports);

// Operations on a finished pixel on its way to the frame: the background through the light that is
// left, then its bytes.
FlowPart pixel_flow(FrameFormat format);

}  // namespace sgs
