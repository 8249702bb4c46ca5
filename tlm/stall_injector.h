// Random stalls for tests: results must not depend on when they occur.
#pragma once

#include <cstdint>
#include <random>
#include <string>

namespace sgs {

struct StallConfig {
  double probability = 0;  // chance of a stall at each draw
  std::uint32_t longest_cycles = 20;
  std::uint64_t seed = 1;
};

class StallInjector {
 public:
  // Each draw stalls with the given probability, for 1 to longest_cycles cycles. place: names the
  // sequence, another one for each place where stalls happen.
  StallInjector(const StallConfig& config, const std::string& place)
      : random_(config.seed ^ hash(place)),
        threshold_(static_cast<std::uint64_t>(config.probability * 4294967296.0)),
        longest_cycles_(config.longest_cycles) {}

  // Cycles to stall now; mostly 0.
  std::uint32_t draw() {
    const std::uint64_t bits = random_();
    if ((bits & 0xffffffffU) >= threshold_) return 0;
    return 1 + static_cast<std::uint32_t>((bits >> 32U) % longest_cycles_);
  }

 private:
  // FNV-1a: the same on every machine.
  static std::uint64_t hash(const std::string& text) {
    std::uint64_t h = 0xcbf29ce484222325U;
    for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
    return h;
  }

  std::mt19937_64 random_;
  std::uint64_t threshold_;
  std::uint32_t longest_cycles_;
};

}  // namespace sgs
