// Paper order's loss on the large scenes.
#include <catch2/catch.hpp>

#include "tests/algorithm/render/paper_quality.h"

namespace sgs {
namespace {

TEST_CASE("paper quality: platform", "[nightly]") {
  test::check_paper_quality({"platform", 2.0F, {15.9, 20.8}, {15.79, 20.39}, 840, 161});
}
TEST_CASE("paper quality: yard", "[nightly]") {
  test::check_paper_quality({"yard", 2.0F, {16.0, 22.4}, {15.9, 22.5}, 3410, 215});
}
TEST_CASE("paper quality: garden", "[nightly]") {
  test::check_paper_quality({"garden", 2.0F, {24.0, 34.3}, {21.9, 33.1}, 718, 289});
}
TEST_CASE("paper quality: park", "[nightly]") {
  test::check_paper_quality({"park", 2.0F, {37.1, 41.4}, {36.02, 40.7}, 3939, 837});
}

}  // namespace
}  // namespace sgs
