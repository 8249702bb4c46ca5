// Random stalls for tests: what comes out must not depend on when.
#pragma once

#include <cstdint>
#include <random>

namespace sgs {

class StallInjector {
 public:
  // Each draw stalls with the given probability, for 1 to max_cycles cycles.
  StallInjector(std::uint64_t seed, double probability, std::uint32_t max_cycles)
      : random_(seed),
        threshold_(static_cast<std::uint64_t>(probability * 4294967296.0)),
        max_cycles_(max_cycles) {}

  // Cycles to stall now; mostly 0.
  std::uint32_t draw() {
    const std::uint64_t bits = random_();
    if ((bits & 0xffffffffU) >= threshold_) return 0;
    return 1 + static_cast<std::uint32_t>((bits >> 32U) % max_cycles_);
  }

 private:
  std::mt19937_64 random_;
  std::uint64_t threshold_;
  std::uint32_t max_cycles_;
};

}  // namespace sgs
