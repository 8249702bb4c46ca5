// tb_dram's own test: initiators, router and protocol checkers around the memory.
#include "testbench/dram/self_check.h"

#include <fmt/format.h>

#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include "modules/dram/command_trace.h"
#include "modules/dram/dram_controller.h"
#include "modules/dram/trace_checker.h"
#include "testbench/dram/random_initiator.h"
#include "testbench/dram/stats_table.h"
#include "testbench/waveform/waveform.h"
#include "tlm/instant_end.h"
#include "tlm/memory_port.h"
#include "tlm/protocol_checker.h"
#include "tlm/router.h"
#include "tlm/run_simulation.h"

namespace sgs {

namespace {

constexpr std::uint32_t kPartBytes = 1 << 20;  // memory for each initiator
constexpr std::uint32_t kPorts = 2;
constexpr std::uint32_t kRandomInitiators = 2;

// A unit that uses a MemoryPort as the accelerator's units do: several tickets open at a time.
class PortUser : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(PortUser);
  PortUser(const sc_core::sc_module_name& name, std::uint64_t begin, std::uint64_t operations,
           std::uint64_t seed)
      : sc_module(name),
        port("port", MemoryPortConfig{}),
        mirror(kPartBytes),
        begin_(begin),
        operations_(operations),
        random_(seed) {
    SC_THREAD(run);
  }

  MemoryPort port;
  std::vector<std::uint8_t> mirror;
  std::uint64_t checks = 0;
  std::uint64_t failures = 0;
  bool finished = false;

 private:
  struct Read {
    MemoryPort::Ticket ticket;
    std::vector<std::uint8_t> data;
    std::vector<std::uint8_t> expected;
  };

  std::uint32_t below(std::uint32_t n) {
    return std::uniform_int_distribution<std::uint32_t>(0, n - 1)(random_);
  }

  void finish(Read& read) {
    port.wait_for(read.ticket);
    ++checks;
    if (read.data != read.expected || !port.done(read.ticket)) ++failures;
  }

  void run() {
    std::vector<std::unique_ptr<Read>> open;
    for (std::uint64_t i = 0; i < operations_; ++i) {
      const std::uint32_t length = 1 + below(below(10) == 0 ? 5000 : 300);
      const std::uint32_t offset = below(kPartBytes - length);
      if (below(2) == 0) {
        for (std::uint32_t k = 0; k < length; ++k)
          mirror[offset + k] = static_cast<std::uint8_t>(random_());
        port.write(begin_ + offset, mirror.data() + offset, length, 1);
      } else {
        auto read = std::make_unique<Read>();
        read->data.assign(length, 0xee);
        read->expected.assign(mirror.begin() + offset, mirror.begin() + offset + length);
        read->ticket = port.read(begin_ + offset, read->data.data(), length, 2);
        open.push_back(std::move(read));
      }
      if (open.size() > 6 || (below(4) == 0 && !open.empty())) {
        const std::size_t pick = below(static_cast<std::uint32_t>(open.size()));
        finish(*open[pick]);
        open.erase(open.begin() + static_cast<std::ptrdiff_t>(pick));
      }
      if (below(6) == 0) sc_core::wait(sc_core::sc_time(below(500), sc_core::SC_NS));
    }
    for (const auto& read : open) finish(*read);
    port.wait_all();
    finished = port.idle() && port.bytes_outstanding() == 0 && port.payloads().in_use() == 0;
  }

  const std::uint64_t begin_;
  const std::uint64_t operations_;
  std::mt19937_64 random_;
};

bool report(const char* name, std::uint64_t checks, std::uint64_t failures) {
  const bool pass = failures == 0 && checks > 0;
  fmt::print("{}  {:<44} {:>8} checks {:>6} failed\n", pass ? "PASS" : "FAIL", name, checks,
             failures);
  return pass;
}

std::uint64_t bytes_that_differ(const DramController& dram, std::uint64_t begin,
                                const std::vector<std::uint8_t>& mirror) {
  std::vector<std::uint8_t> stored(mirror.size());
  dram.read_back(begin, stored.data(), stored.size());
  std::uint64_t differ = 0;
  for (std::size_t i = 0; i < mirror.size(); ++i) differ += stored[i] != mirror[i];
  return differ;
}

}  // namespace

