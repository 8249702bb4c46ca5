// Cycles of one hardware activity: it is busy, or it waits for something at a channel or port. All
// together they add up to the time since the start.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <systemc>
#include <vector>

#include "tlm/clock_domain.h"

namespace sgs {

enum class WaitFor : std::uint8_t {
  kIdle,     // nothing to do: before its first item, after its last
  kInput,    // an entry of a FIFO that is empty, or whose oldest entry is still on its way
  kReads,    // answers to reads of its own
  kWrites,   // answers to writes of its own
  kRoom,     // a free entry of a FIFO that is full, or of a buffer whose user gives entries back
  kPort,     // a free transaction of its memory port, or the memory's taking of a request
  kLoading,  // an on-chip memory that is being filled
  kPhase,    // its phase of the frame to begin
};
constexpr std::size_t kWaitForCount = 8;
constexpr std::array<const char*, kWaitForCount> kWaitForNames = {
    "idle", "input", "reads", "writes", "room", "port", "loading", "phase"};

inline const char* name_of(WaitFor what) { return kWaitForNames[static_cast<std::size_t>(what)]; }

// A child of the unit that it belongs to, made while that unit is constructed. It is idle at first.
class Activity : public sc_core::sc_object {
 public:
  static constexpr std::size_t kIdling = 0;  // index in waits()
  static constexpr std::uint32_t kNoVisit = UINT32_MAX;

  // The item that cycles are spent on: a group of pixels or a tile, and maybe a visit of it.
  struct Item {
    const char* what = nullptr;  // "group", "tile"; null before it has taken up the first
    std::uint32_t number = 0, visit = kNoVisit;
    bool operator==(const Item& other) const {
      return what == other.what && number == other.number && visit == other.visit;
    }
    bool operator!=(const Item& other) const { return !(*this == other); }
  };

  // Cycles of waiting for one thing at one place.
  struct Wait {
    WaitFor what = WaitFor::kIdle;
    const sc_core::sc_object* at = nullptr;  // FIFO, port or unit; null with kIdle and kPhase
    std::uint64_t cycles = 0;
  };

  Activity(const char* name, const ClockDomain& clock) : sc_object(name), clock_(clock) {}

  const ClockDomain& clock() const { return clock_; }

  // From now on the activity is busy, waits, or has nothing to do. Called at clock edges, from its
  // own thread.
  void works() { enter(kWorking); }
  void waits_for(WaitFor what, const sc_core::sc_object& at) { enter(place_of(what, &at)); }
  void idles() { enter(kIdling); }
  // Names the item that the activity serves until it takes up another: for timelines; costs no
  // cycle.
  void takes_up_group(std::uint32_t group, std::uint32_t visit = kNoVisit) {
    item_ = {"group", group, visit};
  }
  void takes_up_tile(std::uint32_t tile) { item_ = {"tile", tile, kNoVisit}; }
  // The present wait turns out to be at `at`.
  void waits_at(const sc_core::sc_object& at) { now_ = place_of(waits_[now_].what, &at); }

  // Between these two calls all waiting counts as waiting for the phase. Busy and idle cycles count
  // as they are.
  void leaves_phase() {
    close();
    in_phase_ = false;
    show();
  }
  void enters_phase() {
    close();
    in_phase_ = true;
    show();
  }

  // Busy for so many cycles; then its former state returns.
  void work(std::uint64_t cycles) {
    if (cycles == 0) return;
    const std::size_t before = now_;
    works();
    clock_.wait_cycles(cycles);
    enter(before);
  }

  // Its lanes are busy until that cycle, whatever its thread waits for meanwhile.
  void works_until(std::uint64_t cycle) {
    close();
    works_until_ = cycle;
  }

  // Closes the open interval at the present time; the counters then cover [0, now).
  void close() {
    const std::uint64_t now = clock_.now_cycles();
    if (now > since_) {
      const std::size_t state = seen();
      const std::uint64_t worked_to =
          state == kWorking ? now : std::clamp(works_until_, since_, now);
      busy_cycles_ += worked_to - since_;
      if (now > worked_to) waits_[state].cycles += now - worked_to;
    }
    since_ = now;
  }

  // End of the interval [0, closed_at) that the counters below cover.
  std::uint64_t closed_at() const { return since_; }
  const Item& item() const { return item_; }
  std::uint64_t busy_cycles() const { return busy_cycles_; }
  // Each (what, at) that was ever waited for, in the order in which they first were.
  const std::vector<Wait>& waits() const { return waits_; }
  // Cycles spent waiting for `what`, over all places.
  std::uint64_t waited_for(WaitFor what) const {
    std::uint64_t sum = 0;
    for (const Wait& wait : waits_) sum += wait.what == what ? wait.cycles : 0;
    return sum;
  }
  std::uint64_t waited() const {
    std::uint64_t sum = 0;
    for (const Wait& wait : waits_) sum += wait.cycles;
    return sum;
  }

  // Traces busy, and the WaitFor as a number, for which 0 also stands while it is busy.
  void trace(sc_core::sc_trace_file* file) const override {
    constexpr int kWidth = 3;
    sc_core::sc_trace(file, busy_, std::string(name()) + ".busy");
    sc_core::sc_trace(file, waiting_for_, std::string(name()) + ".waits_for", kWidth);
  }

  const char* kind() const override { return "sgs::Activity"; }

 private:
  static constexpr std::size_t kWorking = ~std::size_t{0};

  void enter(std::size_t state) {
    close();
    now_ = state;
    show();
  }

  // State that cycles are charged to: outside its phase all waiting is for the phase.
  std::size_t seen() {
    if (in_phase_ || now_ == kWorking || now_ == kIdling) return now_;
    return place_of(WaitFor::kPhase, nullptr);
  }

  void show() {
    const std::size_t state = seen();
    busy_ = state == kWorking;
    waiting_for_ = busy_ ? 0 : static_cast<std::uint8_t>(waits_[state].what);
  }

  // Index in waits_: a handful, so that a search beats a table.
  std::size_t place_of(WaitFor what, const sc_core::sc_object* at) {
    for (std::size_t i = 0; i < waits_.size(); ++i) {
      if (waits_[i].what == what && waits_[i].at == at) return i;
    }
    waits_.push_back({what, at, 0});
    return waits_.size() - 1;
  }

  const ClockDomain& clock_;
  std::vector<Wait> waits_{Wait{}};
  std::size_t now_ = kIdling;  // index in waits_, or kWorking
  std::uint64_t since_ = 0, busy_cycles_ = 0;
  std::uint64_t works_until_ = 0;  // whatever it waits for
  Item item_;
  bool in_phase_ = true;
  bool busy_ = false;             // for the waveform
  std::uint8_t waiting_for_ = 0;  // likewise
};

}  // namespace sgs
