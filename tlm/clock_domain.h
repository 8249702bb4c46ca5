// A clock as units use it: whole cycles as delays, without toggling a signal.
#pragma once

#include <cstdint>
#include <systemc>

namespace sgs {

class ClockDomain {
 public:
  explicit ClockDomain(double mhz) : mhz_(mhz), period_(1e3 / mhz, sc_core::SC_NS) {}

  double mhz() const { return mhz_; }

  const sc_core::sc_time& period() const { return period_; }

  // Edges since time 0.
  std::uint64_t now_cycles() const { return sc_core::sc_time_stamp().value() / period_.value(); }

  // Blocks the calling thread for whole cycles.
  void wait_cycles(std::uint64_t cycles) const {
    if (cycles > 0) sc_core::wait(static_cast<double>(cycles) * period_);
  }

  // Blocks until the next edge; at an edge it returns at once. What comes from another clock domain
  // (memory) is taken over here.
  void align() const {
    const std::uint64_t past = sc_core::sc_time_stamp().value() % period_.value();
    if (past != 0) {
      sc_core::wait(sc_core::sc_time::from_value(period_.value() - past));
    }
  }

 private:
  const double mhz_;
  const sc_core::sc_time period_;
};

}  // namespace sgs
