// Every view of the large scenes, and what the small ones leave out.
#include <catch2/catch.hpp>

#include "tests/system/shared_scenes.h"

namespace sgs::test {
namespace {

TEST_CASE("shared scenes: truck, paper order, no stalls") {
  check_shared_scene("truck", "paper", {kAccurate, kFast});
}
TEST_CASE("shared scenes: truck, exact order, no stalls") {
  check_shared_scene("truck", "exact", {kAccurate, kFast});
}
TEST_CASE("shared scenes: playbot, paper order, no stalls") {
  check_shared_scene("playbot", "paper", {kAccurate, kFast});
}
TEST_CASE("shared scenes: playbot, exact order, no stalls") {
  check_shared_scene("playbot", "exact", {kAccurate, kFast});
}
TEST_CASE("shared scenes: platform, paper order") {
  check_shared_scene("platform", "paper", {kAccurate, kFast, kStalled});
}
TEST_CASE("shared scenes: platform, exact order") {
  check_shared_scene("platform", "exact", {kAccurate, kFast, kStalled});
}
TEST_CASE("shared scenes: yard, paper order") {
  check_shared_scene("yard", "paper", {kAccurate, kFast, kStalled});
}
TEST_CASE("shared scenes: yard, exact order") {
  check_shared_scene("yard", "exact", {kAccurate, kFast, kStalled});
}
TEST_CASE("shared scenes: garden, paper order") {
  check_shared_scene("garden", "paper", {kAccurate, kFast, kStalled});
}
TEST_CASE("shared scenes: garden, exact order") {
  check_shared_scene("garden", "exact", {kAccurate, kFast, kStalled});
}
TEST_CASE("shared scenes: park, paper order") {
  check_shared_scene("park", "paper", {kAccurate, kFast, kStalled});
}
TEST_CASE("shared scenes: park, exact order") {
  check_shared_scene("park", "exact", {kAccurate, kFast, kStalled});
}

}  // namespace
}  // namespace sgs::test
