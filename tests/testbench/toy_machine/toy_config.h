// What can be chosen about the toy machine.
#pragma once

#include <cstdint>

#include "algorithm/memory/frame_buffer.h"
#include "modules/config/config_visitor.h"
#include "tlm/memory_port.h"

namespace sgs::toy {

struct FetchConfig {
  std::uint32_t block_gaussians = 8;  // first halves read at once
  std::uint32_t buffer_blocks = 2;    // on their way or waiting
};

struct WriteConfig {
  std::uint32_t pixels_per_cycle = 4;
};

struct ToyConfig {
  double clock_mhz = 500;
  std::uint32_t group_px = 16;  // side of a group of pixels, all of one colour
  std::uint32_t queue_entries = 2;
  FrameFormat framebuffer = FrameFormat::kRgb8;
  FetchConfig fetch;
  WriteConfig write;
  MemoryPortConfig memory_port;
};

void visit(ConfigVisitor& v, FetchConfig& config);
void visit(ConfigVisitor& v, WriteConfig& config);
void visit(ConfigVisitor& v, ToyConfig& config);

// The one on-chip memory.
constexpr const char* kScratch = "scratch";
constexpr std::uint64_t kScratchBytes = 4096;

}  // namespace sgs::toy
