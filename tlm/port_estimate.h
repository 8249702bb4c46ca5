// A MemoryPort (memory_port.h) without a kernel: when what it is asked for leaves and is answered.
#pragma once

#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

#include "tlm/booked_time.h"
#include "tlm/memory_estimate.h"
#include "tlm/memory_port.h"

namespace sgs {

class PortEstimate {
 public:
  // requester: the port's number among those of the machine.
  PortEstimate(const MemoryPortConfig& config, MemoryEstimate& memory, std::uint8_t requester);

  struct Access {
    std::uint64_t sent = 0;      // the cycle in which the last transaction is on its path
    std::uint64_t answered = 0;  // and in which the last is answered
  };
  Access read(std::uint64_t now, std::uint64_t address, std::uint32_t bytes, std::uint8_t region);
  Access write(std::uint64_t now, std::uint64_t address, std::uint32_t bytes, std::uint8_t region);

  void charge_to(std::size_t part) { traffic_.charge_to(part); }
  const PortTraffic& traffic() const { return traffic_; }
  // When everything is answered that was asked for.
  std::uint64_t all_answered() const { return last_answered_; }

 private:
  Access start(std::uint64_t now, Direction direction, std::uint64_t address, std::uint32_t bytes,
               std::uint8_t region);
  std::uint64_t words(std::uint64_t bytes) const {
    return (bytes + config_.width_bytes - 1) / config_.width_bytes;
  }

  const MemoryPortConfig config_;
  MemoryEstimate& memory_;
  const std::uint8_t requester_;
  // When what is under way will be answered, of all and of writes: at most as many as there may be.
  using Answers = std::priority_queue<std::uint64_t, std::vector<std::uint64_t>, std::greater<>>;
  static std::uint64_t room_from(Answers& answers, std::uint32_t most);
  Answers outstanding_, writes_;
  BookedTime back_;  // the path of the answers' words
  std::uint64_t next_leaves_ = 0, last_answered_ = 0;
  PortTraffic traffic_;
};

}  // namespace sgs
