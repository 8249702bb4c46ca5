// A clock as units use it: whole cycles as delays, without toggling a signal.
#pragma once

#include <cstdint>
#include <memory>
#include <systemc>

#include "tlm/delta_jitter.h"

namespace sgs {

class ClockDomain {
 public:
  // jitter_seed: 0 for none.
  explicit ClockDomain(double mhz, std::uint64_t jitter_seed = 0)
      : mhz_(mhz),
        period_(1e3 / mhz, sc_core::SC_NS),
        jitter_(jitter_seed == 0 ? nullptr : std::make_unique<DeltaJitter>(jitter_seed)) {}

  double mhz() const { return mhz_; }

  const sc_core::sc_time& period() const { return period_; }

  // Edges since time 0.
  std::uint64_t now_cycles() const { return sc_core::sc_time_stamp().value() / period_.value(); }

  // Blocks the calling thread for whole cycles.
  void wait_cycles(std::uint64_t cycles) const {
    if (cycles == 0) return;
    sc_core::wait(static_cast<double>(cycles) * period_);
    jitter();
  }

  // Blocks until the next edge; at an edge no time passes. Values from another clock domain
  // (memory) are taken over here.
  void align() const {
    const std::uint64_t past = sc_core::sc_time_stamp().value() % period_.value();
    if (past != 0) {
      sc_core::wait(sc_core::sc_time::from_value(period_.value() - past));
    }
    jitter();
  }

  // Lets other processes of this instant overtake the calling thread, after it has waited for
  // something else. Does nothing where no jitter was asked for.
  void jitter() const {
    if (jitter_) jitter_->wait();
  }

 private:
  const double mhz_;
  const sc_core::sc_time period_;
  const std::unique_ptr<DeltaJitter> jitter_;  // null: none
};

}  // namespace sgs
