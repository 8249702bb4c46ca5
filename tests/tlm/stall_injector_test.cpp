// Random stalls of FIFOs.
#include "tlm/stall_injector.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace sgs {
namespace {

TEST_CASE("stall injector: as often and as long as it is told") {
  StallInjector stalls({0.25, 10, 1}, "here");
  int stalled = 0;
  std::uint32_t longest = 0;
  for (int i = 0; i < 100000; ++i) {
    const std::uint32_t cycles = stalls.draw();
    stalled += cycles > 0 ? 1 : 0;
    longest = std::max(longest, cycles);
  }
  CHECK(stalled > 24500);  // 25000, sigma 137
  CHECK(stalled < 25500);
  CHECK(longest == 10);
  StallInjector never({0, 10, 1}, "here");
  for (int i = 0; i < 1000; ++i) CHECK(never.draw() == 0);
}

TEST_CASE("stall injector: each place has a sequence of its own, the same in every run") {
  const auto draws = [](std::uint64_t seed, const std::string& place) {
    StallInjector stalls({0.5, 100, seed}, place);
    std::vector<std::uint32_t> out;
    for (int i = 0; i < 50; ++i) out.push_back(stalls.draw());
    return out;
  };
  CHECK(draws(1, "top.fifo.writer") == draws(1, "top.fifo.writer"));
  CHECK(draws(1, "top.fifo.writer") != draws(1, "top.fifo.reader"));
  CHECK(draws(1, "top.fifo.writer") != draws(2, "top.fifo.writer"));
}

}  // namespace
}  // namespace sgs
