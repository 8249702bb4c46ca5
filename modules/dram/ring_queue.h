// First in, first out, in one block of memory that grows by doubling and is never given back.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace sgs {

template <class T>
class RingQueue {
 public:
  bool empty() const { return count_ == 0; }
  std::size_t size() const { return count_; }
  const T& front() const { return items_[first_]; }
  T& front() { return items_[first_]; }

  void push(const T& item) {
    if (count_ == items_.size()) grow();
    items_[(first_ + count_++) & (items_.size() - 1)] = item;
  }
  void pop() {
    first_ = (first_ + 1) & (items_.size() - 1);
    --count_;
  }

 private:
  void grow() {
    std::vector<T> wider(items_.empty() ? 16 : 2 * items_.size());
    for (std::size_t i = 0; i < count_; ++i) wider[i] = items_[(first_ + i) & (items_.size() - 1)];
    items_ = std::move(wider);
    first_ = 0;
  }

  std::vector<T> items_;  // a power of two of them
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace sgs
