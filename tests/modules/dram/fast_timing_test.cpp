// Fast timing beside accurate timing: the same streams through a MemoryPort.
#include <catch2/catch.hpp>
#include <memory>
#include <vector>

#include "modules/dram/dram_controller.h"
#include "tlm/memory_port.h"
#include "tlm/time_resolution.h"

namespace sgs {
namespace {

enum class Stream { kSequentialReads, kRandomReads, kSequentialWrites };

class Reader : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Reader);
  Reader(const sc_core::sc_module_name& name, TimingMode timing, PayloadPool& pool, Stream stream)
      : sc_module(name), port("port", {0, 256, 16, timing}, pool), stream_(stream) {
    SC_THREAD(run);
  }
  MemoryPort port;
  double took_ns = 0;

 private:
  void run() {
    std::uint64_t state = 1;
    for (std::uint32_t i = 0; i < 4000; ++i) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      if (stream_ == Stream::kSequentialReads) port.read(std::uint64_t{i} * 256, data_, 256, 0);
      if (stream_ == Stream::kRandomReads) port.read((state >> 34) & ~31ull, data_, 32, 0);
      if (stream_ == Stream::kSequentialWrites) port.write(std::uint64_t{i} * 256, data_, 256, 0);
    }
    port.wait_all();
    took_ns = sc_core::sc_time_stamp() / sc_core::sc_time(1, sc_core::SC_NS);
  }
  const Stream stream_;
  std::uint8_t data_[256];
};

TEST_CASE("fast timing: sequential streams within 5 % of accurate timing, random ones slower") {
  use_femtosecond_resolution();
  DramConfig config;
  config.posted_writes = false;  // fast timing answers a write when it is written
  PayloadPool pool;
  std::vector<std::unique_ptr<DramController>> memories;
  std::vector<std::unique_ptr<Reader>> readers;
  for (const Stream stream :
       {Stream::kSequentialReads, Stream::kRandomReads, Stream::kSequentialWrites})
    for (const TimingMode timing : {TimingMode::kAccurate, TimingMode::kFast}) {
      memories.push_back(
          std::make_unique<DramController>(sc_core::sc_gen_unique_name("dram"), config));
      readers.push_back(
          std::make_unique<Reader>(sc_core::sc_gen_unique_name("reader"), timing, pool, stream));
      readers.back()->port.socket.bind(memories.back()->socket);
    }
  sc_core::sc_start();
  for (std::size_t i = 0; i < readers.size(); i += 2) {
    INFO("stream " << i / 2);
    CHECK(readers[i]->took_ns > 1000);
    const double ratio = readers[i + 1]->took_ns / readers[i]->took_ns;
    const bool random = i / 2 == 1;
    // In order of arrival a bank conflict holds up the columns behind it, which queues let pass.
    CHECK(ratio > 0.95);
    CHECK(ratio < (random ? 1.4 : 1.05));
    const DramStats accurate = memories[i]->stats();
    const DramStats fast = memories[i + 1]->stats();
    CHECK(accurate.bytes() == fast.bytes());
    CHECK(accurate.bus_bytes() == fast.bus_bytes());
  }
}

}  // namespace
}  // namespace sgs
