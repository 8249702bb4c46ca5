// The first of numbers that change one at a time, against a search through all of them.
#include "modules/streaminggs/vsu/first_of.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <random>
#include <vector>

namespace sgs::test {
namespace {

TEST_CASE("first of: the lowest number, of equal ones that with the lowest place") {
  std::mt19937 random(1);
  for (const std::size_t count : {1U, 2U, 3U, 16U, 102U}) {
    FirstOf first(count);
    std::vector<std::uint64_t> numbers(count, 0);
    CHECK(first.first() == 0);
    for (int change = 0; change < 500; ++change) {
      const std::size_t which = random() % count;
      numbers[which] = random() % 8 == 0 ? ~std::uint64_t{0} : random() % (2 * count);
      first.set(which, numbers[which]);
      const auto lowest = std::min_element(numbers.begin(), numbers.end());
      INFO(count << " numbers, change " << change);
      REQUIRE(first.first() == lowest - numbers.begin());
    }
  }
}

}  // namespace
}  // namespace sgs::test
