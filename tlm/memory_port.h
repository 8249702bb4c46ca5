// One initiator of memory traffic, a member of its unit: reads and writes of any length, split into
// transactions, several in flight, finished in any order. Four-phase non-blocking transport; a
// request holds the port until the target's END_REQ (back-pressure).
#pragma once

#include <tlm_utils/peq_with_cb_and_phase.h>
#include <tlm_utils/simple_initiator_socket.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <systemc>
#include <tlm>
#include <tuple>
#include <vector>

#include "tlm/payload_pool.h"
#include "tlm/sram_use.h"

namespace sgs {

// Bytes that the memories behind a port, and its write buffer, take in or give out at once: a
// burst.
constexpr std::uint32_t kPortBytes = 32;

struct MemoryPortConfig {
  std::uint32_t max_transaction_bytes = 256;
  std::uint32_t max_outstanding = 16;
  // Memories with posted writes answer a write when they have taken it: one is answered, one is on
  // its way.
  std::uint32_t max_writes = 2;
  // Wires of some millimetres and multiplexers of all ports and channels take a cycle.
  std::uint32_t path_cycles = 1;
  // Width of the path in each direction: a transaction takes it for as many cycles as it has words.
  // No key: the memories behind a port are as wide.
  std::uint32_t width_bytes = kPortBytes;
  // Its requests are marked as urgent. No key: so is the port of a unit that comes to harm by a
  // late answer.
  bool urgent = false;
};

// Its keys, for a visitor as modules/config has.
template <class Visitor>
void visit(Visitor& v, MemoryPortConfig& c) {
  v("max_transaction_bytes", c.max_transaction_bytes, {32, 4096}, "a port's longest request");
  v("max_outstanding", c.max_outstanding, {1, 4096}, "requests of a port in flight");
  v("max_writes", c.max_writes, {1, 4096},
    "writes of these; the port keeps the bytes of a write until it is answered");
  v("path_cycles", c.path_cycles, {0, 64},
    "registers between port and channels, in each direction; 0: answers come at once, whatever "
    "their width");
}

// Buffer of a port for unanswered writes that are at most so long.
SramUse unanswered_writes(const char* name, const char* memory, const MemoryPortConfig& config,
                          std::uint32_t longest_bytes);

// Table of a port's outstanding transactions: where the bytes of each go on chip, how many they
// are, and whose they are. All ports of a machine use this one name.
constexpr const char* kOutstandingTable = "outstanding transactions";
SramUse outstanding_table(const char* memory, const MemoryPortConfig& config);

// One thread asks; any thread of its unit may wait for what was asked for. (Two that asked at the
// same time would be served in the order in which the kernel runs them.)
class MemoryPort : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(MemoryPort);
  tlm_utils::simple_initiator_socket<MemoryPort> socket;

  // cycle: of the port's clock; 0: any number may leave and arrive at once, without a path, for an
  // initiator that is no hardware. std::invalid_argument when a number of the configuration is 0,
  // but for path_cycles.
  MemoryPort(const sc_core::sc_module_name& name, const MemoryPortConfig& config,
             const sc_core::sc_time& cycle = sc_core::SC_ZERO_TIME);

  using Ticket = std::uint64_t;

  // Starts reading [address, address + bytes) into `into`, which must stay valid until the ticket
  // is done. Splits at multiples of max_transaction_bytes, one a cycle. Blocks the calling thread
  // until the last of them is on its path, while max_outstanding transactions are in flight or the
  // target holds back END_REQ.
  Ticket read(std::uint64_t address, void* into, std::uint32_t bytes, std::uint8_t region);

  // Starts writing; the bytes are copied before it returns. A word of width_bytes leaves a cycle.
  // Blocks as read() does, and while max_writes are unanswered.
  Ticket write(std::uint64_t address, const void* from, std::uint32_t bytes, std::uint8_t region);

  // Charges all later requests to part `part` of the frame, numbered from 0; requests before the
  // first call are charged to none. Costs no time.
  void charge_to(std::size_t part) {
    if (bytes_of_parts_.size() <= part) bytes_of_parts_.resize(part + 1);
    part_ = part;
  }
  // [part] bytes asked for, read and written; as long as the highest part that any was for.
  const std::vector<std::uint64_t>& bytes_of_parts() const { return bytes_of_parts_; }

  bool done(Ticket ticket) const;

  // Block the calling thread until all transactions of the ticket, or of the port, have answered.
  // Cost nothing when that is so already.
  void wait_for(Ticket ticket);
  void wait_before(Ticket ticket);  // for all that were asked for before it
  void wait_all();

