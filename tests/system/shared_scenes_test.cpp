// Every view of the small scenes.
#include "tests/system/shared_scenes.h"

#include <catch2/catch.hpp>

namespace sgs::test {
namespace {

TEST_CASE("shared scenes: truck, paper order") {
  check_shared_scene("truck", "paper_no_vq", {kStalled});
}
TEST_CASE("shared scenes: truck, exact order") { check_shared_scene("truck", "exact", {kStalled}); }
TEST_CASE("shared scenes: playbot, paper order") {
  check_shared_scene("playbot", "paper_no_vq", {kStalled});
}
TEST_CASE("shared scenes: playbot, exact order") {
  check_shared_scene("playbot", "exact", {kStalled});
}

}  // namespace
}  // namespace sgs::test
