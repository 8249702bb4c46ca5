// Who uses a memory port, as a test says.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <systemc>
#include <utility>
#include <vector>

#include "tlm/memory_port.h"

namespace sgs::test {

// A unit with one port, whose threads are given by the test.
class Unit : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Unit);
  Unit(const sc_core::sc_module_name& name, const MemoryPortConfig& config,
       std::vector<std::function<void(MemoryPort&)>> threads, const sc_core::sc_time& cycle = {})
      : sc_module(name), port("port", config, cycle), threads_(std::move(threads)) {
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

}  // namespace sgs::test
