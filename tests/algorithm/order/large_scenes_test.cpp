// Orders of large scenes.
#include <catch2/catch.hpp>

#include "tests/algorithm/order/order_checks.h"

namespace sgs {
namespace {

using test::check_order_of_shared;

TEST_CASE("paper order: every ray respected, outdoor", "[nightly]") {
  test::check_order("builtin:outdoor?n=200000", {}, 0);
}
TEST_CASE("paper order: every ray respected, platform", "[nightly]") {
  check_order_of_shared("platform");
}
TEST_CASE("paper order: every ray respected, yard", "[nightly]") { check_order_of_shared("yard"); }
TEST_CASE("paper order: every ray respected, garden", "[nightly]") {
  check_order_of_shared("garden");
}
TEST_CASE("paper order: every ray respected, park", "[nightly]") { check_order_of_shared("park"); }

}  // namespace
}  // namespace sgs
