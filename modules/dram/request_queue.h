// The requests of one direction that wait in a channel: a list for each bank, oldest first.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "modules/dram/channel_request.h"
#include "modules/dram/command.h"

namespace sgs {

class RequestQueue {
 public:
  static constexpr std::int32_t kNone = -1;

  struct Entry {
    ChannelRequest request;     // `burst` and `bursts` are what is left of it
    std::uint64_t arrival = 0;  // cycle
    std::uint64_t ready = 0;    // cycle from which it may have commands
    std::uint64_t order = 0;    // order of arrival, over both directions of the channel
    bool begun = false;         // had a column command
    std::int32_t next = kNone;  // younger one of the same bank
    std::int32_t previous = kNone;
  };

  // urgent_entries: beside `entries`, of urgent requests alone. `banks`: of all ranks together, at
  // most 64 (the width of the mask).
  RequestQueue(std::uint32_t entries, std::uint32_t urgent_entries, std::uint32_t banks)
      : urgent_entries_(urgent_entries), entries_(entries + urgent_entries), banks_(banks) {
    for (std::size_t i = entries_.size(); i-- > 0;) free_.push_back(static_cast<std::int32_t>(i));
  }

  std::size_t size() const { return entries_.size() - free_.size(); }
  bool empty() const { return size() == 0; }
  bool has_urgent() const { return urgent_ > 0; }
  bool full(const ChannelRequest& request) const {
    const std::size_t free_urgent = urgent_entries_ - urgent_;
    return request.urgent ? free_urgent == 0 : free_.size() == free_urgent;
  }
  std::uint64_t banks_in_use() const { return in_use_; }  // bit b: bank b has requests

  Entry& entry(std::int32_t index) { return entries_[static_cast<std::size_t>(index)]; }
  const Entry& entry(std::int32_t index) const { return entries_[static_cast<std::size_t>(index)]; }
  std::int32_t oldest(std::uint32_t bank) const { return banks_[bank].head; }
  // The oldest request for the bank's open row, kNone without.
  std::int32_t oldest_hit(std::uint32_t bank) const { return banks_[bank].hit; }
  std::int32_t oldest_urgent(std::uint32_t bank) const { return banks_[bank].urgent; }

  // Arrival order of the oldest request of all; the queue is not empty.
  std::uint64_t oldest_order() const;

  // Adds a request of `bank` (counted over ranks), whose open row is given. Not when full for it.
  void push(const Entry& entry, std::uint32_t bank, std::uint32_t open_row);
  void remove(std::int32_t index, std::uint32_t bank);
  void on_row(std::uint32_t bank, std::uint32_t open_row);  // a row was opened, or kNoRow: closed

  // Waiting writes that a read meets: whether one of the bank holds every byte of it, and the order
  // after the last that holds any; 0: none does.
  struct Met {
    bool whole = false;
    std::uint64_t order_end = 0;
  };
  Met met_by(const ChannelRequest& read, std::uint32_t bank) const;

 private:
  struct Bank {
    std::int32_t head = kNone;
    std::int32_t tail = kNone;
    std::int32_t hit = kNone;
    std::int32_t urgent = kNone;
  };

  std::int32_t first_of_row(std::int32_t from, std::uint32_t row) const {
    while (from != kNone && entry(from).request.row != row) from = entry(from).next;
    return from;
  }

  std::int32_t first_urgent(std::int32_t from) const {
    while (from != kNone && !entry(from).request.urgent) from = entry(from).next;
    return from;
  }

  const std::uint32_t urgent_entries_;
  std::uint32_t urgent_ = 0;  // requests
  std::vector<Entry> entries_;
  std::vector<std::int32_t> free_;
  std::vector<Bank> banks_;
  std::uint64_t in_use_ = 0;
};

inline void RequestQueue::push(const Entry& added, std::uint32_t bank, std::uint32_t open_row) {
  const std::int32_t index = free_.back();
  free_.pop_back();
  Bank& b = banks_[bank];
  Entry& e = entry(index);
  e = added;
  e.next = kNone;
  e.previous = b.tail;
  if (b.tail == kNone)
    b.head = index;
  else
    entry(b.tail).next = index;
  b.tail = index;
  if (b.hit == kNone && e.request.row == open_row) b.hit = index;
  if (b.urgent == kNone && e.request.urgent) b.urgent = index;
  urgent_ += e.request.urgent ? 1 : 0;
  in_use_ |= std::uint64_t{1} << bank;
}

inline void RequestQueue::remove(std::int32_t index, std::uint32_t bank) {
  Bank& b = banks_[bank];
  const Entry& e = entry(index);
  if (b.hit == index) b.hit = first_of_row(e.next, e.request.row);
  if (b.urgent == index) b.urgent = first_urgent(e.next);
  urgent_ -= e.request.urgent ? 1 : 0;
  if (e.previous == kNone)
    b.head = e.next;
  else
    entry(e.previous).next = e.next;
  if (e.next == kNone)
    b.tail = e.previous;
  else
    entry(e.next).previous = e.previous;
  if (b.head == kNone) in_use_ &= ~(std::uint64_t{1} << bank);
  free_.push_back(index);
}

inline void RequestQueue::on_row(std::uint32_t bank, std::uint32_t open_row) {
  Bank& b = banks_[bank];
  b.hit = open_row == kNoRow ? kNone : first_of_row(b.head, open_row);
}

inline std::uint64_t RequestQueue::oldest_order() const {
  std::uint64_t oldest = ~std::uint64_t{0};
  for (std::uint64_t left = in_use_; left != 0; left &= left - 1) {
    const Bank& bank = banks_[static_cast<std::size_t>(__builtin_ctzll(left))];
    oldest = std::min(oldest, entry(bank.head).order);
  }
  return oldest;
}

inline RequestQueue::Met RequestQueue::met_by(const ChannelRequest& read,
                                              std::uint32_t bank) const {
  Met met;
  for (std::int32_t i = banks_[bank].head; i != kNone; i = entry(i).next) {
    const ChannelRequest& r = entry(i).request;
    const std::uint32_t end = r.burst + r.bursts, read_end = read.burst + read.bursts;
    if (r.row != read.row || end <= read.burst || read_end <= r.burst) continue;
    met.order_end = entry(i).order + 1;
    // A later write to some of it is newer than what this one holds.
    met.whole = !r.masked && r.burst <= read.burst && read_end <= end;
  }
  return met;
}

}  // namespace sgs
