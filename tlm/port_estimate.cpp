// Transactions of an access, one after the other.
#include "tlm/port_estimate.h"

#include <algorithm>

namespace sgs {

PortEstimate::PortEstimate(const MemoryPortConfig& config, MemoryEstimate& memory,
                           std::uint8_t requester)
    : config_(config),
      memory_(memory),
      requester_(requester),
      outstanding_(config.max_outstanding),
      writes_(config.max_writes) {}

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
    std::uint64_t& place = outstanding_[traffic_.transactions++ % outstanding_.size()];
    std::uint64_t leaves = std::max({access.sent, next_leaves_, place});
    std::uint64_t cycles = 1;
    if (writes) {
      leaves = std::max(leaves, writes_[sent_writes_ % writes_.size()]);
      cycles = words(length);
    }
    next_leaves_ = leaves + cycles;
    const std::uint64_t comes = leaves + config_.path_cycles + cycles - 1;
    std::uint64_t answered =
        memory_.answered(comes, {direction, requester_, region, address, length}) +
        config_.path_cycles;
    if (writes) {
      writes_[sent_writes_++ % writes_.size()] = answered;
    } else {
      answered = last_arrived_ = std::max(answered, last_arrived_ + words(length));
    }
    place = answered;
    access.sent = leaves;
    access.answered = std::max(access.answered, answered);
    last_answered_ = std::max(last_answered_, answered);
    address += length;
  }
  return access;
}

}  // namespace sgs
