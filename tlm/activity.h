// Where the cycles of one hardware activity go: busy, starved (no input) or blocked (no room
// downstream). The three add up to the time since the start.
#pragma once

#include <cstdint>
#include <string>
#include <systemc>

#include "tlm/clock_domain.h"

namespace sgs {

enum class ActivityState : std::uint8_t { kBusy, kStarved, kBlocked };

// A child of the unit that it belongs to, made while that unit is constructed.
class Activity : public sc_core::sc_object {
 public:
  Activity(const char* name, const ClockDomain& clock) : sc_object(name), clock_(clock) {}

  const ClockDomain& clock() const { return clock_; }

  // From now on the activity is in `state`. Called at clock edges, from its own thread.
  void enter(ActivityState state) {
    close();
    state_ = state;
    busy_ = state == ActivityState::kBusy;
    starved_ = state == ActivityState::kStarved;
    blocked_ = state == ActivityState::kBlocked;
  }

  // Works for so many cycles; the state before is taken up again.
  void work(std::uint64_t cycles) {
    if (cycles == 0) return;
    const ActivityState before = state_;
    enter(ActivityState::kBusy);
    clock_.wait_cycles(cycles);
    enter(before);
  }

  // Closes the open interval at the present time; the counters then cover [0, now).
  void close() {
    const std::uint64_t now = clock_.now_cycles();
    cycles_[static_cast<int>(state_)] += now - since_;
    since_ = now;
  }

  std::uint64_t busy_cycles() const { return cycles_[0]; }
  std::uint64_t starved_cycles() const { return cycles_[1]; }
  std::uint64_t blocked_cycles() const { return cycles_[2]; }

  void trace(sc_core::sc_trace_file* file) const override {
    sc_core::sc_trace(file, busy_, std::string(name()) + ".busy");
    sc_core::sc_trace(file, starved_, std::string(name()) + ".starved");
    sc_core::sc_trace(file, blocked_, std::string(name()) + ".blocked");
  }

  const char* kind() const override { return "sgs::Activity"; }

 private:
  const ClockDomain& clock_;
  ActivityState state_ = ActivityState::kStarved;
  bool busy_ = false, starved_ = true, blocked_ = false;
  std::uint64_t since_ = 0;
  std::uint64_t cycles_[3] = {0, 0, 0};
};

}  // namespace sgs
