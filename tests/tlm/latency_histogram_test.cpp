// Means and percentiles by hand: exact below 1024 cycles, then low by less than a bin.
#include <catch2/catch.hpp>
#include <utility>

#include "modules/dram/dram_stats.h"

namespace sgs::test {
namespace {

LatencyHistogram of_all(std::uint64_t first, std::uint64_t last) {
  LatencyHistogram all;
  for (std::uint64_t cycles = first; cycles <= last; ++cycles) all.add(cycles);
  return all;
}

TEST_CASE("latencies: 1 to 100 cycles") {
  const LatencyHistogram all = of_all(1, 100);
  CHECK(all.count() == 100);
  CHECK(all.mean() == 50.5);
  CHECK(all.percentile(0.5) == 50);
  CHECK(all.percentile(0.99) == 99);
  CHECK(all.percentile(1) == 100);
  CHECK(all.percentile(0) == 1);
  CHECK(all.max() == 100);
}

TEST_CASE("latencies: none") {
  const LatencyHistogram none;
  CHECK(none.count() == 0);
  CHECK(none.mean() == 0);
  CHECK(none.percentile(0.5) == 0);
  CHECK(none.max() == 0);
}

// The first bins of two cycles begin at 1024, those of four at 2048; the last is at 2^40.
TEST_CASE("latencies: a bin's lower edge stands for what is in it") {
  for (const auto& [cycles, edge] : {std::pair<std::uint64_t, std::uint64_t>{0, 0},
                                     {1023, 1023},
                                     {1024, 1024},
                                     {1025, 1024},
                                     {1026, 1026},
                                     {2047, 2046},
                                     {2048, 2048},
                                     {2051, 2048},
                                     {2052, 2052},
                                     {1'000'000, 999'424},
                                     {(1ULL << 40) - 1, (1ULL << 40) - (1ULL << 30)},
                                     {1ULL << 50, (1ULL << 40) - (1ULL << 30)}}) {
    CAPTURE(cycles);
    LatencyHistogram one;
    one.add(cycles);
    CHECK(one.percentile(0.5) == edge);
    CHECK(one.max() == cycles);
    CHECK(one.mean() == static_cast<double>(cycles));
  }
}

TEST_CASE("latencies: two histograms become that of all") {
  for (const bool longer_first : {true, false}) {
    LatencyHistogram sum = longer_first ? of_all(41, 100) : of_all(1, 40);
    sum += longer_first ? of_all(1, 40) : of_all(41, 100);
    CHECK(sum.count() == 100);
    CHECK(sum.mean() == 50.5);
    CHECK(sum.percentile(0.5) == 50);
    CHECK(sum.percentile(0.99) == 99);
    CHECK(sum.max() == 100);
  }
}

}  // namespace
}  // namespace sgs::test
