// One channel of the memory, its commands kept.
#pragma once

#include <cstdint>
#include <vector>

#include "modules/dram/queued_channel.h"
#include "tests/modules/dram/recording_sink.h"

namespace sgs::test {

// Refresh off unless a test is about it: its commands would lie between the others. The way to the
// channel likewise.
inline DramConfig quiet_config() {
  DramConfig c;
  c.front_end_ns = c.back_end_ns = 0;
  c.channels = 1;
  c.refresh = RefreshMode::kOff;
  return c;
}

struct Bench {
  explicit Bench(const DramConfig& config)
      : memspec(load_memspec(config.memspec)), channel(config, memspec, 0, sink) {}

  void push(std::uint64_t cycle, Direction direction, std::uint32_t bank, std::uint32_t row,
            std::uint32_t burst = 0, std::uint32_t bursts = 1, std::uintptr_t owner = 0) {
    ChannelRequest r;
    r.direction = direction;
    r.bank = bank;
    r.row = row;
    r.burst = burst;
    r.bursts = bursts;
    r.owner = reinterpret_cast<void*>(owner);
    channel.advance(cycle);
    channel.push(r, cycle);
  }
  void read(std::uint64_t cycle, std::uint32_t bank, std::uint32_t row, std::uintptr_t owner = 0) {
    push(cycle, Direction::kRead, bank, row, 0, 1, owner);
  }
  std::uint64_t completion() {
    QueuedChannel::Completion c{};
    channel.advance(1000000);
    return channel.take_completion(kNever, c) ? c.cycle : 0;
  }
  // Owners in the order of their completion.
  std::vector<std::uintptr_t> order() {
    std::vector<std::uintptr_t> owners;
    QueuedChannel::Completion c{};
    channel.advance(1000000);
    while (channel.take_completion(kNever, c))
      owners.push_back(reinterpret_cast<std::uintptr_t>(c.owner));
    return owners;
  }

  RecordingSink sink;
  Memspec memspec;
  QueuedChannel channel;
};

}  // namespace sgs::test
