// The thread of the write unit.
#include "tests/testbench/toy_machine/write_unit.h"

#include <vector>

namespace sgs::toy {

WriteUnit::WriteUnit(const sc_core::sc_module_name& name, const ToyConfig& config,
                     const ClockDomain& clock, const FrameJob& job, std::function<void()> on_done)
    : sc_module(name),
      memory("memory", config.memory_port, clock.period()),
      config_(config),
      job_(job),
      on_done_(std::move(on_done)),
      write_("write", clock) {
  SC_THREAD(run);
}

void WriteUnit::run() {
  const std::vector<PixelRect> groups = groups_of(job_, config_);
  for (std::size_t done = 0; done < groups.size(); ++done) {
    const GroupColour next = colours->pop(write_);
    fill(groups[next.group], next.colour);
  }
  await_all(memory, write_);
  write_.idles();
  on_done_();
}

void WriteUnit::fill(const PixelRect& group, const glm::vec3& colour) {
  const auto width = static_cast<std::uint32_t>(group.width());
  const std::uint32_t bytes = pixel_bytes(job_.frame_format);
  std::vector<std::byte> row(std::size_t{width} * bytes);
  for (std::uint32_t x = 0; x < width; ++x) {
    encode_pixel(job_.frame_format, colour, row.data() + std::size_t{x} * bytes);
  }
  const std::uint32_t at_once = config_.write.pixels_per_cycle;
  for (int y = group.y0; y < group.y1; ++y) {
    write_.work((width + at_once - 1) / at_once);
    start_write(memory, write_, job_.pixel_address(group.x0, y), row.data(),
                static_cast<std::uint32_t>(row.size()), job_.frame_buffer.region);
    counters_.pixels += width;
  }
}

SramUses WriteUnit::sram_uses(const ToyConfig& config) {
  return {unanswered_writes("pixels", kScratch, config.memory_port,
                            config.group_px * pixel_bytes(config.framebuffer)),
          outstanding_table(kScratch, config.memory_port)};
}

void WriteUnit::publish(DataSheet& sheet) {
  sheet.unit(*this);
  sheet.activity(write_, "writing", "fills groups with their colour");
  sheet.counters(counters_);
  sheet.part("writer", "comparator", config_.write.pixels_per_cycle, 1);
  sheet.operations("writer", "comparator", static_cast<double>(counters_.pixels));
  sheet.sram(sram_uses(config_));
  sheet.port(memory, "pixels");
}

}  // namespace sgs::toy
