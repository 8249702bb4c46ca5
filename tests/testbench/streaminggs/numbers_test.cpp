// numbers.h: what a person reads never promises more than was measured.
#include "testbench/streaminggs/report/numbers.h"

#include <catch2/catch.hpp>
#include <string>

namespace sgs::test {
namespace {

TEST_CASE("numbers: frame rates are rounded down") {
  CHECK(rate_in_words(89.649) == "89.6");
  CHECK(rate_in_words(89.96) == "89.9");
  CHECK(rate_in_words(99.99) == "99.9");
  CHECK(rate_in_words(1 / (1.0 / 90)) == "90.0");
  CHECK(rate_in_words(1 / (1 / 89.7)) == "89.7");
  CHECK(rate_in_words(100) == "100");
  CHECK(rate_in_words(1234.9) == "1,234");
}

}  // namespace
}  // namespace sgs::test
