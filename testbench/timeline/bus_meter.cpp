#include "testbench/timeline/bus_meter.h"

namespace sgs {

BusMeter::BusMeter(DramController& memory, double step_ns)
    : memory_(memory),
      step_ns_(step_ns),
      steps_per_cycle_(memory.memspec().clock_period_ns / step_ns),
      burst_bytes_(memory.memspec().burst_bytes()) {
  memory.add_command_sink(*this);
}

void BusMeter::on_command(const CommandRecord& record) {
  if (!is_read(record.command) && !is_write(record.command)) return;
  const auto step = static_cast<std::size_t>(static_cast<double>(record.cycle) * steps_per_cycle_);
  if (step >= bytes_.size()) bytes_.resize(step + 1);
  bytes_[step] += burst_bytes_;
}

std::vector<double> BusMeter::gb_per_s() {
  memory_.catch_up();
  std::vector<double> rates;
  for (const std::uint64_t bytes : bytes_) rates.push_back(static_cast<double>(bytes) / step_ns_);
  return rates;
}

}  // namespace sgs
