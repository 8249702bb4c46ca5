// The memory without its commands: each transaction takes its bursts of the channel's data bus in a
// window of time (tlm/booked_time.h), behind the latency of the row that it finds. Rows are found
// in the order in which the transactions are asked for, which is nearly that of a run.
// Not in it: what ranks and turn-arounds of the bus hold back beside that latency, the order
// in which a scheduler takes what waits, full queues, power-down and self-refresh.
#pragma once

#include <cstdint>
#include <vector>

#include "modules/dram/address_mapping.h"
#include "modules/dram/device_timing.h"
#include "modules/dram/dram_config.h"
#include "modules/dram/dram_stats.h"
#include "modules/dram/memspec.h"
#include "modules/dram/path_latency.h"
#include "tlm/booked_time.h"
#include "tlm/memory_estimate.h"

namespace sgs {

class DramEstimate : public MemoryEstimate {
 public:
  // machine_mhz: of the clock whose cycles are told. Throws InputError when config is not valid.
  DramEstimate(const DramConfig& config, double machine_mhz);

  std::uint64_t answered(std::uint64_t cycle, const Transaction& transaction) override;

  // Cycles of the machine's clock that the busiest channel's bus takes for all of it.
  std::uint64_t least_cycles() const;

  // Of a frame that ended in this cycle of the machine's clock.
  DramStats stats(std::uint64_t cycle) const;

 private:
  struct Bank {
    std::uint32_t open_row = kNoRow;
    std::uint64_t refreshes = 0;  // that it had had when it was last looked at
    std::uint64_t activated = 0;
  };
  std::uint64_t dram_cycle(std::uint64_t cycle) const;
  RowOutcome find_row(const DramAddress& place, std::uint64_t now);
  std::uint64_t column_from(const DramAddress& place, RowOutcome outcome, std::uint64_t now);
  Bank& bank_of(const DramAddress& place) {
    return banks_[rank_of(place) * memspec_.organisation.banks + place.bank];
  }
  std::uint64_t rank_of(const DramAddress& place) const {
    return std::uint64_t{place.channel} * config_.ranks + place.rank;
  }
  std::uint64_t refresh_cycles() const;  // from one of a bank to its next; 0: none

  const DramConfig config_;
  const Memspec memspec_;
  const AddressMapping mapping_;
  const PathLatency path_;
  const DerivedTiming derived_;
  const double dram_cycles_;       // of a machine's
  std::vector<BookedTime> buses_;  // [channel]
  std::vector<Bank> banks_;        // [channel, rank, bank]
  DramStats counts_;
  std::array<RegionActivity, 256> regions_{};
};

}  // namespace sgs
