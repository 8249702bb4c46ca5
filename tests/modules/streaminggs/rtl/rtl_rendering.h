// The rendering unit in Verilog, to which splats of groups are given: its pixels and its cycles.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/splat/rects.h"
#include "algorithm/splat/splat.h"

namespace sgs::test {

struct RtlPixel {
  std::uint32_t red, green, blue, light;  // bits
};
struct RtlGroup {
  std::vector<RtlPixel> pixels;  // row by row
  std::uint64_t closes = 0;      // cycle in which its last blend has begun
  std::uint64_t drained = 0;     // cycle in which the next group can begin
};
struct RtlFrame {
  std::vector<RtlGroup> groups;
  std::uint64_t blends = 0, hidden = 0;  // sub-tiles, splats
};

// splats: [group] in order, each group's behind those before it. The token of a splat or of a
// group's end is there in cycle `first_token` at the earliest, the next one a cycle later.
RtlFrame render_in_verilog(const std::vector<PixelRect>& groups,
                           const std::vector<std::vector<Splat>>& splats,
                           std::uint64_t first_token);

}  // namespace sgs::test
