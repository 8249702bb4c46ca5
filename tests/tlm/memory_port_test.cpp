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

}  // namespace
}  // namespace sgs
