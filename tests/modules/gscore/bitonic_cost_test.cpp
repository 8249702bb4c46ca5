// The cycles of the bitonic sorting unit, against one that is stepped cycle by cycle.
#include "modules/gscore/sorting/bitonic_cost.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "algorithm/memory/tile_records.h"
#include "tests/modules/gscore/stepped_bitonic.h"

namespace sgs::test {
namespace {

using gscore::bitonic_cost;
using gscore::BitonicCost;

// Depths from few different ones to many, as keys; the place breaks ties.
std::vector<std::uint64_t> list_of(std::mt19937& random, std::size_t entries, NumberFormat keys) {
  constexpr std::uint32_t kDepths[] = {1, 2, 20, 100000};
  const std::uint32_t depths = kDepths[random() % 4];
  std::vector<std::uint64_t> list(entries);
  for (std::size_t place = 0; place < entries; ++place) {
    const auto depth = 0.2F + 0.001F * static_cast<float>(random() % depths);
    list[place] = std::uint64_t{depth_key(keys, depth)} << 32 | place;
  }
  constexpr std::uint32_t kInOrder = 5;
  if (random() % kInOrder == 0) std::sort(list.begin(), list.end());
  if (random() % kInOrder == 0) std::sort(list.rbegin(), list.rend());
  return list;
}

void check(std::mt19937& random, std::size_t entries, NumberFormat keys) {
  INFO(entries << " entries");
  const std::vector<std::uint64_t> list = list_of(random, entries, keys);
  std::vector<std::uint64_t> expected = list;
  std::sort(expected.begin(), expected.end());
  SteppedBitonic unit(list);
  CHECK(unit.run() == expected);
  const BitonicCost cost = bitonic_cost(entries);
  CHECK(unit.cycles() == cost.cycles);
  CHECK(unit.compare_exchanges() == cost.compare_exchanges);
  CHECK(unit.merged() == cost.merged);
  CHECK(unit.most_at_a_port() == 1);
}

TEST_CASE("bitonic cost: as a unit that is stepped through, for lists of every length") {
  std::mt19937 random(1);
  for (std::size_t entries = 2; entries <= 1024; ++entries) {
    check(random, entries, NumberFormat::kHalf);
    if (entries % 7 == 0) check(random, entries, NumberFormat::kSingle);
  }
}

TEST_CASE("bitonic cost: by hand") {
  CHECK(bitonic_cost(0).cycles == 0);
  CHECK(bitonic_cost(1).cycles == 0);
  // Read, ten stages, written.
  CHECK(bitonic_cost(2).cycles == 12);
  CHECK(bitonic_cost(16).cycles == 12);
  CHECK(bitonic_cost(16).compare_exchanges == 80);
  // Four turns, one every four cycles; the last is read, passes four stages, is written.
  CHECK(bitonic_cost(32).cycles == 13 + 3 * 4 + 6);
  CHECK(bitonic_cost(32).compare_exchanges == 2 * 80 + 3 * 32);
  // A whole pair and a run alone, then a pair of unequal ones.
  CHECK(bitonic_cost(48).cycles == 14 + (3 * 4 + 6) + (5 * 4 + 6));
  CHECK(bitonic_cost(48).merged == 2 * 48);
  // 256: eight pairs in two rounds of four, four pairs, two, one.
  CHECK(bitonic_cost(256).cycles ==
        27 + (7 * 4 + 3 + 6) + (7 * 4 + 3 + 6) + (15 * 4 + 1 + 6) + (31 * 4 + 6));
}

}  // namespace
}  // namespace sgs::test
