// The gain of a frame from twice as much of one resource, one after the other. Values that cost
// cycles are halved instead.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "testbench/cost/cost.h"
#include "testbench/result/frame_result.h"
#include "testbench/streaminggs/report/binding.h"

namespace sgs {

// A frame's time and price.
struct Outcome {
  std::uint64_t cycles = 0, bus_bytes = 0;
  double joules = 0, mm2 = 0;
  double mm2_with_memory_interface = 0;  // with PHY and controller of the memory's channels
  std::string memory_not_stated;         // as MemoryResult has it
  Binding binding;
};

struct Doubling {
  Doubling(const Remedy& remedy, double value);

  std::string key;
  double from = 0, to = 0;  // twice, or half where the remedy turns down
  std::string refused;      // why it cannot be; empty: it was simulated
  Outcome outcome;
};

// The remedies that the machine's data sheets and the memory name, each key once, in their order.
std::vector<Remedy> remedies_of(const FrameResult& frame);

// Shares of the base's time and energy that are saved; negative: it takes more.
double time_saved(const Outcome& base, const Outcome& doubled);
double energy_saved(const Outcome& base, const Outcome& doubled);

// "-11.4 %" of what 0.114 is saved of, "0.0 %" of what stays.
std::string change_in_words(double saved);

// Whether it is below the noise of a frame. In as many cycles, energy has none.
bool time_is_noise(const Outcome& base, const Outcome& doubled);
bool energy_is_noise(const Outcome& base, const Outcome& doubled);

// A gain over the area that it takes says something of more than this share of the base's.
constexpr double kLeastAddedArea = 0.005;

// "-1.3 %" of what is saved with each mm2 that is added, PHY and controller included; "-" below
// kLeastAddedArea.
std::string saved_per_mm2(const Outcome& base, const Outcome& doubled, double saved);

// "; time and energy below the noise of a frame": what of them is; empty where neither is.
std::string noise_in_words(const Outcome& base, const Outcome& doubled);

// Most time saved first, the cheaper of equals; what was refused comes last.
void rank(const Outcome& base, std::vector<Doubling>& doublings);

// True if no other doubling gains more than the one that the base's binding names, but for the
// noise of a frame.
bool named_gains_most(const Outcome& base, const std::vector<Doubling>& doublings);

// Says, with the numbers, whether the base's bottleneck (its binding's resource) is the one that
// gains most. Where it is not, says what holds the frame once it is doubled. doublings: ranked.
std::string verdict(const Outcome& base, const std::vector<Doubling>& doublings);

}  // namespace sgs
