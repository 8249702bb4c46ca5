// Memory ports through router and protocol checker to a DRAM: bytes, tickets, back-pressure.
#include "tlm/memory_port.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <functional>
#include <numeric>
#include <vector>

#include "modules/dram/dram_controller.h"
#include "tlm/protocol_checker.h"
#include "tlm/router.h"
#include "tlm/time_resolution.h"

namespace sgs {
namespace {

// A unit with one port, whose threads are given by the test.
class Unit : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Unit);
  Unit(const sc_core::sc_module_name& name, const MemoryPort::Config& config, PayloadPool& pool,
       std::vector<std::function<void(MemoryPort&)>> threads)
      : sc_module(name), port("port", config, pool), threads_(std::move(threads)) {
    for (std::size_t i = 0; i < threads_.size(); ++i) SC_THREAD(run);
  }

  MemoryPort port;
  std::uint32_t finished = 0;

 private:
  void run() {
    const std::size_t mine = started_++;
    threads_[mine](port);
    ++finished;
  }

  std::vector<std::function<void(MemoryPort&)>> threads_;
  std::size_t started_ = 0;
};

struct System {
  explicit System(std::uint32_t initiators, const DramConfig& config = {})
      : router("router", initiators), dram("dram", config), checkers("checker", initiators) {
    router.map(0, dram.capacity_bytes(), dram.socket);
    for (std::uint32_t i = 0; i < initiators; ++i)
      checkers[i].to_target.bind(router.from_initiators[i]);
  }
  void connect(std::uint32_t i, MemoryPort& port) { port.socket.bind(checkers[i].from_initiator); }
  void check_protocol() {
    for (ProtocolChecker& checker : checkers) {
      CHECK(checker.violations().empty());
      CHECK(checker.in_flight() == 0);
    }
    CHECK(pool.in_use() == 0);
    CHECK(dram.idle());
  }

  PayloadPool pool;
  Router router;
  DramController dram;
  sc_core::sc_vector<ProtocolChecker> checkers;
};

std::vector<std::uint8_t> counting(std::size_t bytes) {
  std::vector<std::uint8_t> data(bytes);
  std::iota(data.begin(), data.end(), std::uint8_t{1});
  return data;
}

MemoryPort::Config accurate() { return {1, 256, 16, TimingMode::kAccurate}; }
MemoryPort::Config fast() { return {1, 256, 16, TimingMode::kFast}; }

void writes_then_reads(MemoryPort& port) {
  const std::vector<std::uint8_t> data = counting(5000);
  std::vector<std::uint8_t> copy = data;
  const MemoryPort::Ticket written = port.write(777, copy.data(), 5000, 3);
  std::fill(copy.begin(), copy.end(), std::uint8_t{0});  // write() has its own copy
  port.wait_for(written);
  std::vector<std::uint8_t> read(5000);
  const MemoryPort::Ticket ticket = port.read(777, read.data(), 5000, 3);
  CHECK_FALSE(port.done(ticket));
  CHECK_FALSE(port.idle());
  port.wait_for(ticket);
  CHECK(port.done(ticket));
  CHECK(read == data);
  CHECK(port.bytes_outstanding() == 0);
  port.wait_all();
}

TEST_CASE("memory port: what was written is read back (accurate)") {
  use_femtosecond_resolution();
  System system(1);
  Unit unit("unit", accurate(), system.pool, {writes_then_reads});
  system.connect(0, unit.port);
  sc_core::sc_start();
  CHECK(unit.finished == 1);
  // 777..1023, then 256-byte blocks up to 5776: 1 + 18 + 1 transactions each way.
  CHECK(unit.port.transactions() == 40);
  CHECK(unit.port.bytes_read() == 5000);
  CHECK(unit.port.bytes_written() == 5000);
  CHECK(system.dram.stats().traffic.of(1, 3, Direction::kRead).bytes == 5000);
  system.check_protocol();
}

TEST_CASE("memory port: what was written is read back (fast)") {
  use_femtosecond_resolution();
  System system(1);
  Unit unit("unit", fast(), system.pool, {writes_then_reads});
  system.connect(0, unit.port);
  sc_core::sc_start();
  CHECK(unit.finished == 1);
  CHECK(unit.port.transactions() == 40);
  system.check_protocol();
}

