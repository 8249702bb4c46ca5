// Surroundings of units under test: a memory behind a router, FIFOs, stimulus threads, random
// stalls on both sides; at the end it checks that nothing is left over.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <systemc>
#include <vector>

#include "modules/dram/dram_controller.h"
#include "modules/streaminggs/unit_context.h"
#include "testbench/units/case_runner.h"
#include "testbench/units/fixed_latency_memory.h"
#include "testbench/units/published.h"
#include "tlm/instant_end.h"
#include "tlm/protocol_checker.h"
#include "tlm/router.h"
#include "tlm/stall_injector.h"
#include "tlm/timed_fifo.h"

namespace sgs::tb {

enum class Memory { kFixedLatency, kDram };

struct BenchConfig {
  Memory memory = Memory::kFixedLatency;
  // kFixedLatency. Writes take longer: a unit that does not wait for them is not saved by the reads
  // that it does wait for.
  std::uint32_t latency_cycles = 20, write_latency_cycles = 150;
  std::size_t memory_bytes = 0;
  // Limits and path of the units' ports. none: without a path and, before a memory of fixed
  // latency, without limits.
  std::optional<MemoryPortConfig> port;
  double stall_probability = 0;  // at both sides of every FIFO made here
  std::uint32_t longest_stall_cycles = 20;
};

// Without stalls, before a memory of fixed latency.
BenchConfig still_bench(std::size_t memory_bytes);

// Memory, its latency and the stalls at random.
BenchConfig random_bench(std::mt19937_64& random, std::size_t memory_bytes);

template <class T>
using Fifos = std::vector<TimedFifo<T>*>;

class UnitBench {
 public:
  UnitBench(Case& test, const BenchConfig& config);
  ~UnitBench();

  const ClockDomain& clock() const { return clock_; }
  InstantEnd& instant_end() { return instant_end_; }
  Checks& checks() { return test_.checks; }
  // FIFOs made here never keep anybody waiting but for room, an entry or their latency.
  bool without_stalls() const { return config_.stall_probability == 0; }

  // For a unit under test; the job must outlive it.
  UnitContext context(const StreamingJob& job) const;

  void load(std::uint64_t address, const std::vector<std::byte>& bytes);
  std::vector<std::byte> read_back(std::uint64_t address, std::size_t bytes) const;

  // A FIFO of the units' surroundings; lives as long as the bench.
  template <class T>
  TimedFifo<T>& add_fifo(const std::string& name, std::uint32_t entries,
                         std::uint32_t latency_cycles) {
    auto fifo = std::make_unique<TimedFifo<T>>(name.c_str(), clock_, entries, latency_cycles);
    TimedFifo<T>& made = *fifo;
    if (stalls_.probability > 0) made.inject(stalls_);
    fifos_.push_back(std::move(fifo));
    return made;
  }
  // `count` of them, called name0, name1, ...
  template <class T>
  Fifos<T> add_fifos(const std::string& name, std::uint32_t count, std::uint32_t entries,
                     std::uint32_t latency_cycles) {
    Fifos<T> made;
    for (std::uint32_t k = 0; k < count; ++k) {
      made.push_back(&add_fifo<T>(fmt::format("{}{}", name, k), entries, latency_cycles));
    }
    return made;
  }

  // A thread of the surroundings; it must have returned by the end.
  void add_thread(const std::string& name, std::function<void(Activity&)> body);

  // A unit under test, its ports bound but for those to the memory.
  template <class Unit>
  void add_unit(Unit& unit) {
    publishers_.push_back([&unit](DataSheet& sheet) { unit.publish(sheet); });
    unit.publish(published_);
  }

  // Connects the memory and simulates until nothing happens any more. Then checks that the threads
  // have returned, FIFOs are empty, ports and memory idle, the protocol was kept, and every cycle
  // of the units' activities is in one of their three accounts.
  void run();

  // Lets the time pass up to the middle of the cycle before `cycle`: what is due at that edge has
  // not happened yet.
  void wait_until_just_before(std::uint64_t cycle) const;

  // Counts of the units' activities, ports and queues.
  std::uint64_t busy_cycles(const std::string& resource) const {
    return published_.busy_cycles(resource);
  }
  std::uint64_t counter(const std::string& name) const;  // as published now
  void check_counter(const std::string& name, std::uint64_t expected);
  double operations(const std::string& component, const std::string& kind) const {
    return publish().operations(component, kind);
  }
  void check_operations(const std::string& component, const std::string& kind,
                        std::uint64_t expected);
  // Reads and writes of one of the unit's uses of on-chip memory.
  std::pair<std::uint64_t, std::uint64_t> accesses(const std::string& use) const {
    return publish().accesses(use);
  }
  void check_accesses(const std::string& use, std::uint64_t reads, std::uint64_t writes);
  std::uint64_t bytes_read() const;
  std::uint64_t bytes_written() const;
  std::uint64_t transactions() const;

 private:
  class Stimulus;
  Published publish() const;
  void make_memory();
  void connect_memory();
  void simulate();
  void check_end();

  Case& test_;
  const ClockDomain clock_{1000};
  const BenchConfig config_;
  StallConfig stalls_;
  InstantEnd instant_end_{"instant_end"};
  std::unique_ptr<DramController> dram_;
  std::unique_ptr<FixedLatencyMemory> fixed_;
  std::unique_ptr<Router> router_;
  std::vector<std::unique_ptr<ProtocolChecker>> checkers_;  // [port]
  std::vector<std::unique_ptr<FifoChannel>> fifos_;
  std::vector<std::unique_ptr<Stimulus>> stimuli_;
  std::vector<std::function<void(DataSheet&)>> publishers_;
  Published published_;
};

}  // namespace sgs::tb
