// Parameters that the buffers of a streaming machine are sized for, whatever the scene and the
// frame.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/memory/frame_buffer.h"
#include "algorithm/memory/number_format.h"
#include "algorithm/memory/record_split.h"
#include "algorithm/memory/second_half.h"
#include "algorithm/splat/rects.h"
#include "modules/datapath/lane_steps.h"
#include "tlm/memory_port.h"

namespace sgs {

struct BuiltFor {
  PixelSize group;
  FrameFormat frame_format = FrameFormat::kRgb8;
  SecondHalfFormat second_half;                               // the widest
  std::uint32_t first_half_bytes = 0, second_half_bytes = 0;  // the largest of any degree
  std::vector<FineRecord> fine_records;                       // one of each SH degree
  std::uint32_t chunk_gaussians = 0;                          // exact order: most in one chunk
  NumberFormat splats = NumberFormat::kSingle;                // on their way through sorting
  std::uint32_t eyes = 1;
  MemoryPortConfig memory_port;              // port of each unit
  OperationLatencies single, half{2, 1, 1};  // lanes of each precision
};

// The on-chip memories.
constexpr const char* kInputSram = "input";
constexpr const char* kCodebookSram = "codebook";
constexpr const char* kSharedSram = "shared";

}  // namespace sgs
