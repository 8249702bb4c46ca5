// A waveform is written whole or reported.
#include "testbench/waveform/waveform.h"

#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <string>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace sgs {
namespace {

using Catch::Matchers::Contains;

std::vector<sc_core::sc_time> nanoseconds() { return {sc_core::sc_time(1, sc_core::SC_NS)}; }

// Counts in 64 bits, once a nanosecond.
class Counter : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Counter);
  Counter(const sc_core::sc_module_name& name, std::uint64_t last) : sc_module(name), last_(last) {
    SC_THREAD(run);
  }
  std::uint64_t count = 0;

 private:
  void run() {
    while (count < last_) {
      sc_core::wait(1, sc_core::SC_NS);
      ++count;
    }
  }
  const std::uint64_t last_;
};

// Value changes of the file, its first value among them.
std::size_t changes_in(const std::string& vcd) {
  std::size_t changes = 0;
  for (std::size_t at = vcd.find("\nb"); at != std::string::npos; at = vcd.find("\nb", at + 1)) {
    ++changes;
  }
  return changes;
}

TEST_CASE("waveform: every change up to the last moment is in the file") {
  const test::ScratchFolder scratch;
  OutputFile output(scratch.path("folder/wave"));
  Waveform waveform(output, nanoseconds());
  constexpr std::uint64_t kLast = 50000;
  Counter counter("counter", kLast);
  sc_core::sc_trace(waveform.file(), counter.count, "count");
  sc_core::sc_start();
  waveform.close();
  CHECK_FALSE(std::filesystem::exists(scratch.path("folder/wave")));
  output.commit();
  const std::string vcd = test::bytes_of(scratch.path("folder/wave"));
  CHECK_THAT(vcd, Contains("$timescale\n     1 ps\n$end") && Contains("#49999000"));
  CHECK(changes_in(vcd) == kLast);  // SystemC writes a moment when it is over
  CHECK(scratch.file_count() == 1);
}

TEST_CASE("waveform: on a disk that is full it says so and leaves nothing") {
#ifdef __SANITIZE_ADDRESS__
  SUCCEED("skipped: AddressSanitizer does not know SystemC's stacks when an exception unwinds");
  return;
#endif
  const test::ScratchFolder scratch;
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{100000, RLIM_INFINITY};
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &small) == 0);
  {
    OutputFile output(scratch.path("wave.vcd"));
    Waveform waveform(output, nanoseconds());
    Counter counter("counter", 5000);  // several times what fits, also into the pipe
    sc_core::sc_trace(waveform.file(), counter.count, "count");
    sc_core::sc_start();
    CHECK_THROWS_WITH(waveform.close(), Contains("wave.vcd: cannot be written completely"));
  }
  CHECK(scratch.file_count() == 0);
}

TEST_CASE("waveform: dropped without a simulation, and while one is under way") {
  const test::ScratchFolder scratch;
  {
    OutputFile output(scratch.path("none.vcd"));
    const Waveform waveform(output, nanoseconds());
  }
  {
    Counter counter("counter", 5000);
    OutputFile output(scratch.path("cut.vcd"));
    const Waveform waveform(output, nanoseconds());
    sc_core::sc_trace(waveform.file(), counter.count, "count");
    sc_core::sc_start(2000, sc_core::SC_NS);
  }
  CHECK(scratch.file_count() == 0);
}

}  // namespace
}  // namespace sgs
