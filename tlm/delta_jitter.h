// Random delta cycles for tests: in which order the processes of an instant act.
#pragma once

#include <cstdint>
#include <random>
#include <systemc>

namespace sgs {

// A process that is woken lets a few delta cycles pass before it goes on: others of the same
// instant overtake it. No simulated time passes, so no result may change.
class DeltaJitter {
 public:
  explicit DeltaJitter(std::uint64_t seed) : random_(seed) {}

  void wait() {
    constexpr std::uint64_t kMost = 3;
    for (std::uint64_t left = random_() % (kMost + 1); left > 0; --left) {
      sc_core::wait(sc_core::SC_ZERO_TIME);
    }
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace sgs
