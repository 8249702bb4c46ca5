// The reference renderer on the small real scenes, against double precision and golden pictures.
#include <catch2/catch.hpp>

#include "tests/algorithm/render/real_scene.h"

using namespace sgs::test;

TEST_CASE("truck: float against double") { check_scene_against_double("truck"); }
TEST_CASE("truck: golden pictures") { check_scene_against_golden("truck"); }
TEST_CASE("playbot: float against double") { check_scene_against_double("playbot"); }
TEST_CASE("playbot: golden pictures") { check_scene_against_golden("playbot"); }
