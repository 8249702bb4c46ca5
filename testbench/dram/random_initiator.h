// An initiator that does everything the base protocol allows, at random, against a byte mirror.
#pragma once

#include <tlm_utils/simple_initiator_socket.h>

#include <cstdint>
#include <random>
#include <systemc>
#include <tlm>
#include <vector>

#include "tlm/payload_pool.h"

namespace sgs {

// Reads and writes of any length and alignment within its own part of memory, some with byte
// enables, some with an annotated request delay; random pauses between requests and random
// hold-ups of END_RESP. Up to kWindow transactions are in flight.
class RandomInitiator : public sc_core::sc_module {
 public:
  tlm_utils::simple_initiator_socket<RandomInitiator> socket;

  struct Config {
    std::uint64_t begin = 0;
    std::uint32_t bytes = 0;
    std::uint64_t transactions = 0;
    std::uint64_t seed = 1;
  };

  SC_HAS_PROCESS(RandomInitiator);
  RandomInitiator(const sc_core::sc_module_name& name, const Config& config);

  std::uint64_t checks() const { return checks_; }
  std::uint64_t failures() const { return failures_; }
  bool finished() const { return finished_; }
  std::uint64_t bytes_moved() const { return bytes_moved_; }
  const std::vector<std::uint8_t>& mirror() const { return mirror_; }

 private:
  static constexpr std::size_t kWindow = 8;

  // One transaction in flight with what must come back.
  struct Slot {
    PooledPayload* payload = nullptr;
    std::vector<std::uint8_t> data;
    std::vector<std::uint8_t> enables;
    std::vector<std::uint8_t> expected;  // reads
  };

  void run();
  void hold_up_answers();
  void start(Slot& slot);
  void answered(tlm::tlm_generic_payload& payload);
  tlm::tlm_sync_enum nb_transport_bw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                     sc_core::sc_time& delay);
  std::uint32_t below(std::uint32_t n) {
    return std::uniform_int_distribution<std::uint32_t>(0, n - 1)(random_);
  }
  bool all_idle() const;

  const Config config_;
  std::mt19937_64 random_;
  PayloadPool pool_;
  std::vector<std::uint8_t> mirror_;
  std::vector<Slot> slots_;
  const tlm::tlm_generic_payload* requesting_ = nullptr;
  tlm::tlm_generic_payload* held_up_ = nullptr;  // answered, END_RESP still owed
  sc_core::sc_event changed_;
  sc_core::sc_event answer_held_;
  std::uint64_t checks_ = 0;
  std::uint64_t failures_ = 0;
  std::uint64_t bytes_moved_ = 0;
  bool finished_ = false;
};

}  // namespace sgs
