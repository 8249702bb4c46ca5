// A bounded FIFO between two hardware activities: an entry can be taken `latency` cycles after it
// was put in, and a full FIFO holds its writer back.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <systemc>
#include <utility>
#include <vector>

#include "tlm/activity.h"
#include "tlm/stall_injector.h"

namespace sgs {

// One writer thread, one reader thread. The waiting times are charged to the Activity that waits:
// blocked for the writer, starved for the reader.
template <class T>
class TimedFifo {
 public:
  // capacity: entries, at least 1.
  TimedFifo(std::string name, const ClockDomain& clock, std::uint32_t capacity,
            std::uint32_t latency_cycles = 1)
      : name_(std::move(name)),
        clock_(clock),
        latency_(static_cast<double>(latency_cycles) * clock.period()),
        entries_(capacity) {}

  TimedFifo(const TimedFifo&) = delete;
  TimedFifo& operator=(const TimedFifo&) = delete;

  // Lets random stalls happen on both sides from now on.
  void inject(StallInjector* stalls) { stalls_ = stalls; }

  // Puts an entry in; blocks the calling thread while the FIFO is full.
  void push(T value, Activity& writer) {
    stall(writer, ActivityState::kBlocked);
    if (fill_ == entries_.size()) {
      writer.enter(ActivityState::kBlocked);
      writer_waits_ = true;
      while (fill_ == entries_.size()) sc_core::wait(room_);
      writer_waits_ = false;
      writer.enter(ActivityState::kBusy);
    }
    Entry& entry = entries_[wrapped(head_ + fill_)];
    entry.value = std::move(value);
    entry.ready = sc_core::sc_time_stamp() + latency_;
    ++fill_;
    max_fill_ = std::max(max_fill_, fill_);
    ++pushed_;
    if (reader_waits_) filled_.notify(sc_core::SC_ZERO_TIME);
    if (listener_ != nullptr) listener_->notify(sc_core::SC_ZERO_TIME);
  }

  // Takes the oldest entry; blocks the calling thread until there is one and it is ready. A reader
  // that waits for a credit to come back, not for input, passes kBlocked.
  T pop(Activity& reader, ActivityState waiting = ActivityState::kStarved) {
    stall(reader, waiting);
    if (!can_pop()) {
      reader.enter(waiting);
      reader_waits_ = true;
      while (fill_ == 0) sc_core::wait(filled_);
      reader_waits_ = false;
      const sc_core::sc_time& ready = entries_[head_].ready;
      if (ready > sc_core::sc_time_stamp()) sc_core::wait(ready - sc_core::sc_time_stamp());
      reader.enter(ActivityState::kBusy);
    }
    T value = std::move(entries_[head_].value);
    head_ = wrapped(head_ + 1);
    --fill_;
    if (writer_waits_) room_.notify(sc_core::SC_ZERO_TIME);
    return value;
  }

  // Whether pop() would return at once.
  bool can_pop() const { return fill_ > 0 && entries_[head_].ready <= sc_core::sc_time_stamp(); }
  bool empty() const { return fill_ == 0; }
  // When the oldest entry can be taken; only for a FIFO that is not empty.
  const sc_core::sc_time& ready_at() const { return entries_[head_].ready; }
  // Also notifies `event` of every entry put in: for a reader of several FIFOs.
  void announce_to(sc_core::sc_event* event) { listener_ = event; }

  const std::string& name() const { return name_; }
  std::uint32_t fill() const { return fill_; }
  std::uint32_t max_fill() const { return max_fill_; }
  std::uint32_t capacity() const { return static_cast<std::uint32_t>(entries_.size()); }
  std::uint64_t pushed() const { return pushed_; }

  void trace(sc_core::sc_trace_file* file) const {
    sc_core::sc_trace(file, fill_, name_ + ".fill");
  }

 private:
  struct Entry {
    T value{};
    sc_core::sc_time ready;
  };

  std::uint32_t wrapped(std::uint32_t at) const {
    return at < entries_.size() ? at : at - static_cast<std::uint32_t>(entries_.size());
  }

  void stall(Activity& side, ActivityState state) {
    if (stalls_ == nullptr) return;
    if (const std::uint32_t cycles = stalls_->draw(); cycles > 0) {
      side.enter(state);
      clock_.wait_cycles(cycles);
      side.enter(ActivityState::kBusy);
    }
  }

  const std::string name_;
  const ClockDomain& clock_;
  const sc_core::sc_time latency_;
  std::vector<Entry> entries_;  // ring
  std::uint32_t head_ = 0, fill_ = 0, max_fill_ = 0;
  std::uint64_t pushed_ = 0;
  bool writer_waits_ = false, reader_waits_ = false;
  StallInjector* stalls_ = nullptr;
  sc_core::sc_event* listener_ = nullptr;
  sc_core::sc_event room_, filled_;
};

}  // namespace sgs
