// The commands that a controller sends to a DRAM device.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace sgs {

enum class Command : std::uint8_t {
  kActivate,
  kRead,
  kReadAuto,  // with auto-precharge
  kWrite,
  kWriteAuto,
  kPrecharge,
  kPrechargeAll,
  kRefreshAll,
  kRefreshBank,
  kPowerDownEnter,
  kPowerDownExit,
  kSelfRefreshEnter,
  kSelfRefreshExit,
};
constexpr std::size_t kCommands = 13;

// Names of the commands in command traces.
constexpr std::array<const char*, kCommands> kCommandNames = {
    "ACT", "RD", "RDA", "WR", "WRA", "PRE", "PREA", "REFA", "REFB", "PDE", "PDX", "SRE", "SRX"};

constexpr std::uint32_t kNoRow = 0xffffffff;  // a closed bank

// One command as it went over the command bus. Fields that it has no use for are 0.
struct CommandRecord {
  std::uint64_t cycle;
  Command command;
  std::uint8_t channel;
  std::uint8_t rank;
  std::uint8_t bank;
  std::uint8_t region;  // region of the request that it serves
  std::uint32_t row;    // activate
  std::uint32_t burst;  // read, write: which burst of the row
};

// Takes every command; those of a channel in the order of their cycles.
class CommandSink {
 public:
  virtual ~CommandSink() = default;
  virtual void on_command(const CommandRecord& record) = 0;
};

// Whoever sends commands. They may be worked out late: up to which moment sinks have heard of them
// shows only after catch_up().
class CommandSource {
 public:
  virtual ~CommandSource() = default;
  // `sink` hears every command from now on; it must be removed before it goes.
  virtual void add_command_sink(CommandSink& sink) = 0;
  virtual void remove_command_sink(CommandSink& sink) = 0;
  // Hands on everything that happened before now.
  virtual void catch_up() = 0;
};

constexpr bool is_read(Command c) { return c == Command::kRead || c == Command::kReadAuto; }
constexpr bool is_write(Command c) { return c == Command::kWrite || c == Command::kWriteAuto; }

}  // namespace sgs
