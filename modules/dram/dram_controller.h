// The memory: a TLM-2.0 target that stores bytes and answers with the timing of DRAM channels.
//
// Time is counted in integer cycles of the DRAM clock; a cycle is the clock period rounded to the
// kernel's resolution (see tlm/time_resolution.h). Bytes move when a request is accepted, so that
// reads see every write accepted before them.
#pragma once

#include <tlm_utils/multi_passthrough_target_socket.h>

#include <cstdint>
#include <memory>
#include <queue>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/dram/address_mapping.h"
#include "modules/dram/arrival_order_channel.h"
#include "modules/dram/byte_store.h"
#include "modules/dram/dram_config.h"
#include "modules/dram/dram_stats.h"
#include "modules/dram/memspec.h"

namespace sgs {

class DramController : public sc_core::sc_module, public CommandSink {
 public:
  tlm_utils::multi_passthrough_target_socket<DramController> socket;

  SC_HAS_PROCESS(DramController);
  // InputError when config is not valid.
  DramController(const sc_core::sc_module_name& name, const DramConfig& config);

  std::uint64_t capacity_bytes() const { return store_.capacity_bytes(); }
  const Memspec& memspec() const { return memspec_; }

  // Loading and reading back without time; std::out_of_range outside the capacity.
  void load(std::uint64_t address, const void* from, std::size_t bytes);
  void read_back(std::uint64_t address, void* into, std::size_t bytes) const;

  // No request waits or is under way.
  bool idle() const { return in_flight_ == 0; }

  // Counts up to now; idle time up to now is accounted for first.
  DramStats stats();

  // For the channels, not for users.
  void on_command(const CommandRecord& record) override;

 private:
  struct Answer {
    sc_core::sc_time at;
    std::uint64_t order;
    int initiator;
    tlm::tlm_generic_payload* payload;
    bool operator<(const Answer& other) const {
      return at != other.at ? at > other.at : order > other.order;
    }
  };

  tlm::tlm_sync_enum nb_transport_fw(int initiator, tlm::tlm_generic_payload& payload,
                                     tlm::tlm_phase& phase, sc_core::sc_time& delay);
  void b_transport(int initiator, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  unsigned int transport_dbg(int initiator, tlm::tlm_generic_payload& payload);
  bool accept(tlm::tlm_generic_payload& payload);
  std::uint64_t serve(const tlm::tlm_generic_payload& payload, std::uint64_t cycle);
  void answer();
  std::uint64_t cycle_of(const sc_core::sc_time& time) const;

  const DramConfig config_;
  const Memspec memspec_;
  const AddressMapping mapping_;
  const sc_core::sc_time clock_period_;
  ByteStore store_;
  std::vector<ArrivalOrderChannel> channels_;
  std::priority_queue<Answer> answers_;
  sc_core::sc_event answer_event_;
  std::uint64_t next_order_ = 0;
  std::uint32_t in_flight_ = 0;
  DramStats stats_;
};

}  // namespace sgs
