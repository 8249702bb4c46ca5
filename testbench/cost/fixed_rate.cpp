#include "testbench/cost/fixed_rate.h"

#include <algorithm>

#include "modules/dram/memspec.h"

namespace sgs {
namespace {

std::uint64_t cycles_in(const Memspec& memspec, double seconds) {
  constexpr double kNs = 1e-9;
  return static_cast<std::uint64_t>(seconds / (kNs * memspec.clock_period_ns));
}

// Each refresh is simulated; of a longer rest as much as has thousands of them, and scaled.
double most_pj_of_power_down(DramConfig dram, const Memspec& memspec, std::uint64_t cycles) {
  constexpr std::uint64_t kMostCycles = 100'000'000;
  dram.between_frames = BetweenFrames::kPowerDown;
  const std::uint64_t simulated = std::min(cycles, kMostCycles);
  const double pj = rest_of(dram, memspec, simulated).energy.most_pj;
  return simulated == cycles ? pj
                             : pj * static_cast<double>(cycles) / static_cast<double>(simulated);
}

Rest rest_up_to_power_down(const DramConfig& dram, double seconds) {
  const Memspec memspec = load_memspec(dram.memspec);
  const std::uint64_t cycles = cycles_in(memspec, seconds);
  Rest rest = rest_of(dram, memspec, cycles);
  rest.energy.most_pj = std::max(rest.energy.most_pj, most_pj_of_power_down(dram, memspec, cycles));
  return rest;
}

}  // namespace

double power_down_j(const DramConfig& dram, double seconds) {
  const Memspec memspec = load_memspec(dram.memspec);
  const std::uint64_t cycles = cycles_in(memspec, seconds);
  DramConfig refreshing = dram;
  refreshing.between_frames = BetweenFrames::kSelfRefresh;
  constexpr double kJ = 1e-12;  // in a pJ
  return kJ * std::max(0.0, most_pj_of_power_down(dram, memspec, cycles) -
                                rest_of(refreshing, memspec, cycles).energy.most_pj);
}

FixedRate at_rate(double per_s, const FrameResult& frame, const DramConfig& dram,
                  const Technology& technology) {
  FixedRate rate;
  rate.per_s = per_s;
  rate.rest_s = 1 / per_s - frame.time_s();
  rate.held = rate.rest_s >= 0;
  if (!rate.held) return rate;
  const Rest rest = rest_up_to_power_down(dram, rate.rest_s);
  rate.power_down_s = rest.power_down() * rate.rest_s;
  rate.self_refresh_s = rest.self_refresh() * rate.rest_s;
  rate.rest_j = rest_energy_of(frame, rest, rate.rest_s, technology);
  rate.totals_j =
      energy_totals(frame, technology) + rest_energy_totals(frame, rest, rate.rest_s, technology);
  rate.energy_j = technology.memory_interface.counted ? rate.totals_j.with_memory_interface
                                                      : rate.totals_j.without_memory_interface;
  rate.memory_interface_w = resting_interface_w(frame, rest, technology);
  const std::string& of_frame = frame.memory.energy_not_stated;
  rate.memory_not_stated = of_frame.empty() ? rest.energy.not_stated : of_frame;
  return rate;
}

}  // namespace sgs
