// Every ray of every group walked again, its chain held against the group's order.
#include "tests/algorithm/order/order_checks.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <catch2/catch.hpp>

#include "algorithm/dataset/view_cameras.h"
#include "algorithm/order/group_visits.h"
#include "algorithm/render/group_state.h"
#include "algorithm/render/paper_renderer.h"
#include "algorithm/splat/activate.h"
#include "testbench/builtin/open_scene.h"
#include "tests/algorithm/voxel/ray_walk.h"
#include "tests/algorithm/voxel/stored_clouds.h"
#include "tests/support/shared_inputs.h"

namespace sgs::test {
namespace {

struct GridTable {
  const VoxelGrid& grid;
  VoxelNode node(std::uint32_t index) const { return grid.nodes[index]; }
};

struct Violations {
  std::uint64_t chains = 0, distances = 0, missing = 0, groups = 0, edges = 0;

  Violations& operator+=(const Violations& other) {
    chains += other.chains;
    distances += other.distances;
    missing += other.missing;
    groups += other.groups;
    edges += other.edges;
    return *this;
  }
};

// On a ray through a grid the cells' Manhattan distance from the camera's cell never falls: each
// crossing moves one step away along one axis. Hence an order by distance respects every ray, and
// along every edge of the graph the distance must rise.
Violations check_group(const View<float>& view, const PixelRect& group, const VoxelGrid& grid,
                       const std::vector<glm::ivec3>& cells, OrderingTable& table) {
  Violations found;
  const GroupVisits visits = paper_visits(view, group, grid, {}, table);
  std::vector<std::int32_t> place(grid.voxels.size(), -1);
  for (std::size_t i = 0; i < visits.voxels.size(); ++i) {
    found.chains += place[visits.voxels[i]] >= 0 ? 1 : 0;
    place[visits.voxels[i]] = static_cast<std::int32_t>(i);
  }
  glm::ivec3 eye;
  for (int axis = 0; axis < 3; ++axis)
    eye[axis] = cell_of(view.position[axis], grid.frame.voxel_size);
  const auto distance = [&](std::uint32_t voxel) {
    std::int64_t sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      sum += std::abs(std::int64_t{cells[voxel][axis]} - eye[axis]);
    }
    return sum;
  };
  const GridTable nodes{grid};
  RayWalk walk(RayPath<>(grid.frame), nodes);
  for (int y = group.y0; y < group.y1; ++y) {
    for (int x = group.x0; x < group.x1; ++x) {
      std::int64_t last = -1;
      walk.walk(pixel_ray(view, x, y), [&](std::uint32_t voxel, std::uint32_t) {
        found.missing += place[voxel] < 0 ? 1 : 0;
        if (last >= 0) {
          const auto before = static_cast<std::uint32_t>(last);
          ++found.edges;
          found.chains += place[before] >= place[voxel] ? 1 : 0;
          found.distances += distance(before) >= distance(voxel) ? 1 : 0;
        }
        last = voxel;
        return true;
      });
    }
  }
  found.groups = 1;
  return found;
}

}  // namespace

void check_order(const ActivatedCloud& cloud, const VoxelGrid& grid, const Camera& camera,
                 const PixelSize& group_size) {
  std::vector<glm::ivec3> cells;
  for (const VoxelRecord& record : grid.voxels) {
    const glm::vec3& mean = cloud.gaussians[record.first].mean;
    cells.emplace_back(cell_of(mean.x, grid.frame.voxel_size),
                       cell_of(mean.y, grid.frame.voxel_size),
                       cell_of(mean.z, grid.frame.voxel_size));
  }
  const View<float> view = make_view<float>(camera);
  const auto groups = pixel_groups(view.width, view.height, group_size);
  std::vector<Violations> of_group(groups.size());
  tbb::enumerable_thread_specific<OrderingTable> tables(grid.voxels.size());
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t i) {
    // order() throws where a group is cyclic.
    of_group[i] = check_group(view, groups[i], grid, cells, tables.local());
  });
  Violations found;
  for (const Violations& v : of_group) found += v;
  INFO("camera " << camera.id << ", groups of " << group_size.width << " x " << group_size.height
                 << " px, " << found.edges << " pairs on rays");
  CHECK(found.groups == groups.size());
  CHECK(found.edges > 0);
  CHECK(found.missing == 0);
  CHECK(found.chains == 0);
  CHECK(found.distances == 0);
}

void check_order(const std::string& spec, const std::vector<Camera>& cameras, float voxel_size) {
  const Scene scene = open_scene(spec);
  const ActivatedCloud in_file = activate(scene.cloud);
  if (voxel_size == 0) voxel_size = static_cast<float>(paper_voxel_size(inner_extent(in_file)));
  const auto [cloud, grid] = by_voxels(in_file, voxel_size);
  for (const Camera& camera : cameras.empty() ? scene.cameras : cameras) {
    for (const PixelSize group : {PixelSize{16, 16}, {64, 64}, {48, 12}}) {
      check_order(cloud, grid, camera, group);
    }
  }
}

void check_order_of_shared(const std::string& name) {
  check_order(shared_scene(name),
              read_view_cameras(shared_path("cameras/" + name + ".json")).cameras, 0);
}

}  // namespace sgs::test
