// The cycles of the sorting network, against a network that is really there.
#include "modules/streaminggs/sorting/sorting_cost.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

namespace sgs {
namespace {

// A 16-wide bitonic network that counts its compare-exchange stages.
struct Network {
  std::uint64_t stages = 0, compare_exchanges = 0;

  void stage(std::vector<int>& x, std::size_t distance, std::size_t block) {
    for (std::size_t i = 0; i < kNetworkWidth; ++i) {
      const std::size_t other = i ^ distance;
      if (other < i) continue;
      ++compare_exchanges;
      const bool ascending = (i & block) == 0;
      if ((x[i] > x[other]) == ascending) std::swap(x[i], x[other]);
    }
    ++stages;
  }
  void sort(std::vector<int>& x) {
    for (std::size_t block = 2; block <= kNetworkWidth; block *= 2) {
      for (std::size_t distance = block / 2; distance > 0; distance /= 2) stage(x, distance, block);
    }
  }
  // Two sorted halves.
  void merge(std::vector<int>& x) {
    std::reverse(x.begin() + kMergeWidth, x.end());
    for (std::size_t distance = kMergeWidth; distance > 0; distance /= 2) {
      stage(x, distance, 2 * kNetworkWidth);
    }
  }
};

TEST_CASE("sorting cost: a block of 16 takes ten stages of eight, a merge four") {
  std::mt19937 random(1);
  for (int repeat = 0; repeat < 100; ++repeat) {
    std::vector<int> x(kNetworkWidth);
    for (int& value : x) value = static_cast<int>(random() % 20);
    std::vector<int> expected = x;
    std::sort(expected.begin(), expected.end());
    Network network;
    network.sort(x);
    CHECK(x == expected);
    CHECK(network.stages == kSortStages);
    CHECK(network.compare_exchanges == kSortStages * kMergeWidth);

    std::sort(x.begin(), x.begin() + kMergeWidth);
    for (int& value : x) value = static_cast<int>(random() % 20);
    std::sort(x.begin(), x.begin() + kMergeWidth);
    std::sort(x.begin() + kMergeWidth, x.end());
    expected = x;
    std::sort(expected.begin(), expected.end());
    Network merger;
    merger.merge(x);
    CHECK(x == expected);
    CHECK(merger.stages == kMergeStages);
    CHECK(merger.compare_exchanges == kMergeStages * kMergeWidth);
  }
}

TEST_CASE("sorting cost: by hand, with the defaults") {
  // Latency 12, a block a cycle, a merge every 2 cycles, every 4 where there is one pair of runs.
  const SortingNetworkConfig config;
  const auto cycles = [&](std::uint64_t n) { return sort_cost(config, n).cycles; };
  CHECK(cycles(0) == 0);
  CHECK(cycles(1) == 0);
  CHECK(cycles(2) == 12);
  CHECK(cycles(16) == 12);
  // Two blocks, one level of three merges of eight; the last takes 6 cycles until it is written.
  CHECK(cycles(17) == 12 + 1 + 2 * 4 + 6);
  CHECK(cycles(32) == 12 + 1 + 3 * 4 + 6);
  // Three blocks, two levels of one pair: 4 merges, beside them the third block; then 5.
  CHECK(cycles(33) == 12 + 2 + (3 * 4 + 6) + (4 * 4 + 6));
  CHECK(cycles(64) == 12 + 3 + (7 * 2 + 6) + (7 * 4 + 6));
  // Another list before each turn.
  CHECK(sort_cost(config, 64, 2).cycles == 12 + 7 + 2 * (15 * 2 + 6));
  CHECK(sort_cost(config, 16).compare_exchanges == 80);
  CHECK(sort_cost(config, 32).compare_exchanges == 2 * 80 + 4 * 32);
}

TEST_CASE("sorting cost: a trivial list costs only when nothing is skipped") {
  SortingNetworkConfig config;
  config.skip_trivial = false;
  CHECK(sort_cost(config, 0).cycles == 0);
  CHECK(sort_cost(config, 1).cycles == 12);
  CHECK(sort_cost(config, 1).compare_exchanges == 80);
}

// Merges of one pair of runs, each begun in a turn of the network when what the last one of the
// pair gave back is there.
TEST_CASE("sorting cost: no merge begins before the one that it waits for has ended") {
  for (const std::uint32_t interval : {1U, 2U, 3U, 5U}) {
    SortingNetworkConfig config;
    config.merge_interval_cycles = interval;
    for (const std::uint64_t pairs : {1U, 2U, 3U, 4U, 8U}) {
      constexpr std::uint64_t kRounds = 50;
      std::vector<std::uint64_t> done(pairs, 0);
      std::uint64_t network = 0;
      for (std::uint64_t merge = 0; merge < kRounds * pairs; ++merge) {
        std::uint64_t begin = network;
        while (begin < done[merge % pairs]) begin += interval;
        network = begin + interval;
        done[merge % pairs] = begin + kMergeStages;
      }
      const std::uint64_t level =
          merge_tree_cycles(config, 2 * pairs) - merge_tree_cycles(config, pairs);
      const double of_a_merge = static_cast<double>(network) / static_cast<double>(kRounds * pairs);
      INFO(interval << " cycles, " << pairs << " pairs");
      CHECK(static_cast<double>(level) >= of_a_merge - 0.5 * kMergeStages / kRounds);
      CHECK(static_cast<double>(level) < of_a_merge + 1);
    }
  }
}

TEST_CASE("sorting cost: levels of a merge tree") {
  CHECK(merge_levels(0) == 0);
  CHECK(merge_levels(1) == 0);
  CHECK(merge_levels(2) == 1);
  CHECK(merge_levels(3) == 2);
  CHECK(merge_levels(4) == 2);
  CHECK(merge_levels(5) == 3);
  CHECK(merge_levels(8) == 3);
}

}  // namespace
}  // namespace sgs
