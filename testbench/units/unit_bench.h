// Surroundings of one unit under test: a memory behind a port, FIFOs, stimulus threads, random
// stalls on both sides; at the end it checks that nothing is left over.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <systemc>
#include <vector>

#include "modules/dram/dram_controller.h"
#include "testbench/units/case_runner.h"
#include "testbench/units/fixed_latency_memory.h"
#include "tlm/memory_port.h"
#include "tlm/protocol_checker.h"
#include "tlm/stall_injector.h"
#include "tlm/timed_fifo.h"

namespace sgs::tb {

enum class Memory { kFixedLatency, kDramFast, kDramAccurate };

struct BenchConfig {
  Memory memory = Memory::kFixedLatency;
  std::uint32_t latency_cycles = 20;  // kFixedLatency
  std::size_t memory_bytes = 0;       // kFixedLatency
  double stall_probability = 0;       // at both sides of every FIFO made here
  std::uint32_t longest_stall_cycles = 20;
};

// Memory, its latency and the stalls at random.
BenchConfig random_bench(std::mt19937_64& random, std::size_t memory_bytes);

class UnitBench {
 public:
  UnitBench(Case& test, const BenchConfig& config);
  ~UnitBench();

  const ClockDomain& clock() const { return clock_; }
  Checks& checks() { return test_.checks; }
  MemoryPort& port() { return *port_; }
  void load(std::uint64_t address, const std::vector<std::byte>& bytes);
  std::vector<std::byte> read_back(std::uint64_t address, std::size_t bytes) const;

  // A FIFO of the unit's surroundings; lives as long as the bench.
  template <class T>
  TimedFifo<T>& add_fifo(const std::string& name, std::uint32_t entries,
                         std::uint32_t latency_cycles) {
    auto fifo = std::make_shared<TimedFifo<T>>(name, clock_, entries, latency_cycles);
    fifo->inject(stalls_.get());
    fifos_.push_back({name, fifo, [f = fifo.get()] { return f->empty(); },
                      [f = fifo.get()](sc_core::sc_trace_file* file) { f->trace(file); }});
    return *fifo;
  }

  // A thread of the surroundings; it must have returned by the end.
  void add_thread(const std::string& name, std::function<void(Activity&)> body);

  // Simulates until nothing happens any more; Unit has trace(). Then checks that the threads have
  // returned, FIFOs are empty, memory is idle and its protocol was kept.
  template <class Unit>
  void run(const Unit& unit) {
    simulate([&](sc_core::sc_trace_file* file) { unit.trace(file); });
  }

  // Closes the unit's activities: busy + starved + blocked must be all the time that has passed.
  template <class Activities>
  void check_times(const Activities& activities) {
    for (Activity* activity : activities) {
      activity->close();
      checks().equal(
          activity->busy_cycles() + activity->starved_cycles() + activity->blocked_cycles(),
          clock_.now_cycles(), activity->name() + ": busy + starved + blocked");
    }
  }

 private:
  class Stimulus;
  struct AnyFifo {
    std::string name;
    std::shared_ptr<void> owner;
    std::function<bool()> empty;
    std::function<void(sc_core::sc_trace_file*)> trace;
  };
  void simulate(const std::function<void(sc_core::sc_trace_file*)>& trace_unit);

  Case& test_;
  const ClockDomain clock_{1000};
  std::unique_ptr<StallInjector> stalls_;
  PayloadPool pool_;
  std::unique_ptr<DramController> dram_;
  std::unique_ptr<FixedLatencyMemory> fixed_;
  ProtocolChecker checker_{"checker"};
  std::unique_ptr<MemoryPort> port_;
  std::vector<AnyFifo> fifos_;
  std::vector<std::unique_ptr<Stimulus>> stimuli_;
};

}  // namespace sgs::tb