bool run_self_check(const SelfCheck& check) {
  DramController dram("dram", check.dram);
  InstantEnd instant_end("instant_end");
  Router router("router", instant_end, kPorts + kRandomInitiators);
  router.map(0, dram.capacity_bytes(), dram.socket);
  TraceChecker commands(dram.memspec(), CommandTraceHeader::of(check.dram));
  dram.add_command_sink(commands);
  std::unique_ptr<CommandTraceWriter> trace;
  if (check.dram_trace != nullptr) {
    trace = std::make_unique<CommandTraceWriter>(*check.dram_trace,
                                                 CommandTraceHeader::of(check.dram), dram);
  }

  sc_core::sc_vector<ProtocolChecker> protocol("protocol", kPorts + kRandomInitiators);
  std::vector<std::unique_ptr<PortUser>> users;
  for (std::uint32_t i = 0; i < kPorts; ++i) {
    users.push_back(std::make_unique<PortUser>(fmt::format("user_{}", i).c_str(),
                                               std::uint64_t{i} * kPartBytes, check.transactions,
                                               check.seed * 100 + i));
    users[i]->port.socket.bind(protocol[i].from_initiator);
  }
  std::vector<std::unique_ptr<RandomInitiator>> initiators;
  for (std::uint32_t i = 0; i < kRandomInitiators; ++i) {
    const RandomInitiator::Config config{std::uint64_t{kPorts + i} * kPartBytes, kPartBytes,
                                         check.transactions, check.seed * 100 + 50 + i};
    initiators.push_back(
        std::make_unique<RandomInitiator>(fmt::format("initiator_{}", i).c_str(), config));
    initiators[i]->socket.bind(protocol[kPorts + i].from_initiator);
  }
  for (std::uint32_t i = 0; i < kPorts + kRandomInitiators; ++i)
    protocol[i].to_target.bind(router.from_initiators[i]);

  std::unique_ptr<Waveform> waveform;
  if (check.vcd != nullptr) {
    const std::vector<sc_core::sc_time> steps = {sc_core::sc_time(1, sc_core::SC_NS),
                                                 dram.clock_period()};
    waveform = std::make_unique<Waveform>(*check.vcd, steps);
    for (const auto& user : users) user->port.trace(waveform->file());
  }

  run_simulation();
  if (waveform) waveform->close();
  if (trace) trace->close();
  const DramStats stats = dram.stats();

  bool pass = true;
  std::uint64_t bytes = 0, differ = 0, violations = 0, transactions = 0;
  for (std::uint32_t i = 0; i < kPorts; ++i) {
    pass &= report(fmt::format("memory port {}: reads against the mirror", i).c_str(),
                   users[i]->checks, users[i]->failures + (users[i]->finished ? 0 : 1));
    bytes += users[i]->port.bytes_read() + users[i]->port.bytes_written();
    differ += bytes_that_differ(dram, std::uint64_t{i} * kPartBytes, users[i]->mirror);
  }
  for (std::uint32_t i = 0; i < kRandomInitiators; ++i) {
    pass &= report(fmt::format("initiator {}: answers against the mirror", i).c_str(),
                   initiators[i]->checks(),
                   initiators[i]->failures() + (initiators[i]->finished() ? 0 : 1));
    bytes += initiators[i]->bytes_moved();
    differ +=
        bytes_that_differ(dram, std::uint64_t{kPorts + i} * kPartBytes, initiators[i]->mirror());
  }
  for (const ProtocolChecker& checker : protocol) {
    violations += checker.violations().size() + checker.in_flight();
    transactions += checker.finished();
  }
  pass &= report("stored bytes against the mirrors",
                 std::uint64_t{kPorts + kRandomInitiators} * kPartBytes, differ);
  pass &= report("base protocol", transactions, violations);
  if (commands.first()) fmt::print("      {}\n", commands.first()->text());
  pass &= report("device constraints", commands.checked(), commands.first() ? 1 : 0);
  pass &= report("bytes asked for = bytes counted", 1, bytes == stats.bytes() ? 0 : 1);
  pass &= report("transactions begun = finished = counted", 1,
                 transactions == stats.traffic.total().transactions && dram.idle() ? 0 : 1);
  fmt::print("\n");
  fmt::print("{}", stats_table(stats));
  fmt::print("\n{}\n", pass ? "PASS" : "FAIL");
  return pass;
}

}  // namespace sgs
