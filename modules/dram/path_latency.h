// The way between the memory's socket and its data bus, in cycles of the memory's clock.
#pragma once

#include <cmath>
#include <cstdint>

#include "modules/dram/command.h"
#include "modules/dram/dram_config.h"
#include "modules/dram/memspec.h"

namespace sgs {

struct PathLatency {
  PathLatency(const DramConfig& config, const Memspec& memspec)
      : front_end(cycles(config.front_end_ns, memspec.clock_period_ns)),
        back_end_read(cycles(config.back_end_ns, memspec.clock_period_ns)),
        back_end_write(config.posted_writes ? 0 : back_end_read) {}

  std::uint32_t back_end(Direction direction) const {
    return direction == Direction::kRead ? back_end_read : back_end_write;
  }

  std::uint32_t front_end;      // arrival to first command
  std::uint32_t back_end_read;  // last datum to answer
  std::uint32_t
      back_end_write;  // 0 where writes are posted: the answer does not wait for the datum

 private:
  static std::uint32_t cycles(double ns, double period_ns) {
    constexpr double kRounding = 1e-9;  // 10 ns are 8 cycles of 1.25 ns
    return static_cast<std::uint32_t>(std::ceil(ns / period_ns - kRounding));
  }
};

}  // namespace sgs
