// Exact order against the reference: the large real scenes and many random ones.
#include <catch2/catch.hpp>

#include "tests/algorithm/render/exact_checks.h"

using namespace sgs::test;

TEST_CASE("exact order equals the reference: platform", "[nightly]") {
  check_exact_on_shared("platform");
}
TEST_CASE("exact order equals the reference: yard", "[nightly]") { check_exact_on_shared("yard"); }
TEST_CASE("exact order equals the reference: garden", "[nightly]") {
  check_exact_on_shared("garden");
}
TEST_CASE("exact order equals the reference: park", "[nightly]") { check_exact_on_shared("park"); }
TEST_CASE("exact order equals the reference: many hard scenes", "[nightly]") {
  fuzz_exact_order(1'000'000, 20'000);
}
