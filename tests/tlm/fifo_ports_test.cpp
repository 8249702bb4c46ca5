// Ports to FIFOs: how many each takes.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "testbench/process/child_process.h"
#include "tests/tlm/fifo_reader.h"

namespace sgs {
namespace {

using test::FifoReader;

// A unit between two FIFOs.
struct Passer : sc_core::sc_module {
  FifoIn<int> in{"in"};
  FifoOut<int> out{"out"};
  explicit Passer(const sc_core::sc_module_name& name) : sc_module(name) {}
};

TEST_CASE("FIFO ports: what is left open, or bound twice, fails elaboration by its name") {
  struct Row {
    const char* what;
    std::vector<int> in, out, reader;  // numbers of the FIFOs that each port is bound to
    std::vector<const char*> message;  // none: elaboration succeeds
  };
  const std::vector<Row> rows = {
      {"an input left open", {}, {1}, {1}, {"port not bound", "unit.in"}},
      {"an output left open", {0}, {}, {0}, {"port not bound", "unit.out"}},
      {"an input of one FIFO or more left open", {0}, {1}, {}, {"port not bound", "reader.in"}},
      {"an input bound to two", {0, 2}, {1}, {1}, {"exceeds maximum of 1", "unit.in"}},
      {"all bound, one to two where that is meant", {0}, {1}, {1, 2}, {}},
  };
  for (const Row& row : rows) {
    INFO(row.what);
    // SystemC elaborates once a process.
    const std::string message = in_child([&] {
      const ClockDomain clock(1000);
      sc_core::sc_vector<TimedFifo<int>> fifos("fifo");
      fifos.init(3,
                 [&](const char* name, std::size_t) { return new TimedFifo<int>(name, clock, 1); });
      Passer unit("unit");
      FifoReader reader("reader");
      try {
        for (const int k : row.in) unit.in(fifos[static_cast<std::size_t>(k)]);
        for (const int k : row.out) unit.out(fifos[static_cast<std::size_t>(k)]);
        for (const int k : row.reader) reader.in(fifos[static_cast<std::size_t>(k)]);
        sc_core::sc_start(sc_core::SC_ZERO_TIME);
      } catch (const sc_core::sc_report& report) {
        return std::string(report.what());
      }
      return std::string("elaborated");
    });
    if (row.message.empty()) CHECK(message == "elaborated");
    for (const char* part : row.message) CHECK_THAT(message, Catch::Contains(part));
  }
}

}  // namespace
}  // namespace sgs