TEST_CASE("memory port: threads share a port, tickets finish in any order") {
  use_femtosecond_resolution();
  DramConfig config;
  config.channels = 1;
  config.mapping = "row:rank:bank:column:channel";
  config.read_queue_entries = 4;
  System system(2, config);
  const auto body = [&](std::uint64_t base) {
    return [base](MemoryPort& port) {
      std::vector<std::uint8_t> data = counting(3000);
      port.write(base, data.data(), 3000, 0);
      port.wait_all();
      std::vector<std::vector<std::uint8_t>> into(20, std::vector<std::uint8_t>(100));
      std::vector<MemoryPort::Ticket> tickets;
      for (std::uint32_t i = 0; i < 20; ++i)
        tickets.push_back(port.read(base + i * 137, into[i].data(), 100, 0));
      for (std::uint32_t i = 20; i-- > 0;) {
        port.wait_for(tickets[i]);
        CHECK(std::equal(into[i].begin(), into[i].end(), data.begin() + i * 137));
      }
    };
  };
  Unit two("two", accurate(), system.pool, {body(0), body(10000)});
  Unit one("one", accurate(), system.pool, {body(20000)});
  system.connect(0, two.port);
  system.connect(1, one.port);
  sc_core::sc_start();
  CHECK(two.finished == 2);
  CHECK(one.finished == 1);
  system.check_protocol();
}

TEST_CASE("memory port: no more than max_outstanding transactions are in flight") {
  use_femtosecond_resolution();
  System system(1);
  MemoryPort::Config config = accurate();
  config.max_outstanding = 3;
  std::uint64_t most = 0;
  Unit unit("unit", config, system.pool, {[&](MemoryPort& port) {
              static std::uint8_t into[20][256];
              for (std::uint32_t i = 0; i < 20; ++i) {
                port.read(i * 256, into[i], 256, 0);
                most = std::max(most, port.bytes_outstanding());
              }
              port.wait_all();
            }});
  system.connect(0, unit.port);
  sc_core::sc_start();
  CHECK(most == 3 * 256);
  CHECK(system.pool.made() <= 4);
}

TEST_CASE("memory port: a finished ticket costs no waiting, an old one stays done") {
  use_femtosecond_resolution();
  System system(1);
  Unit unit("unit", accurate(), system.pool, {[](MemoryPort& port) {
              std::uint8_t byte = 0;
              const MemoryPort::Ticket first = port.read(0, &byte, 1, 0);
              port.wait_for(first);
              const sc_core::sc_time then = sc_core::sc_time_stamp();
              const std::uint64_t delta = sc_core::sc_delta_count();
              for (int i = 0; i < 1000; ++i) port.wait_for(first);
              CHECK(port.done(port.read(0, &byte, 0, 0)));  // nothing asked for: done at once
              CHECK(sc_core::sc_time_stamp() == then);
              CHECK(sc_core::sc_delta_count() == delta);
              for (int i = 0; i < 500; ++i) port.wait_for(port.read(64 * i, &byte, 1, 0));
              CHECK(port.done(first));
            }});
  system.connect(0, unit.port);
  sc_core::sc_start();
  CHECK(unit.finished == 1);
}

TEST_CASE("memory port: fast mode annotates what accurate mode takes when nothing contends") {
  use_femtosecond_resolution();
  System slow_system(1);
  std::vector<sc_core::sc_time> taken[2];
  const auto body = [&](int mode) {
    return [&taken, mode](MemoryPort& port) {
      std::uint8_t into[256];
      for (const std::uint64_t address : {0u, 32u, 1u << 17, 4096u}) {
        const sc_core::sc_time start = sc_core::sc_time_stamp();
        port.wait_for(port.read(address, into, 256, 0));
        taken[mode].push_back(sc_core::sc_time_stamp() - start);
        sc_core::wait(100, sc_core::SC_NS);
      }
    };
  };
  Unit slow("slow", accurate(), slow_system.pool, {body(0)});
  slow_system.connect(0, slow.port);
  DramController other("other", DramConfig{});
  Unit quick("quick", fast(), slow_system.pool, {body(1)});
  quick.port.socket.bind(other.socket);
  sc_core::sc_start();
  REQUIRE(taken[0].size() == 4);
  CHECK(taken[0] == taken[1]);
}

TEST_CASE("memory port: an error response is reported with requester and address") {
  use_femtosecond_resolution();
  System system(1);
  Unit unit("unit", accurate(), system.pool, {[&](MemoryPort& port) {
              std::uint8_t byte = 0;
              port.read(system.dram.capacity_bytes(), &byte, 1, 2);
            }});
  system.connect(0, unit.port);
  CHECK_THROWS_WITH(sc_core::sc_start(),
                    Catch::Contains("requester 1: read of 1 bytes at 0x80000000") &&
                        Catch::Contains("TLM_ADDRESS_ERROR_RESPONSE"));
}

}  // namespace
}  // namespace sgs
