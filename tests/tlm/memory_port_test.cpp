// Memory ports through router and protocol checker to a DRAM: bytes, tickets, back-pressure; and
// answers of every kind.
#include "tlm/memory_port.h"

#include <tlm_utils/simple_target_socket.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "modules/dram/dram_controller.h"
#include "tests/tlm/scripted_ends.h"
#include "tests/tlm/unit_with_port.h"
#include "tlm/protocol_checker.h"
#include "tlm/router.h"
#include "tlm/time_resolution.h"

namespace sgs {
namespace {

using test::Unit;

struct System {
  explicit System(std::uint32_t initiators, const DramConfig& config = {})
      : router("router", instant_end, initiators),
        dram("dram", config),
        checkers("checker", initiators) {
    router.map(0, dram.capacity_bytes(), dram.socket);
    for (std::uint32_t i = 0; i < initiators; ++i)
      checkers[i].to_target.bind(router.from_initiators[i]);
  }
  void connect(std::uint32_t i, MemoryPort& port) {
    port.socket.bind(checkers[i].from_initiator);
    ports.push_back(&port);
  }
  void check_protocol() {
    for (ProtocolChecker& checker : checkers) {
      CHECK(checker.violations().empty());
      CHECK(checker.in_flight() == 0);
    }
    for (const MemoryPort* port : ports) {
      CHECK(port->idle());
      CHECK(port->payloads().in_use() == 0);
    }
    CHECK(dram.idle());
  }

