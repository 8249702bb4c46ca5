#include "testbench/cost/fixed_rate.h"

#include "modules/dram/memspec.h"

namespace sgs {

FixedRate at_rate(double per_s, const FrameResult& frame, const Band& energy_j,
                  const DramConfig& dram, const Technology& technology) {
  FixedRate rate;
  rate.per_s = per_s;
  rate.rest_s = 1 / per_s - frame.time_s();
  rate.held = rate.rest_s >= 0;
  if (!rate.held) return rate;
  constexpr double kNs = 1e-9;
  const Memspec memspec = load_memspec(dram.memspec);
  const Rest rest = rest_of(
      dram, memspec, static_cast<std::uint64_t>(rate.rest_s / (kNs * memspec.clock_period_ns)));
  rate.power_down_s = rest.power_down() * rate.rest_s;
  rate.self_refresh_s = rest.self_refresh() * rate.rest_s;
  rate.rest_j = rest_energy_of(frame, rest, rate.rest_s, technology);
  rate.energy_j = energy_j + rate.rest_j.total;
  rate.memory_interface_w = resting_interface_w(frame, rest, technology);
  rate.memory_interface_counted = technology.memory_interface.counted;
  const std::string& of_frame = frame.memory.energy_not_stated;
  rate.memory_not_stated = of_frame.empty() ? rest.energy.not_stated : of_frame;
  return rate;
}

}  // namespace sgs
