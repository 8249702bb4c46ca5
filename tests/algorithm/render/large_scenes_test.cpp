// The reference renderer on the large real scenes, against double precision and golden pictures,
// and on the built-in scenes of full size, against double precision.
#include <catch2/catch.hpp>

#include "testbench/builtin/builtin_scene.h"
#include "tests/algorithm/render/real_scene.h"

using namespace sgs::test;

TEST_CASE("platform: float against double", "[nightly]") { check_scene_against_double("platform"); }
TEST_CASE("platform: golden pictures", "[nightly]") { check_scene_against_golden("platform"); }
TEST_CASE("yard: float against double", "[nightly]") { check_scene_against_double("yard"); }
TEST_CASE("yard: golden pictures", "[nightly]") { check_scene_against_golden("yard"); }
TEST_CASE("garden: float against double", "[nightly]") { check_scene_against_double("garden"); }
TEST_CASE("garden: golden pictures", "[nightly]") { check_scene_against_golden("garden"); }
TEST_CASE("park: float against double", "[nightly]") { check_scene_against_double("park"); }
TEST_CASE("park: golden pictures", "[nightly]") { check_scene_against_golden("park"); }

TEST_CASE("built-in scenes: float against double", "[nightly]") {
  for (const std::string name : {"object", "outdoor"}) {
    const auto scene = sgs::make_builtin_scene("builtin:" + name);
    for (const auto& camera : scene.cameras) check_against_double(name, camera, scene.cloud);
  }
}
