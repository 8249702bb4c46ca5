// A bounded FIFO between two hardware activities: an entry can be taken `latency` cycles after it
// was put in, and a full FIFO holds its writer back.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <systemc>
#include <type_traits>
#include <utility>
#include <vector>

#include "tlm/fifo_if.h"
#include "tlm/sram_use.h"
#include "tlm/stall_injector.h"

namespace sgs {

// SRAM that one entry takes: what hardware keeps of a T, which T says (T::kSramBytes). 0 where it
// says nothing: its bytes lie elsewhere, and the entry stands for them.
template <class T, class = void>
struct EntryBytes : std::integral_constant<std::uint32_t, 0> {};
template <class T>
struct EntryBytes<T, std::void_t<decltype(T::kSramBytes)>>
    : std::integral_constant<std::uint32_t, T::kSramBytes> {};

// SRAM of a FIFO of so many entries. entry_bytes: where a configuration keeps more of an entry than
// T says.
template <class T>
SramUse fifo_use(const char* name, const char* memory, std::uint32_t entries,
                 const char* what_they_are, std::uint32_t entry_bytes = EntryBytes<T>::value) {
  static_assert(EntryBytes<T>::value > 0, "T::kSramBytes says what hardware keeps of an entry");
  return sram_use(name, memory, {{entries, what_they_are}, {entry_bytes, "B"}}, {8 * entry_bytes},
                  kOneOfEach);
}

// The part of a FIFO that does not depend on the type of its entries.
class FifoChannel : public sc_core::sc_prim_channel {
 public:
  std::uint32_t fill() const { return fill_; }
  std::uint64_t pushed() const { return pushed_; }  // entries so far
  std::uint64_t popped() const { return pushed_ - fill_; }
  // Most of them within one cycle.
  std::uint32_t most_pushed() const { return pushes_.most; }
  std::uint32_t most_popped() const { return pops_.most; }
  virtual std::uint32_t capacity() const = 0;
  virtual std::uint32_t entry_bytes() const = 0;  // as EntryBytes

  // Random stalls on both sides from now on. Each side draws from a sequence of its own, so that
  // they do not depend on which of two sides the kernel runs first.
  void inject(const StallConfig& stalls) {
    writer_stalls_.emplace(stalls, std::string(name()) + ".writer");
    reader_stalls_.emplace(stalls, std::string(name()) + ".reader");
  }

  // Who puts entries in and who takes them out; null before the first did.
  const Activity* writer() const { return writer_; }
  const Activity* reader() const { return reader_; }
  // Names the writer that stands for all where several put entries in: which was the last depends
  // on the kernel.
  void name_writer(const Activity& writer) { writer_ = &writer; }

  void trace(sc_core::sc_trace_file* file) const override {
    sc_core::sc_trace(file, fill_, std::string(name()) + ".fill");
  }
  const char* kind() const override { return "sgs::TimedFifo"; }

 protected:
  explicit FifoChannel(const char* name) : sc_prim_channel(name) {}

  // Number of events at the same time.
  struct AtOnce {
    sc_core::sc_time at;
    std::uint32_t now = 0, most = 0;
    void count() {
      const sc_core::sc_time& time = sc_core::sc_time_stamp();
      now = time == at ? now + 1 : 1;
      at = time;
      if (now > most) most = now;
    }
  };

  std::uint32_t fill_ = 0;
  const Activity *writer_ = nullptr, *reader_ = nullptr;
  std::uint64_t pushed_ = 0;
  AtOnce pushes_, pops_;
  std::optional<StallInjector> writer_stalls_, reader_stalls_;
};

// One writer thread, one reader thread; several writers only where there is always room, since each
// gives back an entry that was taken out. The waiting times are charged to the Activity that waits:
// the writer for room, the reader for input.
template <class T>
class TimedFifo : public FifoChannel, public FifoReadIf<T>, public FifoWriteIf<T> {
 public:
  // capacity: entries, at least 1.
  TimedFifo(const char* name, const ClockDomain& clock, std::uint32_t capacity,
            std::uint32_t latency_cycles = 1)
      : FifoChannel(name),
        clock_(clock),
        latency_(static_cast<double>(latency_cycles) * clock.period()),
        entries_(capacity) {}

