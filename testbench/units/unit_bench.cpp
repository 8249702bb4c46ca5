// Memory, stimulus threads and the checks at the end.
#include "testbench/units/unit_bench.h"

#include <cstring>
#include <limits>
#include <optional>

#include "testbench/result/waveform_sheet.h"
#include "testbench/waveform/waveform.h"
#include "tlm/run_simulation.h"

namespace sgs::tb {

class UnitBench::Stimulus : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Stimulus);
  Stimulus(const sc_core::sc_module_name& name, const ClockDomain& clock,
           std::function<void(Activity&)> body)
      : sc_module(name), activity_("activity", clock), body_(std::move(body)) {
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

BenchConfig still_bench(std::size_t memory_bytes) {
  BenchConfig config;
  config.memory_bytes = memory_bytes;
  return config;
}

BenchConfig random_bench(std::mt19937_64& random, std::size_t memory_bytes) {
  BenchConfig config;
  config.memory = random() % 2 == 0 ? Memory::kFixedLatency : Memory::kDram;
  config.latency_cycles = static_cast<std::uint32_t>(random() % 100);
  config.write_latency_cycles = 5 * config.latency_cycles;
  config.memory_bytes = memory_bytes;
  constexpr double kProbabilities[] = {0, 0.02, 0.3};
  config.stall_probability = kProbabilities[random() % 3];
  config.longest_stall_cycles = random() % 2 == 0 ? 5 : 200;
  return config;
}

UnitBench::UnitBench(Case& test, const BenchConfig& config) : test_(test), config_(config) {
  if (config.stall_probability > 0) {
    stalls_ = {config.stall_probability, config.longest_stall_cycles, test.random()};
  }
}

UnitBench::~UnitBench() = default;

UnitContext UnitBench::context(const StreamingJob& job) const {
  constexpr std::uint32_t kUnlimited = 4096;
  MemoryPortConfig port;
  if (config_.memory == Memory::kFixedLatency) port.max_outstanding = port.max_writes = kUnlimited;
  // The units' times, not those of the port, which tests/tlm has.
  port.path_cycles = 0;
  port.width_bytes = port.max_transaction_bytes;
  BuiltFor built_for;
  built_for.memory_port = config_.port.value_or(port);
  return {clock_, job, built_for};
}

void UnitBench::load(std::uint64_t address, const std::vector<std::byte>& bytes) {
  make_memory();
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

void UnitBench::run() {
  connect_memory();
  simulate();
  check_end();
}

void UnitBench::make_memory() {
  if (dram_ || fixed_) return;
  if (config_.memory == Memory::kDram) {
    dram_ = std::make_unique<DramController>("memory", DramConfig{});
  } else {
    fixed_ = std::make_unique<FixedLatencyMemory>(
        "memory", config_.memory_bytes,
        static_cast<double>(config_.latency_cycles) * clock_.period(),
        static_cast<double>(config_.write_latency_cycles) * clock_.period());
  }
}

void UnitBench::connect_memory() {
  const std::size_t ports = published_.ports.size();
  if (ports == 0) return;
  make_memory();
  router_ = std::make_unique<Router>("router", instant_end_, static_cast<std::uint32_t>(ports));
  constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();
  if (dram_) {
    router_->map(0, kAll, dram_->socket);
  } else {
    router_->map(0, kAll, fixed_->socket);
  }
  for (std::size_t i = 0; i < ports; ++i) {
    checkers_.push_back(std::make_unique<ProtocolChecker>(fmt::format("checker{}", i).c_str()));
    published_.ports[i]->socket.bind(checkers_[i]->from_initiator);
    checkers_[i]->to_target.bind(router_->from_initiators[i]);
  }
}

void UnitBench::simulate() {
  std::optional<Waveform> waveform;
  if (test_.vcd != nullptr) {
    std::vector<sc_core::sc_time> steps = {clock_.period()};
    if (dram_) steps.push_back(dram_->clock_period());
    waveform.emplace(*test_.vcd, steps);
    WaveformSheet sheet(waveform->file());
    for (const auto& publish_unit : publishers_) publish_unit(sheet);
    for (const auto& fifo : fifos_) fifo->trace(waveform->file());
    if (dram_) dram_->trace(waveform->file());
  }
  run_simulation();
  if (waveform) waveform->close();
}

void UnitBench::check_end() {
  for (const auto& stimulus : stimuli_) {
    checks().that(stimulus->returned(), fmt::format("{} waits forever", stimulus->name()));
  }
  const auto check_empty = [this](const FifoChannel& fifo) {
    checks().equal(fifo.fill(), 0U, fmt::format("{}: entries left", fifo.name()));
  };
  for (const auto& fifo : fifos_) check_empty(*fifo);
  for (const FifoChannel* queue : published_.queues) check_empty(*queue);
  for (const MemoryPort* port : published_.ports) {
    checks().that(port->idle(), fmt::format("{} is not idle", port->name()));
    checks().equal(port->payloads().in_use(), std::size_t{0},
                   fmt::format("{}: payloads in use", port->name()));
  }
  checks().that(!dram_ || dram_->idle(), "the memory is not idle");
  checks().that(!fixed_ || fixed_->idle(), "the memory is not idle");
  for (const auto& checker : checkers_) {
    checks().equal(checker->violations().size(), std::size_t{0},
                   fmt::format("{}: violations of the TLM protocol", checker->name()));
    checks().equal(checker->in_flight(), std::size_t{0},
                   fmt::format("{}: transactions in flight", checker->name()));
  }
  for (Activity* activity : published_.activities) {
    activity->close();
    checks().equal(activity->busy_cycles() + activity->waited(), clock_.now_cycles(),
                   fmt::format("{}: cycles busy and waited", activity->name()));
  }
}

void UnitBench::wait_until_just_before(std::uint64_t cycle) const {
  const sc_core::sc_time middle = (static_cast<double>(cycle) - 0.5) * clock_.period();
  sc_core::wait(middle - sc_core::sc_time_stamp());
}

Published UnitBench::publish() const {
  Published now;
  for (const auto& publish_unit : publishers_) publish_unit(now);
  return now;
}

std::uint64_t UnitBench::counter(const std::string& name) const { return publish().counter(name); }

void UnitBench::check_counter(const std::string& name, std::uint64_t expected) {
  checks().equal(counter(name), expected, name);
}

void UnitBench::check_operations(const std::string& component, const std::string& kind,
                                 std::uint64_t expected) {
  checks().equal(publish().operations(component, kind), static_cast<double>(expected),
                 component + ": " + kind);
}

void UnitBench::check_accesses(const std::string& use, std::uint64_t reads, std::uint64_t writes) {
  const auto [read, written] = publish().accesses(use);
  checks().equal(read, reads, use + ": reads");
  checks().equal(written, writes, use + ": writes");
}

std::uint64_t UnitBench::bytes_read() const {
  std::uint64_t sum = 0;
  for (const MemoryPort* port : published_.ports) sum += port->bytes_read();
  return sum;
}

std::uint64_t UnitBench::bytes_written() const {
  std::uint64_t sum = 0;
  for (const MemoryPort* port : published_.ports) sum += port->bytes_written();
  return sum;
}

std::uint64_t UnitBench::transactions() const {
  std::uint64_t sum = 0;
  for (const MemoryPort* port : published_.ports) sum += port->transactions();
  return sum;
}

}  // namespace sgs::tb
