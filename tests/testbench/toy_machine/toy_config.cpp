// Keys of the toy machine.
#include "tests/testbench/toy_machine/toy_config.h"

#include "modules/memory_port_keys.h"

namespace sgs::toy {

void visit(ConfigVisitor& v, FetchConfig& c) {
  v("block_gaussians", c.block_gaussians, in_range(1, 1024), "first halves read at once");
  v("buffer_blocks", c.buffer_blocks, in_range(1, 64), "blocks on their way or waiting");
}

void visit(ConfigVisitor& v, WriteConfig& c) {
  v("pixels_per_cycle", c.pixels_per_cycle, in_range(1, 64), "written to the frame");
}

void visit(ConfigVisitor& v, ToyConfig& c) {
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

}  // namespace sgs::toy
