// Bytes and transactions by requester, region and direction.
#include "tlm/traffic_counters.h"

namespace sgs {

TrafficCount TrafficCounters::of(std::uint8_t requester, std::uint8_t region,
                                 Direction direction) const {
  if (requester >= rows_.size()) return {};
  return rows_[requester][region][static_cast<std::size_t>(direction)];
}

TrafficCount TrafficCounters::total() const {
  TrafficCount sum;
  for (const Row& row : rows()) sum += row.count;
  return sum;
}

std::vector<TrafficCounters::Row> TrafficCounters::rows() const {
  std::vector<Row> seen;
  for (std::size_t requester = 0; requester < rows_.size(); ++requester)
    for (std::size_t region = 0; region < rows_[requester].size(); ++region)
      for (const Direction direction : {Direction::kRead, Direction::kWrite}) {
        const TrafficCount count = rows_[requester][region][static_cast<std::size_t>(direction)];
        if (count.transactions > 0)
          seen.push_back({static_cast<std::uint8_t>(requester), static_cast<std::uint8_t>(region),
                          direction, count});
      }
  return seen;
}

}  // namespace sgs
