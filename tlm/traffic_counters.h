// Bytes and transactions by requester, region and direction.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace sgs {

struct TrafficCount {
  std::uint64_t transactions = 0;
  std::uint64_t bytes = 0;

  TrafficCount& operator+=(const TrafficCount& other) {
    transactions += other.transactions;
    bytes += other.bytes;
    return *this;
  }
};

enum class Direction : std::uint8_t { kRead = 0, kWrite = 1 };

class TrafficCounters {
 public:
  void add(std::uint8_t requester, std::uint8_t region, Direction direction, std::uint64_t bytes) {
    if (requester >= rows_.size()) rows_.resize(requester + 1u);
    TrafficCount& count = rows_[requester][region][static_cast<std::size_t>(direction)];
    ++count.transactions;
    count.bytes += bytes;
  }

  TrafficCount of(std::uint8_t requester, std::uint8_t region, Direction direction) const;
  TrafficCount total() const;

  // One row for each (requester, region, direction) that saw a transaction, in that order.
  struct Row {
    std::uint8_t requester;
    std::uint8_t region;
    Direction direction;
    TrafficCount count;
  };
  std::vector<Row> rows() const;

 private:
  using Requester = std::array<std::array<TrafficCount, 2>, 256>;  // [region][direction]
  std::vector<Requester> rows_;
};

}  // namespace sgs
