// Threads of a test, each a function.
#pragma once

#include <functional>
#include <systemc>
#include <vector>

namespace sgs::test {

class Threads : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Threads);
  explicit Threads(std::vector<std::function<void()>> bodies)
      : sc_module(sc_core::sc_module_name("threads")), bodies_(std::move(bodies)) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) SC_THREAD(run);
  }

  // Simulates until nothing happens any more; whether all have returned.
  bool run_all() {
    sc_core::sc_start();
    return returned_ == bodies_.size();
  }

 private:
  void run() {
    const std::size_t mine = started_++;
    bodies_[mine]();
    ++returned_;
  }
  std::vector<std::function<void()>> bodies_;
  std::size_t started_ = 0, returned_ = 0;
};

}  // namespace sgs::test
