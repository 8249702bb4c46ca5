// Which photograph a step looks at.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sgs {

// All of them once each time through, in an order drawn anew each time: it follows from the seed
// and the step.
class ViewOrder {
 public:
  explicit ViewOrder(std::uint64_t seed) : seed_(seed) {}

  // count: of the photographs, the same each time.
  std::size_t at(int step, std::size_t count);

 private:
  std::uint64_t seed_;
  std::vector<std::size_t> order_;
  int order_of_ = -1;  // which time through that is
};

}  // namespace sgs
