// Exact order through the whole accelerator: every view of the real scenes under pressure, and many
// random scenes.
#include <catch2/catch.hpp>

#include "tests/system/exact_order_checks.h"

using namespace sgs::test;

TEST_CASE("exact under pressure: truck", "[nightly]") { check_exact_under_pressure("truck"); }
TEST_CASE("exact under pressure: playbot", "[nightly]") { check_exact_under_pressure("playbot"); }
TEST_CASE("exact under pressure: platform", "[nightly]") { check_exact_under_pressure("platform"); }
TEST_CASE("exact under pressure: yard", "[nightly]") { check_exact_under_pressure("yard"); }
TEST_CASE("exact under pressure: garden", "[nightly]") { check_exact_under_pressure("garden"); }
TEST_CASE("exact under pressure: park", "[nightly]") { check_exact_under_pressure("park"); }
TEST_CASE("exact under pressure: many hard scenes", "[nightly]") { fuzz_exact_frames(1000, 800); }
