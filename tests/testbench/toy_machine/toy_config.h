// What can be chosen about the toy machine.
#pragma once

#include <cstdint>

#include "algorithm/memory/frame_buffer.h"
#include "modules/config/config_visitor.h"
#include "tlm/memory_port.h"

namespace sgs::toy {

struct FetchConfig {
  std::uint32_t block_gaussians = 8;
  std::uint32_t buffer_blocks = 2;
};

inline void visit(ConfigVisitor& v, FetchConfig& c) {
  v("block_gaussians", c.block_gaussians, in_range(1, 1024), "first halves read at once");
  v("buffer_blocks", c.buffer_blocks, in_range(1, 64), "blocks on their way or waiting");
}

struct WriteConfig {
  std::uint32_t pixels_per_cycle = 4;
};

inline void visit(ConfigVisitor& v, WriteConfig& c) {
  v("pixels_per_cycle", c.pixels_per_cycle, in_range(1, 64), "written to the frame");
}

struct ToyConfig {
  double clock_mhz = 500;
  std::uint32_t group_px = 16;
  std::uint32_t queue_entries = 2;
  FrameFormat framebuffer = FrameFormat::kRgb8;
  FetchConfig fetch;
  WriteConfig write;
  MemoryPortConfig memory_port;
};

inline void visit(ConfigVisitor& v, ToyConfig& c) {
  v("clock_mhz", c.clock_mhz, in_range(1, 10000), "clock of both units");
  v("group_px", c.group_px, in_range(1, 1024), "side of a group of pixels, all of one colour");
  v("queue_entries", c.queue_entries, in_range(1, 64), "colours between the units");
  v("framebuffer", c.framebuffer,
    names<FrameFormat>({{"rgb8", FrameFormat::kRgb8}, {"rgb32f", FrameFormat::kRgb32f}}),
    "pixels in DRAM");
  v.section("fetch", c.fetch, "reads Gaussians");
  v.section("write", c.write, "writes pixels");
  v.section("memory_port", c.memory_port, "how units talk to memory");
}

// The one on-chip memory.
constexpr const char* kScratch = "scratch";
constexpr std::uint64_t kScratchBytes = 4096;

}  // namespace sgs::toy
