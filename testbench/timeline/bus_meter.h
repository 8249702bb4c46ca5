// Bytes on the memory's data buses over time.
#pragma once

#include <cstdint>
#include <vector>

#include "modules/dram/dram_controller.h"

namespace sgs {

// Listens to the commands as long as it lives; a burst counts where its command stands.
class BusMeter : public CommandSink {
 public:
  // step_ns: of time that is added up.
  BusMeter(DramController& memory, double step_ns);
  ~BusMeter() override { memory_.remove_command_sink(*this); }
  BusMeter(const BusMeter&) = delete;
  BusMeter& operator=(const BusMeter&) = delete;

  void on_command(const CommandRecord& record) override;

  // 10^9 B/s in each step up to now.
  std::vector<double> gb_per_s();

 private:
  DramController& memory_;
  const double step_ns_, steps_per_cycle_;
  const std::uint64_t burst_bytes_;
  std::vector<std::uint64_t> bytes_;
};

}  // namespace sgs
