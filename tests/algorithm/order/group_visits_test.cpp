// Orders of small scenes.
#include "algorithm/order/group_visits.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>

#include "algorithm/render/paper_renderer.h"
#include "algorithm/scene/camera.h"
#include "algorithm/splat/activate.h"
#include "testbench/builtin/open_scene.h"
#include "tests/algorithm/order/order_checks.h"
#include "tests/algorithm/voxel/ray_walk.h"
#include "tests/algorithm/voxel/stored_clouds.h"

namespace sgs {
namespace {

using test::check_order;

TEST_CASE("paper order: every ray respected, object") {
  check_order("builtin:object?n=20000", {}, 0);
}
TEST_CASE("paper order: every ray respected, small voxels") {
  const std::string spec = "builtin:object?n=1500";
  check_order(spec, {open_scene(spec).cameras[2]}, 0.08F);
}
TEST_CASE("paper order: every ray respected, truck", "[shared]") {
  test::check_order_of_shared("truck");
}
TEST_CASE("paper order: every ray respected, playbot", "[shared]") {
  test::check_order_of_shared("playbot");
}

TEST_CASE("paper order: a camera that looks along an axis from a cell's corner") {
  const Scene scene = open_scene("builtin:object?n=5000");
  const auto [cloud, grid] = test::by_voxels(activate(scene.cloud), 0.5F);
  Camera camera;
  camera.width = camera.height = 65;  // the middle pixel's ray is parallel to the axis
  camera.focal_x = camera.focal_y = 40;
  for (const double z : {-6.0, 0.0, 0.25}) {
    camera.position = {0, -0.5, z};
    check_order(cloud, grid, camera, square_of(32));
  }
}

struct GridTable {
  const VoxelGrid& grid;
  VoxelNode node(std::uint32_t index) const { return grid.nodes[index]; }
};

// Chains of all rays of a group, one after another.
struct Chains {
  std::vector<std::vector<std::uint32_t>> of_ray;
  Chains(const View<float>& view, const PixelRect& group, const VoxelGrid& grid) {
    const GridTable nodes{grid};
    RayWalk walk(RayPath<>(grid.frame), nodes);
    for (int y = group.y0; y < group.y1; ++y) {
      for (int x = group.x0; x < group.x1; ++x) {
        std::vector<std::uint32_t>& chain = of_ray.emplace_back();
        walk.walk(pixel_ray(view, x, y), [&](std::uint32_t voxel, std::uint32_t) {
          chain.push_back(voxel);
          return true;
        });
      }
    }
  }

  // Neighbours on a ray that are visited the other way round.
  std::size_t out_of_order(const std::vector<std::uint32_t>& visited) const {
    std::map<std::uint32_t, std::size_t> place;
    for (std::size_t i = 0; i < visited.size(); ++i) place[visited[i]] = i;
    std::size_t sum = 0;
    for (const auto& chain : of_ray) {
      for (std::size_t i = 1; i < chain.size(); ++i) {
        sum += place[chain[i - 1]] >= place[chain[i]] ? 1 : 0;
      }
    }
    return sum;
  }
};

struct GridSeen {
  VoxelGrid grid;
  View<float> view;
};

GridSeen small_scene() {
  const Scene scene = open_scene("builtin:object?n=4000");
  return {test::by_voxels(activate(scene.cloud), 0.1F).table,
          make_view<float>(scaled_to(scene.cameras.front(), 96, 54))};
}

std::vector<std::uint32_t> sorted(std::vector<std::uint32_t> voxels) {
  std::sort(voxels.begin(), voxels.end());
  return voxels;
}

TEST_CASE("paper order: a table that is too small orders the same voxels in passes") {
  const auto [grid, view] = small_scene();
  for (const PixelRect& group : {PixelRect{40, 20, 56, 36}, PixelRect{48, 16, 72, 28}}) {
    OrderingTable roomy(grid.voxels.size());
    const GroupVisits whole = paper_visits(view, group, grid, {}, roomy);
    REQUIRE(whole.voxels.size() > 20);
    CHECK(whole.overflows == 0);
    const Chains chains(view, group, grid);
    for (const std::uint64_t bytes : {8, 20, 100, 300}) {
      INFO(bytes << " bytes");
      OrderingTable table(grid.voxels.size(), bytes);
      const GroupVisits passes = paper_visits(view, group, grid, {}, table);
      CHECK(passes.overflows > 0);
      CHECK(passes.table_bytes <= bytes);
      CHECK(passes.rays > whole.rays);
      CHECK(sorted(passes.voxels) == sorted(whole.voxels));  // each once
      CHECK(chains.out_of_order(passes.voxels) == 0);
    }
  }
}

TEST_CASE("paper order: rays of every so-many-th pixel, and of a group's last ones") {
  for (const std::uint32_t step : {1U, 2U, 3U, 5U, 100U}) {
    std::vector<int> at;
    for (int x = 4; x < 12; x = next_ray(x, 12, step)) at.push_back(x);
    INFO(step);
    CHECK(at.front() == 4);
    CHECK(at.back() == 11);
    CHECK(at.size() == 1 + (7 + step - 1) / step);
    for (std::size_t i = 1; i + 1 < at.size(); ++i) {
      CHECK(at[i] - at[i - 1] == static_cast<int>(step));
    }
  }
  const auto [grid, view] = small_scene();
  const PixelRect group{32, 0, 96, 54};
  OrderingTable table(grid.voxels.size());
  const GroupVisits all = paper_visits(view, group, grid, {}, table);
  const GroupVisits fewer = paper_visits(view, group, grid, {2, 0}, table);
  CHECK(all.rays == 64 * 54);
  CHECK(fewer.rays == 33 * 28);
  CHECK(fewer.voxels.size() <= all.voxels.size());
  CHECK(fewer.voxels.size() > all.voxels.size() / 2);
}

TEST_CASE("paper order: rays side by side meet the same voxels, in an order of every ray") {
  const auto [grid, view] = small_scene();
  const PixelRect group{32, 16, 64, 40};
  OrderingTable table(grid.voxels.size());
  const GroupVisits in_turn = paper_visits(view, group, grid, {}, table);
  const Chains chains(view, group, grid);
  for (const std::uint32_t side_by_side : {2U, 48U, 5000U}) {
    INFO(side_by_side);
    const GroupVisits visits = paper_visits(view, group, grid, {1, 0, side_by_side}, table);
    CHECK(visits.rays == in_turn.rays);
    CHECK(visits.steps == in_turn.steps);
    CHECK(visits.edges_offered == in_turn.edges_offered);
    CHECK(visits.table_bytes == in_turn.table_bytes);
    CHECK(chains.out_of_order(visits.voxels) == 0);
    CHECK(sorted(visits.voxels) == sorted(in_turn.voxels));
  }
}

}  // namespace
}  // namespace sgs
