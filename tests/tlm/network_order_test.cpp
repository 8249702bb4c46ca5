// A small network of units, built in one order and in the other: every time must be the same.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "modules/dram/dram_controller.h"
#include "tlm/fifo_selector.h"
#include "tlm/instant_end.h"
#include "tlm/memory_access.h"
#include "tlm/router.h"
#include "tlm/time_resolution.h"
#include "tlm/timed_fifo.h"

namespace sgs {
namespace {

constexpr std::uint32_t kProducers = 5;
constexpr std::uint64_t kItems = 300;

using Log = std::vector<std::string>;

// Reads from memory, all of them the same banks, and hands on what it has read.
class Producer : public sc_core::sc_module {
 public:
  FifoOut<std::uint64_t> out{"out"};
  MemoryPort memory;
  SC_HAS_PROCESS(Producer);
  Producer(const sc_core::sc_module_name& name, const ClockDomain& clock, std::uint32_t number)
      : sc_module(name),
        memory("memory", MemoryPortConfig{256, 4}),
        number_(number),
        work_("work", clock) {
    SC_THREAD(run);
  }

 private:
  void run() {
    for (std::uint64_t k = 0; k < kItems; ++k) {
      std::uint8_t into[64];
      const std::uint64_t address = (k * 37 + number_ * 11) % 512 * 64;
      await(memory, work_, start_read(memory, work_, address, into, 64, 0));
      // In step with the others now and then.
      if (k % 7 == 0) work_.work(20 - work_.clock().now_cycles() % 20);
      out->push(k * kProducers + number_, work_);
    }
  }
  const std::uint32_t number_;
  Activity work_;
};

// Takes from whoever has something, writes it to memory and notes when.
class Consumer : public sc_core::sc_module {
 public:
  FifoIns<std::uint64_t> in{"in"};
  MemoryPort memory;
  Log log;
  SC_HAS_PROCESS(Consumer);
  Consumer(const sc_core::sc_module_name& name, const ClockDomain& clock)
      : sc_module(name), memory("memory", MemoryPortConfig{256, 4}), take_("take", clock) {
    SC_THREAD(run);
  }

 private:
  void run() {
    FifoSelector<std::uint64_t> inputs(in);
    for (std::uint64_t left = kProducers * kItems; left > 0; --left) {
      const int from = inputs.select(take_, [](int) { return true; });
      const std::uint64_t item = in[from]->pop(take_);
      start_write(memory, take_, 64 * (item % 512), &item, sizeof item, 1);
      log.push_back(fmt::format("{} at cycle {}", item, take_.clock().now_cycles()));
    }
    await_all(memory, take_);
    log.push_back(fmt::format("end at {}", sc_core::sc_time_stamp().to_string()));
  }
  Activity take_;
};

// Units, FIFOs and sockets are bound alike; units are made in the order that is given.
class Network : public sc_core::sc_module {
 public:
  Network(const sc_core::sc_module_name& name, InstantEnd& instant_end, std::uint64_t order)
      : sc_module(name), router_("router", instant_end, kProducers + 1), dram("dram", config()) {
    std::vector<std::function<void()>> makers;
    for (std::uint32_t p = 0; p < kProducers; ++p) {
      makers.push_back([=] {
        producers_[p] = std::make_unique<Producer>(fmt::format("producer{}", p).c_str(), clock_, p);
      });
      makers.push_back([=] {
        fifos_[p] = std::make_unique<TimedFifo<std::uint64_t>>(fmt::format("fifo{}", p).c_str(),
                                                               clock_, 2, 1);
      });
    }
    makers.push_back([=] { consumer = std::make_unique<Consumer>("consumer", clock_); });
    if (order == 1) std::reverse(makers.begin(), makers.end());
    if (order > 1) std::shuffle(makers.begin(), makers.end(), std::mt19937_64(order));
    for (const auto& make : makers) make();
    for (std::uint32_t p = 0; p < kProducers; ++p) {
      producers_[p]->out(*fifos_[p]);
      consumer->in(*fifos_[p]);
      producers_[p]->memory.socket.bind(router_.from_initiators[p]);
    }
    consumer->memory.socket.bind(router_.from_initiators[kProducers]);
    router_.map(0, dram.capacity_bytes(), dram.socket);
  }

  std::unique_ptr<Consumer> consumer;

 private:
  static DramConfig config() {
    DramConfig config;
    config.channels = 1;
    config.read_queue_entries = 3;
    return config;
  }
  const ClockDomain clock_{1000};
  Router router_;
  std::unique_ptr<Producer> producers_[kProducers];
  std::unique_ptr<TimedFifo<std::uint64_t>> fifos_[kProducers];

 public:
  DramController dram;
};

TEST_CASE("network: the order in which units are made shows in no time") {
  use_femtosecond_resolution();
  InstantEnd instant_end("instant_end");
  std::vector<std::unique_ptr<Network>> networks;
  for (std::uint64_t order = 0; order < 6; ++order) {
    networks.push_back(
        std::make_unique<Network>(fmt::format("net{}", order).c_str(), instant_end, order));
  }
  sc_core::sc_start();
  const Log& first = networks[0]->consumer->log;
  CHECK(first.size() == kProducers * kItems + 1);
  for (std::size_t order = 1; order < networks.size(); ++order) {
    INFO("order " << order);
    const Log& log = networks[order]->consumer->log;
    const auto differs = std::mismatch(first.begin(), first.end(), log.begin(), log.end());
    INFO("expected " << (differs.first == first.end() ? "no more" : *differs.first));
    INFO("got " << (differs.second == log.end() ? "no more" : *differs.second));
    CHECK(log == first);
    CHECK(networks[order]->dram.stats().bus_bytes() == networks[0]->dram.stats().bus_bytes());
    CHECK(networks[order]->dram.stats().row_hit_rate() == networks[0]->dram.stats().row_hit_rate());
  }
}

}  // namespace
}  // namespace sgs
