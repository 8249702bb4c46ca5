// A command trace holds what the counts hold, whichever of the two is asked for first.
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "modules/dram/command_trace.h"
#include "modules/dram/dram_controller.h"
#include "modules/dram/trace_checker.h"
#include "tests/modules/dram/test_initiator.h"
#include "tests/support/scratch_folder.h"
#include "tlm/time_resolution.h"

namespace sgs {
namespace {

using sc_core::SC_NS;

// A memory, its trace, and a thread that asks for some requests and then for the counts.
class TraceBench {
 public:
  TraceBench(const DramConfig& config, bool blocking, std::uint32_t seed, std::string path)
      : path_(std::move(path)),
        blocking_(blocking),
        random_(seed),
        dram_(sc_core::sc_gen_unique_name("dram"), config),
        initiator_(sc_core::sc_gen_unique_name("initiator"),
                   [this](test::Initiator& i) { run(i); }),
        file_(path_),
        trace_(file_, CommandTraceHeader::of(config), dram_) {
    initiator_.socket.bind(dram_.socket);
  }

  void check() {
    REQUIRE(initiator_.finished);
    file_.commit();
    CommandTraceReader reader(path_);
    TraceChecker checker(dram_.memspec(), reader.header());
    std::array<std::uint64_t, kCommands> commands{};
    CommandRecord record;
    while (reader.next(record)) {
      const auto violation = checker.check(record);
      if (violation) FAIL(violation->text());
      ++commands[static_cast<std::size_t>(record.command)];
    }
    CHECK(commands == stats_.all_channels().commands);
    CHECK(checker.checked() > 0);
  }

 private:
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }

  void run(test::Initiator& i) {
    for (std::uint32_t requests = 1 + below(40); requests > 0; --requests) {
      const auto command = below(2) == 0 ? tlm::TLM_READ_COMMAND : tlm::TLM_WRITE_COMMAND;
      PooledPayload& p = i.make(command, std::uint64_t{32} * below(1 << 20), 1 + below(300));
      if (blocking_) {
        sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
        i.blocking(p, delay);
        p.release();
        sc_core::wait(delay);
      } else if (i.begin(p) == tlm::TLM_COMPLETED) {
        p.release();
      }
      sc_core::wait(1 + below(below(4) == 0 ? 9000 : 90), SC_NS);
    }
    sc_core::wait(1000 + below(9000), SC_NS);
    if (below(2) == 0) {
      stats_ = dram_.stats();
      trace_.close();
    } else {
      trace_.close();
      stats_ = dram_.stats();
    }
    // What comes later, refreshes at least, is not for the closed file.
    sc_core::wait(20000, SC_NS);
    const bool refreshes_itself = dram_.config().self_refresh_idle_cycles > 0;
    const std::uint64_t later = dram_.stats().all_channels().refreshes();
    CHECK((refreshes_itself || later > stats_.all_channels().refreshes()));
  }

  const std::string path_;
  const bool blocking_;
  std::mt19937 random_;
  DramController dram_;
  test::Initiator initiator_;
  OutputFile file_;
  CommandTraceWriter trace_;
  DramStats stats_;
};

TEST_CASE("command trace: closed before or after the counts are asked for, it holds what they do") {
  use_femtosecond_resolution();
  const test::ScratchFolder scratch;
  struct Row {
    std::uint32_t power_down_idle_cycles, self_refresh_idle_cycles;
    RefreshMode refresh;
  };
  const std::vector<Row> rows = {{0, 0, RefreshMode::kAllBank},
                                 {10, 0, RefreshMode::kAllBank},
                                 {10, 500, RefreshMode::kAllBank},
                                 {10, 0, RefreshMode::kPerBank}};
  std::vector<std::unique_ptr<TraceBench>> benches;
  for (const Row& row : rows)
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
      DramConfig config;
      config.power_down_idle_cycles = row.power_down_idle_cycles;
      config.self_refresh_idle_cycles = row.self_refresh_idle_cycles;
      config.refresh = row.refresh;
      const std::string path = scratch.path(std::to_string(benches.size()));
      benches.push_back(std::make_unique<TraceBench>(config, seed % 4 == 0, seed, path));
    }
  sc_core::sc_start();
  for (const auto& bench : benches) bench->check();
}

}  // namespace
}  // namespace sgs
