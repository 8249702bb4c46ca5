// A channel that serves requests in the order of their arrival: each reserves its commands on the
// device's tables when it comes. The timing of blocking transport.
//
// Rows are opened ahead of the columns before them, as a queue would. Columns keep to the order of
// arrival: reads and writes are not grouped, hits do not overtake, and a bank conflict delays all
// later requests. Sequential streams take as long as in queues, random ones up to a third longer.
// Rows stay open; refreshes are not postponed. Those that may go to any bank avoid the last one
// read or written.
#pragma once

#include <cstdint>
#include <queue>
#include <vector>

#include "modules/dram/channel_request.h"
#include "modules/dram/command_bus.h"
#include "modules/dram/device_timing.h"
#include "modules/dram/dram_config.h"
#include "modules/dram/path_latency.h"
#include "modules/dram/rank_maintenance.h"
#include "modules/dram/row_counts.h"

namespace sgs {

class ArrivalOrderChannel {
 public:
  ArrivalOrderChannel(const DramConfig& config, const Memspec& memspec, std::uint8_t channel,
                      CommandSink& sink);

  // Serves a request that arrives at `cycle`, not before the last one's. Returns the cycle at which
  // it is answered: its last datum has been transferred, and has come back.
  std::uint64_t serve(const ChannelRequest& request, std::uint64_t cycle);

  // Lets idle time pass up to `cycle` and hands out the commands before it.
  void finish(std::uint64_t cycle);

  const RowCounts& rows() const { return rows_; }

 private:
  void maintain(std::uint64_t cycle);
  void wake(std::uint32_t rank, std::uint64_t cycle);
  void open(const ChannelRequest& request, std::uint64_t cycle);
  std::uint64_t issue(Command command, const ChannelRequest& request, std::uint32_t burst,
                      std::uint64_t earliest);
  std::uint32_t lead_of(Command command) const {
    return shapes_[static_cast<std::size_t>(command)].lead;
  }
  // Returns the command's last cycle, from `last` on.
  std::uint64_t take_command_bus(const CommandShape& shape, std::uint64_t last);
  void hand_out_before(std::uint64_t cycle);

  struct Later {
    bool operator()(const CommandRecord& a, const CommandRecord& b) const {
      return a.cycle > b.cycle;
    }
  };

  const std::uint8_t channel_;
  const PathLatency path_;
  CommandSink& sink_;
  DeviceTiming device_;
  std::vector<RankMaintenance> maintenance_;
  std::vector<RowOutcome> outcome_;  // by rank and bank: of the next column
  const CommandShapes shapes_;
  // Of each command bus a ring: which cycle a slot was last taken for.
  std::vector<std::vector<std::uint64_t>> taken_;
  // Commands of one request lie between those of earlier ones; the sink wants them in order.
  std::priority_queue<CommandRecord, std::vector<CommandRecord>, Later> pending_;
  std::uint64_t last_column_ = 0;
  std::uint64_t maintained_until_ = 0;  // maintenance goes forward in time, requests may go back
  RowCounts rows_;
};

}  // namespace sgs
