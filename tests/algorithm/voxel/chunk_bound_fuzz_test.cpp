// The test of a chunk against a pixel group, by brute force on many random scenes.
#include <catch2/catch.hpp>

#include "tests/algorithm/voxel/chunk_bound_checks.h"

TEST_CASE("chunk test misses nothing: long", "[nightly]") {
  sgs::test::fuzz_chunk_bounds(1'000'000, 300'000);
}