  // What is asked for next has this ticket.
  Ticket next() const { return next_; }

  bool idle() const { return outstanding_ == 0; }
  bool writing() const { return writes_outstanding_ > 0; }
  std::uint64_t bytes_outstanding() const { return bytes_outstanding_; }

  std::uint64_t transactions() const { return transactions_; }
  std::uint64_t bytes_read() const { return bytes_read_; }
  std::uint64_t bytes_written() const { return bytes_written_; }
  // Accesses of the buffer that keeps unanswered writes, kPortBytes each.
  std::uint64_t words_written() const { return words_written_; }
  const MemoryPortConfig& config() const { return config_; }

  // Payloads of its transactions; when it is idle, none is in use.
  const PayloadPool& payloads() const { return pool_; }

  // Adds the bytes outstanding to a waveform.
  void trace(sc_core::sc_trace_file* file) const override;

 private:
  struct Slot {
    std::uint32_t remaining = 0;  // transactions not yet sent or not yet answered
    bool waited_for = false;
  };

  Ticket start(tlm::tlm_command command, std::uint64_t address, std::uint8_t* data,
               std::uint32_t bytes, std::uint8_t region);
  Ticket new_ticket(std::uint32_t transactions);
  Slot& slot(Ticket ticket) { return slots_[ticket & (slots_.size() - 1)]; }
  const Slot& slot(Ticket ticket) const { return slots_[ticket & (slots_.size() - 1)]; }

  void send(PooledPayload& payload);
  void launch();  // method: the first request that has come to the end of the path
  void request_taken(const tlm::tlm_generic_payload& payload);
  void arrive(tlm::tlm_generic_payload& payload);
  void take_answers();  // method: those that have come to the end of the path
  void finish(tlm::tlm_generic_payload& payload);
  void on_arrival(tlm::tlm_generic_payload& payload, const tlm::tlm_phase&) { finish(payload); }
  void check_response(const tlm::tlm_generic_payload& payload) const;
  void on_phase(tlm::tlm_generic_payload& payload, const tlm::tlm_phase& phase);
  tlm::tlm_sync_enum nb_transport_bw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                     sc_core::sc_time& delay);

  // A request on the way to the target; due: not earlier at its end.
  struct Leaving {
    PooledPayload* payload;
    sc_core::sc_time due;
  };
  std::uint64_t words(std::uint64_t bytes) const {
    return (bytes + config_.width_bytes - 1) / config_.width_bytes;
  }

  const MemoryPortConfig config_;
  const sc_core::sc_time cycle_;
  sc_core::sc_time next_leaves_;  // not earlier
  PayloadPool pool_;
  std::deque<Leaving> leaving_;
  sc_core::sc_event at_target_;  // for launch()
  // Answers on the way back, by when they end and by ticket and address: answers of one instant
  // come in no order of their own.
  std::map<std::tuple<sc_core::sc_time, Ticket, std::uint64_t>, tlm::tlm_generic_payload*> answers_;
  sc_core::sc_event at_port_;                              // for take_answers()
  sc_core::sc_time last_arrived_;                          // the last word of the answer before
  tlm_utils::peq_with_cb_and_phase<MemoryPort> delayed_;   // answers with an annotated delay
  tlm_utils::peq_with_cb_and_phase<MemoryPort> arriving_;  // answers on the path

  std::vector<Slot> slots_;  // ring over the tickets [oldest_, next_); a power of two
  Ticket oldest_ = 0;        // all before it are done
  Ticket next_ = 0;

  bool has_room(bool for_write) const {
    const std::size_t under_way = leaving_.size() + (request_ != nullptr ? 1 : 0);
    return under_way < std::max(config_.path_cycles, 1U) &&
           outstanding_ < config_.max_outstanding &&
           (!for_write || writes_outstanding_ < config_.max_writes);
  }

  std::uint32_t outstanding_ = 0, writes_outstanding_ = 0;
  std::uint64_t bytes_outstanding_ = 0;
  const tlm::tlm_generic_payload* request_ = nullptr;  // BEGIN_REQ sent, END_REQ not seen
  std::uint32_t waiting_for_room_ = 0;
  bool waiting_for_all_ = false;
  sc_core::sc_event room_;
  sc_core::sc_event answered_;  // a ticket that someone waits for is done
  sc_core::sc_event drained_;

  std::uint64_t transactions_ = 0, bytes_read_ = 0, bytes_written_ = 0, words_written_ = 0;
  std::vector<std::uint64_t> bytes_of_parts_;
  std::optional<std::size_t> part_;  // part that requests are charged to
};

}  // namespace sgs
