// The command bus of a channel, or the two where rows and columns have one each: how commands lie
// on it, and which of its cycles are taken.
#pragma once

#include <array>
#include <cstdint>

#include "modules/dram/command.h"
#include "modules/dram/memspec.h"

namespace sgs {

// Cycles that a command takes. Timings count from its last one.
struct CommandShape {
  std::uint64_t cycles = 1;  // from its first one on, a bit each
  std::uint32_t lead = 0;    // from its first to its last
  std::uint32_t bus = 0;
};

using CommandShapes = std::array<CommandShape, kCommands>;

inline CommandShapes command_shapes(const Memspec::CommandBus& bus) {
  const auto in_a_row = [](std::uint32_t cycles, std::uint32_t on) {
    return CommandShape{(std::uint64_t{1} << cycles) - 1, cycles - 1, on};
  };
  CommandShape activate = in_a_row(bus.activate, 0);
  if (bus.activate_gap > 0) {
    activate.lead = bus.activate_gap + 1;
    activate.cycles = std::uint64_t{1} << activate.lead | 1;
  }
  CommandShapes shapes;
  for (std::size_t i = 0; i < kCommands; ++i) {
    const auto command = static_cast<Command>(i);
    const bool power_down =
        command == Command::kPowerDownEnter || command == Command::kPowerDownExit;
    if (is_read(command) || is_write(command))
      shapes[i] = in_a_row(bus.column, bus.buses - 1);
    else if (!power_down)
      shapes[i] = in_a_row(bus.row, 0);
  }
  shapes[static_cast<std::size_t>(Command::kActivate)] = activate;
  return shapes;
}

// Commands are put on it in the order of their first cycles.
class CommandBus {
 public:
  explicit CommandBus(const Memspec::CommandBus& bus)
      : shapes_(command_shapes(bus)), separate_(bus.buses > 1) {}

  const CommandShape& shape(Command command) const {
    return shapes_[static_cast<std::size_t>(command)];
  }
  // Rows and columns have one each.
  bool separate() const { return separate_; }

  // The first cycle of a command, from `first` on; that is not before the last command's.
  std::uint64_t fit(const CommandShape& shape, std::uint64_t first) const {
    const Bus& bus = buses_[shape.bus];
    while (first - bus.from < 64 && (bus.taken >> (first - bus.from) & shape.cycles) != 0) ++first;
    return first;
  }

  void take(const CommandShape& shape, std::uint64_t first) {
    Bus& bus = buses_[shape.bus];
    const std::uint64_t later = first - bus.from;
    bus.taken = (later < 64 ? bus.taken >> later : 0) | shape.cycles;
    bus.from = first;
  }

 private:
  struct Bus {
    std::uint64_t from = 0;   // first cycle of the last command
    std::uint64_t taken = 0;  // cycles from there on, a bit each
  };

  const CommandShapes shapes_;
  const bool separate_;
  std::array<Bus, 2> buses_;
};

}  // namespace sgs
