// Transactions of an access, one after the other.
#include "tlm/port_estimate.h"

#include <algorithm>

namespace sgs {
namespace {

constexpr std::uint64_t kWindowCycles = 16;  // in which answers come as if at once

}  // namespace

PortEstimate::PortEstimate(const MemoryPortConfig& config, MemoryEstimate& memory,
                           std::uint8_t requester)
    : config_(config), memory_(memory), requester_(requester), back_(kWindowCycles) {}

// The first of them makes room.
std::uint64_t PortEstimate::room_from(Answers& answers, std::uint32_t most) {
  if (answers.size() < most) return 0;
  const std::uint64_t first = answers.top();
  answers.pop();
  return first;
}

PortEstimate::Access PortEstimate::read(std::uint64_t now, std::uint64_t address,
                                        std::uint32_t bytes, std::uint8_t region) {
  traffic_.read(bytes);
  return start(now, Direction::kRead, address, bytes, region);
}

PortEstimate::Access PortEstimate::write(std::uint64_t now, std::uint64_t address,
                                         std::uint32_t bytes, std::uint8_t region) {
  traffic_.write(bytes);
  return start(now, Direction::kWrite, address, bytes, region);
}

PortEstimate::Access PortEstimate::start(std::uint64_t now, Direction direction,
                                         std::uint64_t address, std::uint32_t bytes,
                                         std::uint8_t region) {
  const std::uint64_t step = config_.max_transaction_bytes, end = address + bytes;
  const bool writes = direction == Direction::kWrite;
  Access access{now, now};
  while (address < end) {
    const auto length =
        static_cast<std::uint32_t>(std::min(end, (address / step + 1) * step) - address);
    ++traffic_.transactions;
    std::uint64_t leaves =
        std::max({access.sent, next_leaves_, room_from(outstanding_, config_.max_outstanding)});
    if (writes) leaves = std::max(leaves, room_from(writes_, config_.max_writes));
    const std::uint64_t cycles = writes ? words(length) : 1;
    next_leaves_ = leaves + cycles;
    const std::uint64_t comes = leaves + config_.path_cycles + cycles - 1;
    std::uint64_t answered =
        memory_.answered(comes, {direction, requester_, region, address, length}) +
        config_.path_cycles;
    if (writes) {
      writes_.push(answered);
    } else {
      answered = back_.book(answered - words(length), words(length));
    }
    outstanding_.push(answered);
    access.sent = leaves;
    access.answered = std::max(access.answered, answered);
    last_answered_ = std::max(last_answered_, answered);
    address += length;
  }
  return access;
}

}  // namespace sgs
