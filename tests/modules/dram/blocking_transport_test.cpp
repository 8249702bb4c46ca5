// Blocking transport: the same streams as through non-blocking, bytes, and commands.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <memory>
#include <queue>
#include <random>
#include <string>
#include <vector>

#include "modules/dram/command_trace.h"
#include "modules/dram/dram_controller.h"
#include "modules/dram/trace_checker.h"
#include "tests/modules/dram/test_initiator.h"
#include "tlm/memory_port.h"
#include "tlm/time_resolution.h"

namespace sgs {
namespace {

using test::Initiator;

enum class Stream { kSequentialReads, kRandomReads, kSequentialWrites };

constexpr std::uint32_t kRequests = 4000;
constexpr std::size_t kWindow = 16;  // requests without an answer

struct Request {
  bool write;
  std::uint64_t address;
  std::uint32_t bytes;
};

std::vector<Request> requests_of(Stream stream) {
  std::vector<Request> requests;
  std::uint64_t state = 1;
  for (std::uint64_t i = 0; i < kRequests; ++i) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    if (stream == Stream::kRandomReads) {
      requests.push_back({false, (state >> 34U) & ~31ULL, 32});
    } else {
      requests.push_back({stream == Stream::kSequentialWrites, i * 256, 256});
    }
  }
  return requests;
}

// A memory and a stream of requests to it; when the last was answered.
struct Run {
  Run(const DramConfig& config, Stream stream)
      : memory(sc_core::sc_gen_unique_name("dram"), config), requests(requests_of(stream)) {}
  DramController memory;
  const std::vector<Request> requests;
  double took_ns = 0;

 protected:
  void done() { took_ns = sc_core::sc_time_stamp() / sc_core::sc_time(1, sc_core::SC_NS); }
};

class NonBlocking : public sc_core::sc_module, public Run {
 public:
  SC_HAS_PROCESS(NonBlocking);
  NonBlocking(const sc_core::sc_module_name& name, const DramConfig& config, Stream stream)
      : sc_module(name),
        Run(config, stream),
        port_("port", MemoryPortConfig{256, kWindow, kWindow}) {
    port_.socket.bind(memory.socket);
    SC_THREAD(run);
  }

 private:
  void run() {
    for (const Request& request : requests) {
      if (request.write) {
        port_.write(request.address, data_, request.bytes, 0);
      } else {
        port_.read(request.address, data_, request.bytes, 0);
      }
    }
    port_.wait_all();
    done();
  }
  MemoryPort port_;
  std::uint8_t data_[256] = {};
};

// Asks ahead of its answers, which are annotated.
class Blocking : public Run {
 public:
  Blocking(const DramConfig& config, Stream stream)
      : Run(config, stream),
        initiator_(sc_core::sc_gen_unique_name("initiator"), [this](Initiator& i) { run(i); }) {
    initiator_.socket.bind(memory.socket);
  }
  const Initiator& initiator() const { return initiator_; }

 private:
  void run(Initiator& initiator) {
    for (const Request& request : requests) {
      if (answers_.size() == kWindow) wait_for_first();
      PooledPayload& payload =
          initiator.make(request.write ? tlm::TLM_WRITE_COMMAND : tlm::TLM_READ_COMMAND,
                         request.address, request.bytes);
      sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
      CHECK(initiator.blocking(payload, delay) == tlm::TLM_OK_RESPONSE);
      payload.release();
      answers_.push(sc_core::sc_time_stamp() + delay);
    }
    while (!answers_.empty()) wait_for_first();
    done();
  }
  void wait_for_first() {
    const sc_core::sc_time& now = sc_core::sc_time_stamp();
    if (answers_.top() > now) sc_core::wait(answers_.top() - now);
    answers_.pop();
  }
  Initiator initiator_;
  std::priority_queue<sc_core::sc_time, std::vector<sc_core::sc_time>, std::greater<>> answers_;
};

TEST_CASE("blocking transport: sequential streams within 5 % of non-blocking, random ones slower") {
  use_femtosecond_resolution();
  DramConfig config;
  config.posted_writes = false;  // a blocking write is answered when it is written
  struct Row {
    Stream stream;
    double most;  // of the time that non-blocking requests take
  };
  // In order of arrival a bank conflict holds up the columns behind it, which queues let pass.
  const std::vector<Row> rows = {{Stream::kSequentialReads, 1.05},
                                 {Stream::kRandomReads, 1.4},
                                 {Stream::kSequentialWrites, 1.05}};
  std::vector<std::unique_ptr<NonBlocking>> queued;
  std::vector<std::unique_ptr<Blocking>> in_order;
  for (const Row& row : rows) {
    queued.push_back(
        std::make_unique<NonBlocking>(sc_core::sc_gen_unique_name("queued"), config, row.stream));
    in_order.push_back(std::make_unique<Blocking>(config, row.stream));
  }
  sc_core::sc_start();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    INFO("stream " << i);
    CHECK(queued[i]->took_ns > 1000);
    CHECK(in_order[i]->initiator().finished);
    const double ratio = in_order[i]->took_ns / queued[i]->took_ns;
    CHECK(ratio > 0.95);
    CHECK(ratio < rows[i].most);
    const DramStats one = queued[i]->memory.stats();
    const DramStats other = in_order[i]->memory.stats();
    CHECK(one.bytes() == other.bytes());
    CHECK(one.bus_bytes() == other.bus_bytes());
    CHECK(one.traffic.total().transactions == kRequests);
    CHECK(other.traffic.total().transactions == kRequests);
  }
}

