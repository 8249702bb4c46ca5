// The first of some numbers that change one at a time: compared in a tree, so that a change costs
// no more than its levels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sgs {

class FirstOf {
 public:
  // All are 0.
  explicit FirstOf(std::size_t count) {
    while (width_ < count) width_ *= 2;
    numbers_.assign(width_, ~std::uint64_t{0});
    for (std::size_t i = 0; i < count; ++i) numbers_[i] = 0;
    winners_.resize(2 * width_);
    for (std::size_t i = 0; i < width_; ++i) winners_[width_ + i] = static_cast<std::uint32_t>(i);
    for (std::size_t at = width_ - 1; at > 0; --at) winners_[at] = winner(at);
  }

  void set(std::size_t which, std::uint64_t number) {
    if (numbers_[which] == number) return;
    numbers_[which] = number;
    for (std::size_t at = (width_ + which) / 2; at > 0; at /= 2) {
      const std::uint32_t before = winners_[at];
      winners_[at] = winner(at);
      if (before != which && winners_[at] != which) return;
    }
  }
  // Index of the smallest number; of equal ones the lowest index.
  std::uint32_t first() const { return winners_[1]; }

 private:
  std::uint32_t winner(std::size_t at) const {
    const std::uint32_t left = winners_[2 * at], right = winners_[2 * at + 1];
    return numbers_[right] < numbers_[left] ? right : left;
  }

  std::size_t width_ = 2;
  std::vector<std::uint64_t> numbers_;
  std::vector<std::uint32_t> winners_;  // [2 * width_] the tree from its root, at 1
};

}  // namespace sgs
