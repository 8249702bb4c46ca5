// Orders of small scenes.
#include "algorithm/order/group_visits.h"

#include <catch2/catch.hpp>

#include "algorithm/splat/activate.h"
#include "testbench/builtin/open_scene.h"
#include "tests/algorithm/order/order_checks.h"
#include "tests/algorithm/voxel/stored_clouds.h"

namespace sgs {
namespace {

using test::check_order;

TEST_CASE("paper order: every ray respected, object") {
  check_order("builtin:object?n=20000", {}, 0);
}
TEST_CASE("paper order: every ray respected, small voxels") {
  check_order("builtin:object?n=1500", {}, 0.08F);
}
TEST_CASE("paper order: every ray respected, truck") { test::check_order_of_shared("truck"); }
TEST_CASE("paper order: every ray respected, playbot") { test::check_order_of_shared("playbot"); }

TEST_CASE("paper order: a camera that looks along an axis from a cell's corner") {
  const Scene scene = open_scene("builtin:object?n=5000");
  const auto [cloud, grid] = test::by_voxels(activate(scene.cloud), 0.5F);
  Camera camera;
  camera.width = camera.height = 65;  // the middle pixel's ray is parallel to the axis
  camera.focal_x = camera.focal_y = 40;
  for (const double z : {-6.0, 0.0, 0.25}) {
    camera.position = {0, -0.5, z};
    check_order(cloud, grid, camera, 32);
  }
}

}  // namespace
}  // namespace sgs
