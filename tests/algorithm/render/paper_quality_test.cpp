// Paper order's loss on the small scenes.
#include "tests/algorithm/render/paper_quality.h"

#include <catch2/catch.hpp>

namespace sgs {
namespace {

TEST_CASE("paper quality: truck") {
  test::check_paper_quality({"truck", 0.4F, {36.3, 38.5}, {34.52, 37.61}, 793, 168});
}
TEST_CASE("paper quality: playbot") {
  test::check_paper_quality({"playbot", 0.4F, {30.8, 43.7}, {30.7, 43.4}, 1143, 106});
}

}  // namespace
}  // namespace sgs
