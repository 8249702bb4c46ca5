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

}  // namespace
}  // namespace sgs::test
