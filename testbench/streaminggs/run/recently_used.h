// Values that take much memory and can be made again.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <utility>

namespace sgs {

// Keeps those that were wanted last, as far as they take no more than `most_bytes` together; the
// last one always. size_bytes(Value) is found beside the type.
template <class Value>
class RecentlyUsed {
 public:
  explicit RecentlyUsed(std::uint64_t most_bytes) : most_bytes_(most_bytes) {}

  // The value of this key; make() where it is not here.
  template <class Make>
  std::shared_ptr<const Value> get(const std::string& key, const Make& make) {
    for (auto at = entries_.begin(); at != entries_.end(); ++at) {
      if (at->key != key) continue;
      entries_.splice(entries_.begin(), entries_, at);
      return at->value;
    }
    auto value = std::make_shared<const Value>(make());
    const std::uint64_t bytes = size_bytes(*value);
    entries_.push_front({key, value, bytes});
    bytes_ += bytes;
    while (entries_.size() > 1 && bytes_ > most_bytes_) {
      bytes_ -= entries_.back().bytes;
      entries_.pop_back();
    }
    return value;
  }

 private:
  struct Entry {
    std::string key;
    std::shared_ptr<const Value> value;
    std::uint64_t bytes;
  };
  const std::uint64_t most_bytes_;
  std::uint64_t bytes_ = 0;
  std::list<Entry> entries_;  // the last one wanted first
};

}  // namespace sgs