  InstantEnd instant_end{"instant_end"};
  Router router;
  DramController dram;
  sc_core::sc_vector<ProtocolChecker> checkers;
  std::vector<const MemoryPort*> ports;
};

std::vector<std::uint8_t> counting(std::size_t bytes) {
  std::vector<std::uint8_t> data(bytes);
  std::iota(data.begin(), data.end(), std::uint8_t{1});
  return data;
}

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

TEST_CASE("memory port: what was written is read back") {
  use_femtosecond_resolution();
  System system(1);
  Unit unit("unit", MemoryPortConfig{}, {writes_then_reads});
  system.connect(0, unit.port);
  sc_core::sc_start();
  CHECK(unit.finished == 1);
  // 777..1023, then 256-byte blocks up to 5776: 1 + 18 + 1 transactions each way.
  CHECK(unit.port.transactions() == 40);
  CHECK(unit.port.bytes_read() == 5000);
  CHECK(unit.port.bytes_written() == 5000);
  CHECK(system.dram.stats().traffic.of(0, 3, Direction::kRead).bytes == 5000);
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
  Unit two("two", MemoryPortConfig{}, {body(0), body(10000)});
  Unit one("one", MemoryPortConfig{}, {body(20000)});
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
  MemoryPortConfig config;
  config.max_outstanding = 3;
  std::uint64_t most = 0;
  Unit unit("unit", config, {[&](MemoryPort& port) {
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
  CHECK(unit.port.payloads().made() <= 4);
}

TEST_CASE("memory port: of the bytes of writes it keeps those of max_writes") {
  use_femtosecond_resolution();
  DramConfig slow;
  slow.posted_writes = false;  // answered when they are written
  System system(1, slow);
  MemoryPortConfig config;
  config.max_writes = 2;
  config.max_transaction_bytes = 64;
  std::uint64_t most = 0, most_reading = 0;
  Unit unit("unit", config, {[&](MemoryPort& port) {
              static std::uint8_t bytes[20][64];
              for (std::uint32_t i = 0; i < 20; ++i) {
                port.write(i * 64, bytes[i], 64, 0);
                most = std::max(most, port.bytes_outstanding());
              }
              // Reads need not wait for them.
              for (std::uint32_t i = 0; i < 10; ++i) {
                port.read(i * 64, bytes[i], 64, 0);
                most_reading = std::max(most_reading, port.bytes_outstanding());
              }
              port.wait_all();
            }});
  system.connect(0, unit.port);
  sc_core::sc_start();
  CHECK(most == 2 * 64);
  CHECK(most == unanswered_writes("writes", "shared", config, 100).bytes);
  CHECK(unanswered_writes("writes", "shared", config, 48).bytes == 2 * 48);
  CHECK(most_reading > 4 * 64);
}

TEST_CASE("memory port: a finished ticket costs no waiting, an old one stays done") {
  use_femtosecond_resolution();
  System system(1);
  Unit unit("unit", MemoryPortConfig{}, {[](MemoryPort& port) {
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

TEST_CASE("memory port: takes answers in every way of the base protocol") {
  using test::Answers;
  struct Row {
    Answers answers;
    double sent_ns, answered_ns;  // the last request, and the last answer
  };
  // Four reads of one transaction each; a request goes when the one before has ended, at once or
  // after the delay that it was answered with.
  const std::vector<Row> rows = {
      {Answers::kCompleted, 0, 0},
      {Answers::kCompletedLater, 3 * 30, 4 * 30},
      {Answers::kEndOfRequest, 0, 40},
      {Answers::kResponse, 0, 0},
      {Answers::kResponseLater, 3 * 20, 4 * 20},
      {Answers::kCalls, 3 * 10, 3 * 10 + 50},
      {Answers::kResponseCall, 3 * 25, 4 * 25},
      // The first response, called at 15, lasts until 45 and holds up the calls that follow.
      {Answers::kCallsWithDelays, 45 + 5, 15 + 4 * 30},
      {Answers::kMixed, 30, 30 + 40},  // the first four ways
  };
  struct Chain {
    explicit Chain(Answers answers)
        : unit(sc_core::sc_gen_unique_name("unit"), MemoryPortConfig{},
               {[this](MemoryPort& port) { read(port); }}),
          target(sc_core::sc_gen_unique_name("target"), answers) {
      unit.port.socket.bind(checker.from_initiator);
      checker.to_target.bind(target.socket);
    }
    void read(MemoryPort& port) {
      std::uint8_t into[4] = {};
      for (std::uint64_t k = 0; k < 4; ++k) port.read(64 * k, &into[k], 1, 0);
      sent = sc_core::sc_time_stamp();
      port.wait_all();
      answered = sc_core::sc_time_stamp();
      for (std::uint8_t k = 0; k < 4; ++k) CHECK(into[k] == k);
    }
    Unit unit;
    test::ScriptedTarget target;
    ProtocolChecker checker{sc_core::sc_gen_unique_name("checker")};
    sc_core::sc_time sent, answered;
  };
  std::vector<std::unique_ptr<Chain>> chains;
  for (const Row& row : rows) chains.push_back(std::make_unique<Chain>(row.answers));
  sc_core::sc_start();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    INFO("answers " << static_cast<int>(rows[i].answers));
    const Chain& chain = *chains[i];
    CHECK(chain.unit.finished == 1);
    CHECK(chain.unit.port.idle());
    CHECK(chain.unit.port.payloads().in_use() == 0);
    CHECK(chain.checker.violations() == std::vector<std::string>{});
    CHECK(chain.checker.finished() == 4);
    CHECK(chain.sent.to_seconds() * 1e9 == Approx(rows[i].sent_ns));
    CHECK(chain.answered.to_seconds() * 1e9 == Approx(rows[i].answered_ns));
  }
}

// Answers everything at once, and remembers when it came.
class PromptMemory : public sc_core::sc_module {
 public:
  tlm_utils::simple_target_socket<PromptMemory> socket{"socket"};
  explicit PromptMemory(const sc_core::sc_module_name& name) : sc_module(name) {
    socket.register_nb_transport_fw(this, &PromptMemory::nb_transport_fw);
  }
  std::vector<double> came_ns;

 private:
  tlm::tlm_sync_enum nb_transport_fw(tlm::tlm_generic_payload& payload, tlm::tlm_phase&,
                                     sc_core::sc_time&) {
    came_ns.push_back(sc_core::sc_time_stamp().to_seconds() * 1e9);
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
    return tlm::TLM_COMPLETED;
  }
};

TEST_CASE(
    "memory port: a word of its width leaves and arrives a cycle, behind the path's registers") {
  struct Row {
    std::uint32_t path_cycles;
    bool write;
    std::uint32_t bytes;
    std::vector<double> came_ns;  // at the memory, of three transactions asked for at 100
    double done_ns;
  };
  // 32 B a cycle of 1 ns. The memory answers at once: what is read comes no faster than its words,
  // writes are answered by a word without data.
  const std::vector<Row> rows = {
      {0, false, 32, {100, 101, 102}, 102},
      {1, false, 32, {101, 102, 103}, 104},
      {3, false, 32, {103, 104, 105}, 108},
      {1, false, 33, {101, 102, 103}, 101 + 2 * 2 + 1},
      {1, false, 256, {101, 102, 103}, 101 + 2 * 8 + 1},
      {0, true, 256, {107, 115, 123}, 123},
      {1, true, 256, {108, 116, 124}, 125},
      {3, true, 256, {110, 118, 126}, 129},
  };
  struct Run {
    explicit Run(const Row& row)
        : unit(sc_core::sc_gen_unique_name("unit"), config_of(row), {[this, row](MemoryPort& port) {
                 sc_core::wait(100, sc_core::SC_NS);
                 for (std::uint64_t k = 0; k < 3; ++k) {
                   if (row.write) {
                     port.write(256 * k, bytes, row.bytes, 0);
                   } else {
                     port.read(256 * k, bytes, row.bytes, 0);
                   }
                 }
                 port.wait_all();
                 done_ns = sc_core::sc_time_stamp().to_seconds() * 1e9;
               }},
               sc_core::sc_time(1, sc_core::SC_NS)),
          memory(sc_core::sc_gen_unique_name("memory")) {
      unit.port.socket.bind(memory.socket);
    }
    static MemoryPortConfig config_of(const Row& row) {
      MemoryPortConfig config;
      config.path_cycles = row.path_cycles;
      config.max_writes = 16;
      return config;
    }
    std::uint8_t bytes[256] = {};
    Unit unit;
    PromptMemory memory;
    double done_ns = 0;
  };
  std::vector<std::unique_ptr<Run>> runs;
  for (const Row& row : rows) runs.push_back(std::make_unique<Run>(row));
  sc_core::sc_start();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    INFO("row " << i);
    REQUIRE(runs[i]->memory.came_ns.size() == 3);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(runs[i]->memory.came_ns[k] == Approx(rows[i].came_ns[k]));
    }
    CHECK(runs[i]->done_ns == Approx(rows[i].done_ns));
    CHECK(runs[i]->unit.port.idle());
  }
}

TEST_CASE("memory port: an error response is reported with port and address") {
  use_femtosecond_resolution();
  System system(1);
  Unit unit("unit", MemoryPortConfig{}, {[&](MemoryPort& port) {
              std::uint8_t byte = 0;
              port.read(system.dram.capacity_bytes(), &byte, 1, 2);
            }});
  system.connect(0, unit.port);
  CHECK_THROWS_WITH(sc_core::sc_start(),
                    Catch::Contains("unit.port: read of 1 bytes at 0x80000000") &&
                        Catch::Contains("TLM_ADDRESS_ERROR_RESPONSE"));
}

}  // namespace
}  // namespace sgs
