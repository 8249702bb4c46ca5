// Parameters of the rendering unit.
#pragma once

#include <cstdint>

#include "modules/config/config_visitor.h"

namespace sgs {

struct RenderingConfig {
  std::uint32_t clusters = 4;       // 4x4 sub-tiles blended a cycle: 64 pixels
  std::uint32_t depth_cycles = 3;   // alpha, transmittance, blend
  std::uint32_t pixel_buffers = 2;  // groups whose pixels are on chip; 2: drain while blending
  std::uint32_t drain_pixels_per_cycle = 8;  // conversion to the frame's format
  bool ellipse_test = true;                  // skips sub-tiles that the ellipse cannot reach
  std::uint32_t subtile_tests_per_cycle = 16;
  bool saturation_feedback = true;  // a finished group's visits are dropped upstream
  // A register where it leaves, a wire over at most the side of the die (2.3 mm, below a cycle at
  // 32 nm), a register where it arrives.
  std::uint32_t feedback_latency_cycles = 2;
  std::uint32_t input_fifo_entries = 8;  // sorted splats waiting, for each sorting unit
};

void visit(ConfigVisitor& v, RenderingConfig& config);

// Bytes of state a pixel: R, G, B and transmittance in float.
constexpr std::uint32_t kPixelStateBytes = 16;

}  // namespace sgs