// A memory, a checker of its commands, and an initiator that reads and writes at random.
class Mirrored {
 public:
  explicit Mirrored(const DramConfig& config)
      : memory(sc_core::sc_gen_unique_name("dram"), config),
        commands(memory.memspec(), CommandTraceHeader::of(config)),
        initiator(sc_core::sc_gen_unique_name("initiator"), [this](Initiator& i) { run(i); }) {
    memory.add_command_sink(commands);
    initiator.socket.bind(memory.socket);
  }
  DramController memory;
  TraceChecker commands;
  Initiator initiator;
  std::uint64_t reads = 0, wrong = 0, bytes = 0;

 private:
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }

  void run(Initiator& i) {
    std::vector<std::uint8_t> mirror(1 << 16);
    for (int k = 0; k < 600; ++k) {
      const std::uint32_t length = 1 + below(below(8) == 0 ? 3000 : 100);
      const std::uint32_t offset = below(static_cast<std::uint32_t>(mirror.size()) - length);
      const bool write = below(2) == 0;
      PooledPayload& payload =
          i.make(write ? tlm::TLM_WRITE_COMMAND : tlm::TLM_READ_COMMAND, offset, length);
      std::uint8_t* data = payload.get_data_ptr();
      for (std::uint32_t b = 0; b < length; ++b) data[b] = static_cast<std::uint8_t>(random_());
      if (write) std::copy(data, data + length, mirror.begin() + offset);
      sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
      i.blocking(payload, delay);
      bytes += length;
      reads += write ? 0 : 1;
      wrong += std::equal(data, data + length, mirror.begin() + offset) ? 0 : 1;
      payload.release();
      if (below(3) != 0) sc_core::wait(delay);  // else the next comes before the answer
      if (below(10) == 0) sc_core::wait(below(20000), sc_core::SC_NS);
    }
  }
  std::mt19937 random_{1};
};

TEST_CASE("blocking transport: bytes against a mirror, commands against the device's constraints") {
  use_femtosecond_resolution();
  std::vector<DramConfig> configs;
  for (const std::string& memspec : shipped_memspecs()) {
    for (const PagePolicyKind policy :
         {PagePolicyKind::kOpen, PagePolicyKind::kClosed, PagePolicyKind::kAdaptive}) {
      configs.emplace_back();
      configs.back().memspec = memspec;
      configs.back().page_policy = policy;
    }
  }
  configs.emplace_back();
  configs.back().refresh = RefreshMode::kAllBank;
  configs.back().ranks = 2;
  configs.emplace_back();
  configs.back().power_down_idle_cycles = 20;
  configs.back().self_refresh_idle_cycles = 300;
  std::vector<std::unique_ptr<Mirrored>> runs;
  for (const DramConfig& config : configs) runs.push_back(std::make_unique<Mirrored>(config));
  sc_core::sc_start();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    INFO(configs[i].memspec << ", run " << i);
    CHECK(runs[i]->initiator.finished);
    CHECK(runs[i]->reads > 200);
    CHECK(runs[i]->wrong == 0);
    CHECK(runs[i]->memory.stats().bytes() == runs[i]->bytes);
    if (runs[i]->commands.first()) FAIL(runs[i]->commands.first()->text());
    CHECK(runs[i]->commands.checked() > 600);
  }
}

}  // namespace
}  // namespace sgs