  void push(T value, Activity& writer) override {
    clock_.jitter();
    writer_ = &writer;
    stall(writer_stalls_, writer, WaitFor::kRoom);
    if (fill_ == entries_.size()) {
      writer.waits_for(WaitFor::kRoom, *this);
      writer_waits_ = true;
      while (fill_ == entries_.size()) sc_core::wait(room_);
      writer_waits_ = false;
      clock_.jitter();
      writer.works();
    }
    Entry& entry = entries_[wrapped(head_ + fill_)];
    entry.value = std::move(value);
    entry.ready = sc_core::sc_time_stamp() + latency_;
    ++fill_;
    ++pushed_;
    pushes_.count();
    if (reader_waits_) filled_.notify(sc_core::SC_ZERO_TIME);
    if (listener_ != nullptr) listener_->notify(sc_core::SC_ZERO_TIME);
  }

  std::uint32_t room() const override { return capacity() - fill_; }
  void wait_for_room(std::uint32_t entries, std::uint64_t until, Activity& writer) override {
    const auto wanted = [&] { return room() < entries && clock_.now_cycles() < until; };
    if (!wanted()) return;
    writer_ = &writer;
    writer.waits_for(WaitFor::kRoom, *this);
    writer_waits_ = true;
    while (wanted()) {
      if (until == FifoWriteIf<T>::kNever) {
        sc_core::wait(room_);
      } else {
        sc_core::wait(static_cast<double>(until - clock_.now_cycles()) * clock_.period(), room_);
      }
    }
    writer_waits_ = false;
    clock_.jitter();
    writer.works();
  }

  using FifoReadIf<T>::pop;
  T pop(Activity& reader, WaitFor what) override {
    wait_for_front(reader, what);
    T value = std::move(entries_[head_].value);
    remove_front();
    return value;
  }

  // Blocks as pop() does, for a reader that leaves the oldest entry where it is until its turn. The
  // entry stays, and is valid, until remove_front().
  const T& front(Activity& reader) {
    wait_for_front(reader, WaitFor::kInput);
    return entries_[head_].value;
  }
  void remove_front() {
    head_ = wrapped(head_ + 1);
    --fill_;
    pops_.count();
    if (writer_waits_) room_.notify(sc_core::SC_ZERO_TIME);
  }

  bool can_pop() const override {
    return fill_ > 0 && entries_[head_].ready <= sc_core::sc_time_stamp();
  }
  bool empty() const override { return fill_ == 0; }
  const sc_core::sc_time& ready_at() const override { return entries_[head_].ready; }
  void announce_to(sc_core::sc_event& event) override { listener_ = &event; }
  const sc_core::sc_object& place() const override { return *this; }
  std::uint32_t capacity() const override { return static_cast<std::uint32_t>(entries_.size()); }
  std::uint32_t entry_bytes() const override { return EntryBytes<T>::value; }

 private:
  struct Entry {
    T value{};
    sc_core::sc_time ready;
  };

  void wait_for_front(Activity& reader, WaitFor what) {
    clock_.jitter();
    reader_ = &reader;
    stall(reader_stalls_, reader, what);
    if (can_pop()) return;
    reader.waits_for(what, *this);
    reader_waits_ = true;
    while (fill_ == 0) sc_core::wait(filled_);
    reader_waits_ = false;
    const sc_core::sc_time& ready = entries_[head_].ready;
    if (ready > sc_core::sc_time_stamp()) sc_core::wait(ready - sc_core::sc_time_stamp());
    clock_.jitter();
    reader.works();
  }

  std::uint32_t wrapped(std::uint32_t at) const {
    return at < entries_.size() ? at : at - static_cast<std::uint32_t>(entries_.size());
  }

  void stall(std::optional<StallInjector>& stalls, Activity& side, WaitFor what) {
    if (!stalls) return;
    if (const std::uint32_t cycles = stalls->draw(); cycles > 0) {
      side.waits_for(what, *this);
      clock_.wait_cycles(cycles);
      side.works();
    }
  }

  const ClockDomain& clock_;
  const sc_core::sc_time latency_;
  std::vector<Entry> entries_;  // ring
  std::uint32_t head_ = 0;
  bool writer_waits_ = false, reader_waits_ = false;
  sc_core::sc_event* listener_ = nullptr;
  sc_core::sc_event room_, filled_;
};

}  // namespace sgs
