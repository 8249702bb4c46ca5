// The memory: a TLM-2.0 target that stores bytes and answers with the timing of DRAM channels.
//
// Time is counted in integer cycles of the DRAM clock; a cycle is the clock period rounded to the
// kernel's resolution (see tlm/time_resolution.h). Bytes move when a request arrives, so that reads
// see every write that arrived before them; timing follows. Nothing happens while nothing is asked:
// refreshes of idle time are caught up with, so a simulation without requests comes to its end.
#pragma once

#include <tlm_utils/multi_passthrough_target_socket.h>
#include <tlm_utils/peq_with_cb_and_phase.h>

#include <cstdint>
#include <deque>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/dram/address_mapping.h"
#include "modules/dram/arrival_order_channel.h"
#include "modules/dram/byte_store.h"
#include "modules/dram/dram_config.h"
#include "modules/dram/dram_energy.h"
#include "modules/dram/dram_stats.h"
#include "modules/dram/memspec.h"
#include "modules/dram/queued_channel.h"
#include "modules/dram/ring_queue.h"
#include "tlm/traffic_counters.h"

namespace sgs {

// Non-blocking transport is served by queues and policies, with back-pressure through END_REQ.
// Blocking transport is served in order of arrival with the delay annotated. One simulation uses
// one of the two; mixing them is reported as an error.
class DramController : public sc_core::sc_module, public CommandSource {
 public:
  tlm_utils::multi_passthrough_target_socket<DramController> socket;

  SC_HAS_PROCESS(DramController);
  // InputError when config is not valid.
  DramController(const sc_core::sc_module_name& name, const DramConfig& config);

  std::uint64_t capacity_bytes() const { return store_.capacity_bytes(); }
  const Memspec& memspec() const { return memspec_; }
  const sc_core::sc_time& clock_period() const { return clock_period_; }
  const DramConfig& config() const { return config_; }

  // Loading and reading back without time; std::out_of_range outside the capacity.
  void load(std::uint64_t address, const void* from, std::size_t bytes);
  void read_back(std::uint64_t address, void* into, std::size_t bytes) const;

  void add_command_sink(CommandSink& sink) override { commands_.add(sink); }
  void remove_command_sink(CommandSink& sink) override { commands_.remove(sink); }
  void catch_up() override;

  // No frame is under way from now on, or one is: idle ranks go where between_frames sends them,
  // and requests that come nevertheless wake them. Of non-blocking transport alone.
  void rest(bool rests);

  // No request waits or is under way, posted writes included.
  bool idle() const;

  // Counts and energy up to now (of a run that is over: up to the last datum); idle time is
  // caught up with first.
  DramStats stats();

  // Adds each channel's row hits, misses and conflicts to a waveform: those of non-blocking
  // requests.
  void trace(sc_core::sc_trace_file* file) const override;

 private:
  enum class Transport { kUnused, kNonBlocking, kBlocking };

  // A transaction from arrival to last datum. It may outlive its payload: posted writes.
  struct Transaction {
    tlm::tlm_generic_payload* payload = nullptr;  // until answered
    int initiator = 0;
    Direction direction = Direction::kRead;
    std::uint8_t region = 0;
    std::uint64_t arrival = 0;    // cycle
    bool urgent = false;          // a read that goes first
    bool masked = false;          // byte enables leave some bytes as they are
    std::uint64_t begin = 0;      // address of its first byte
    std::uint64_t next = 0;       // address from which requests are still to be queued
    std::uint64_t end = 0;        // address after its last byte
    std::uint32_t remaining = 0;  // queued requests without their last datum
    std::uint64_t done = 0;       // cycle of the last datum so far
  };

  struct Initiator {
    Transaction* feeding = nullptr;  // waits for room in a queue; its END_REQ is held back
    std::uint32_t waits_for = 0;     // channel
    bool response_open = false;      // BEGIN_RESP sent, END_RESP not seen
    RingQueue<tlm::tlm_generic_payload*> answers;
  };

  struct Channel {
    QueuedChannel queued;
    ArrivalOrderChannel arrival_order;
    sc_core::sc_event wake;
    std::uint64_t wake_at = kNever;  // cycle of the earliest notification that is pending
    std::uint32_t blocked = 0;       // initiators that wait for room in it
    bool may_have_room = false;      // for these: it has woken at this instant
    Channel(const DramConfig& config, const Memspec& memspec, std::uint8_t index, CommandSink& sink)
        : queued(config, memspec, index, sink), arrival_order(config, memspec, index, sink) {}
  };

  // Receiver of commands: counters, energy, and whoever else listens.
  class Commands : public CommandSink {
   public:
    Commands(const Memspec& memspec, const DramConfig& config);
    void on_command(const CommandRecord& record) override;
    void add(CommandSink& sink) { others_.push_back(&sink); }
    void remove(CommandSink& sink);
    DramStats counts;
    ActivityMeter activity;

   private:
    std::vector<CommandSink*> others_;
  };

  void end_of_elaboration() override;
  tlm::tlm_sync_enum nb_transport_fw(int initiator, tlm::tlm_generic_payload& payload,
                                     tlm::tlm_phase& phase, sc_core::sc_time& delay);
  void b_transport(int initiator, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  unsigned int transport_dbg(int initiator, tlm::tlm_generic_payload& payload);

  bool uses(Transport transport);
  tlm::tlm_sync_enum begin_request(int initiator, tlm::tlm_generic_payload& payload,
                                   tlm::tlm_phase& phase);
  void on_delayed(tlm::tlm_generic_payload& payload, const tlm::tlm_phase& phase);
  ChannelRequest next_request(Transaction& transaction, std::uint32_t& channel) const;
  bool feed(Transaction& transaction, std::uint64_t cycle);
  void on_wake(std::uint32_t channel);
  void retry_all();  // method: the channels that have woken, whichever was first, in their order
  void retry_blocked(std::uint32_t channel, std::uint64_t cycle);
  void schedule(std::uint32_t channel);
  void finish(Transaction& transaction);
  void answer(int initiator, tlm::tlm_generic_payload& payload);
  void send_answers();

  Transaction& new_transaction(int initiator, tlm::tlm_generic_payload& payload,
                               const sc_core::sc_time& arrival);
  std::uint64_t cycle_of(const sc_core::sc_time& time) const;
  std::uint64_t now() const { return cycle_of(sc_core::sc_time_stamp()); }
  std::uint64_t accounted_until() const;
  sc_core::sc_time time_of(std::uint64_t cycle) const;

  const DramConfig config_;
  const Memspec memspec_;
  const AddressMapping mapping_;
  const sc_core::sc_time clock_period_;
  ByteStore store_;
  Commands commands_;
  std::deque<Channel> channels_;  // events do not move
  std::vector<Initiator> initiators_;
  std::size_t next_retry_ = 0;  // initiator that is offered room first
  tlm_utils::peq_with_cb_and_phase<DramController> delayed_;  // requests with an annotated delay
  sc_core::sc_event answers_waiting_, room_;
  std::deque<Transaction> transactions_;  // all ever made
  std::vector<Transaction*> free_transactions_;
  Transport transport_ = Transport::kUnused;
  std::uint64_t open_transactions_ = 0;
  std::uint64_t busy_from_ = 0;  // cycle: since when transactions have been open
  std::uint64_t busy_until_ = 0;
};

}  // namespace sgs
