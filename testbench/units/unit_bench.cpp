// Memory, stimulus threads and the checks at the end.
#include "testbench/units/unit_bench.h"

#include <cstring>

namespace sgs::tb {

class UnitBench::Stimulus : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Stimulus);
  Stimulus(const sc_core::sc_module_name& name, const ClockDomain& clock,
           std::function<void(Activity&)> body)
      : sc_module(name), activity_(this->name(), clock), body_(std::move(body)) {
    SC_THREAD(run);
  }
  bool returned() const { return returned_; }

 private:
  void run() {
    body_(activity_);
    returned_ = true;
  }
  Activity activity_;
  std::function<void(Activity&)> body_;
  bool returned_ = false;
};

BenchConfig random_bench(std::mt19937_64& random, std::size_t memory_bytes) {
  BenchConfig config;
  config.memory = static_cast<Memory>(random() % 3);
  config.latency_cycles = static_cast<std::uint32_t>(random() % 100);
  config.memory_bytes = memory_bytes;
  constexpr double kProbabilities[] = {0, 0.02, 0.3};
  config.stall_probability = kProbabilities[random() % 3];
  config.longest_stall_cycles = random() % 2 == 0 ? 5 : 200;
  return config;
}

UnitBench::UnitBench(Case& test, const BenchConfig& config) : test_(test) {
  if (config.stall_probability > 0) {
    stalls_ = std::make_unique<StallInjector>(test.random(), config.stall_probability,
                                              config.longest_stall_cycles);
  }
  const bool accurate = config.memory == Memory::kDramAccurate;
  // Where times are computed to the cycle the port must not hold anything back.
  const std::uint32_t outstanding = config.memory == Memory::kFixedLatency ? 4096 : 16;
  const MemoryPort::Config port{0, 256, outstanding,
                                accurate ? TimingMode::kAccurate : TimingMode::kFast};
  port_ = std::make_unique<MemoryPort>("port", port, pool_);
  port_->socket.bind(checker_.from_initiator);
  if (config.memory == Memory::kFixedLatency) {
    fixed_ = std::make_unique<FixedLatencyMemory>(
        "memory", config.memory_bytes,
        static_cast<double>(config.latency_cycles) * clock_.period());
    checker_.to_target.bind(fixed_->socket);
  } else {
    dram_ = std::make_unique<DramController>("memory", DramConfig{});
    checker_.to_target.bind(dram_->socket);
  }
}

UnitBench::~UnitBench() = default;

void UnitBench::load(std::uint64_t address, const std::vector<std::byte>& bytes) {
  if (bytes.empty()) return;
  if (dram_) {
    dram_->load(address, bytes.data(), bytes.size());
  } else {
    std::memcpy(fixed_->at(address), bytes.data(), bytes.size());
  }
}

std::vector<std::byte> UnitBench::read_back(std::uint64_t address, std::size_t bytes) const {
  std::vector<std::byte> out(bytes);
  if (dram_) {
    dram_->read_back(address, out.data(), bytes);
  } else {
    std::memcpy(out.data(), fixed_->at(address), bytes);
  }
  return out;
}

void UnitBench::add_thread(const std::string& name, std::function<void(Activity&)> body) {
  stimuli_.push_back(std::make_unique<Stimulus>(name.c_str(), clock_, std::move(body)));
}

void UnitBench::simulate(const std::function<void(sc_core::sc_trace_file*)>& trace_unit) {
  sc_core::sc_trace_file* file = nullptr;
  if (!test_.vcd_path.empty()) {
    // SystemC adds the extension itself.
    std::string stem = test_.vcd_path;
    if (stem.size() > 4 && stem.substr(stem.size() - 4) == ".vcd") stem.resize(stem.size() - 4);
    file = sc_core::sc_create_vcd_trace_file(stem.c_str());
    file->set_time_unit(1, sc_core::SC_PS);
    trace_unit(file);
    for (const AnyFifo& fifo : fifos_) fifo.trace(file);
  }
  sc_core::sc_start();
  if (file != nullptr) sc_core::sc_close_vcd_trace_file(file);

  for (const auto& stimulus : stimuli_) {
    checks().that(stimulus->returned(), std::string(stimulus->name()) + " waits forever");
  }
  for (const AnyFifo& fifo : fifos_) checks().that(fifo.empty(), fifo.name + " is not empty");
  checks().that(port_->idle(), "the memory port is not idle");
  checks().that(!dram_ || dram_->idle(), "the memory is not idle");
  checks().equal(checker_.violations().size(), std::size_t{0}, "violations of the TLM protocol");
  checks().equal(checker_.in_flight(), std::size_t{0}, "transactions in flight");
  checks().equal(pool_.in_use(), std::size_t{0}, "payloads in use");
}

}  // namespace sgs::tb
