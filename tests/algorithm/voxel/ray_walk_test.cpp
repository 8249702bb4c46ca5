// The hierarchical walk and the sampling against stepping from cell to cell.
#include "tests/algorithm/voxel/ray_walk.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>
#include <string>

#include "algorithm/files/input_error.h"
#include "algorithm/voxel/cell_samples.h"
#include "algorithm/voxel/ray_path.h"
#include "algorithm/voxel/ray_sampling.h"
#include "algorithm/voxel/renaming_table.h"
#include "tests/algorithm/voxel/cell_stepper.h"
#include "tests/algorithm/voxel/stored_clouds.h"
#include "tests/support/uniform.h"

namespace sgs {
namespace {

using test::OccupiedCells;
using test::uniform;

struct GridTable {
  const VoxelGrid& grid;
  VoxelNode node(std::uint32_t index) const { return grid.nodes[index]; }
};

ActivatedCloud cloud_of(const std::vector<glm::vec3>& means) {
  ActivatedCloud cloud;
  for (const glm::vec3& mean : means) {
    cloud.gaussians.push_back({mean, glm::vec3(0.1F), {1, 0, 0, 0}, 0.9F});
    cloud.sh_coeffs.emplace_back(0.0F);
  }
  return cloud;
}

Ray ray_from(const glm::vec3& origin, const glm::vec3& direction) {
  Ray ray{};
  ray.origin = origin;
  ray.direction = direction;
  for (int axis = 0; axis < 3; ++axis) {
    const float d = direction[axis];
    ray.step[axis] = d > 0 ? 1 : (d < 0 ? -1 : 0);
    ray.inverse[axis] = d == 0 ? 0.0F : 1.0F / d;
  }
  return ray;
}

template <class Tracer>
std::vector<std::uint32_t> traced(Tracer& tracer, const Ray& ray) {
  std::vector<std::uint32_t> met;
  std::uint32_t last = 0;
  tracer.walk(ray, [&](std::uint32_t voxel, std::uint32_t cells) {
    CHECK((met.empty() || cells > last));
    last = cells;
    met.push_back(voxel);
    return true;
  });
  return met;
}

glm::vec3 in_cube(std::mt19937& random, float half_side) {
  glm::vec3 out;
  for (int axis = 0; axis < 3; ++axis) out[axis] = uniform(random, -half_side, half_side);
  return out;
}

// What is drawn for one ray: some parallel to axes or to diagonals, some from a cell's corner, edge
// or face.
Ray random_ray(std::mt19937& random, float half_side, float voxel_size, const glm::vec3& centre) {
  glm::vec3 origin = in_cube(random, half_side * (random() % 2 == 0 ? 0.5F : 3.0F)) + centre;
  for (int axis = 0; axis < 3; ++axis) {
    if (random() % 3 == 0) origin[axis] = voxel_size * std::round(origin[axis] / voxel_size);
  }
  glm::vec3 direction = in_cube(random, 0.5F * half_side) + centre - origin;
  const unsigned kind = random() % 4;
  for (int axis = 0; axis < 3 && kind > 0; ++axis) {
    if (kind == 1 && random() % 2 == 0) direction[axis] = 0;
    if (kind == 2) direction[axis] = direction[axis] > 0 ? 1.0F : -1.0F;  // along diagonals
    if (kind == 3 && random() % 2 == 0) direction[axis] *= 1e-6F;
  }
  return ray_from(origin, direction);
}

void compare_with_stepping(unsigned seed, float half_side, float voxel_size,
                           const glm::vec3& centre, std::size_t points, int rays) {
  std::mt19937 random(seed);
  std::vector<glm::vec3> means;
  for (std::size_t i = 0; i < points; ++i) means.push_back(in_cube(random, half_side) + centre);
  const auto [cloud, grid] = test::by_voxels(cloud_of(means), voxel_size);
  const OccupiedCells cells(cloud, grid);
  REQUIRE(cells.count() == grid.voxels.size());
  const GridTable table{grid};
  RayWalk walk(RayPath<>(grid.frame), table);
  std::size_t met = 0;
  for (int i = 0; i < rays; ++i) {
    const Ray ray = random_ray(random, half_side, voxel_size, centre);
    const std::vector<std::uint32_t> expected = cells.walk(ray);
    const std::vector<std::uint32_t> got = traced(walk, ray);
    INFO("ray " << i << " from " << ray.origin.x << " " << ray.origin.y << " " << ray.origin.z
                << " along " << ray.direction.x << " " << ray.direction.y << " "
                << ray.direction.z);
    REQUIRE(got == expected);
    met += got.size();
  }
  CHECK(met > 0);
}

constexpr std::uint32_t kNoVoxelThere = ~0U;

// What the renaming table says of a cell.
std::uint32_t voxel_at(const RenamingTable& table, const glm::ivec3& cell) {
  const std::uint64_t vid = table.numbers.of(cell);
  for (std::uint32_t at = table.look_up.first(vid);; at = table.look_up.behind(at)) {
    const Renamed renamed = table.look_up.read(vid, table.lines[at]);
    if (renamed.what == Renamed::What::kVoxel) return renamed.voxel;
    if (renamed.what == Renamed::What::kEmpty) return kNoVoxelThere;
  }
}

// The voxels of a ray's samples by the numbers of their cells.
std::vector<std::uint32_t> by_number(const VoxelGrid& grid, const SampleSpace& space,
                                     const Ray& ray) {
  const RenamingTable table = renaming_table(grid, RenamingForm::kHashed);
  std::vector<std::uint32_t> out;
  CellSamples<> samples(space);
  samples.begin(ray.direction);
  for (; !samples.done(); samples.next()) {
    glm::ivec3 cell;
    if (!samples.find_cell(cell)) continue;
    const std::uint32_t voxel = voxel_at(table, cell);
    if (voxel == kNoVoxelThere || (!out.empty() && out.back() == voxel)) continue;
    out.push_back(voxel);
  }
  return out;
}

TEST_CASE("ray walk: the same cells as stepping, dense and sparse grids") {
  for (unsigned seed = 0; seed < 20; ++seed) {
    compare_with_stepping(seed, 2.0F, 0.5F, {}, 400, 400);
    compare_with_stepping(seed, 10.0F, 0.3F, {}, 60, 400);
    compare_with_stepping(seed, 40.0F, 0.4F, {}, 2000, 100);
  }
}

TEST_CASE("ray walk: coordinates of a million") {
  for (unsigned seed = 0; seed < 10; ++seed) {
    compare_with_stepping(seed, 20.0F, 0.5F, {1e6F, -1e6F, 5e5F}, 500, 300);
  }
}

TEST_CASE("ray walk: empty space is crossed in few steps") {
  // Two voxels a hundred thousand cells apart.
  const ActivatedCloud cloud = cloud_of({{0.5F, 0.5F, 0.5F}, {100000.5F, 0.5F, 0.5F}});
  const VoxelGrid grid = arrange_by_voxels(cloud, 1.0F).table;
  const GridTable table{grid};
  RayWalk walk(RayPath<>(grid.frame), table);
  std::vector<std::uint32_t> met;
  const std::uint32_t steps =
      walk.walk(ray_from({-1, 0.5F, 0.5F}, {1, 0, 0}), [&](std::uint32_t voxel, std::uint32_t) {
        met.push_back(voxel);
        return true;
      });
  CHECK(met == std::vector<std::uint32_t>{0, 1});
  // At most three empty siblings on each of the levels on the way up and on the way down.
  CHECK(steps <= static_cast<std::uint32_t>(10 * grid.frame.levels));
}

TEST_CASE("cell samples: with fine steps what the walk finds, and the renaming table the same") {
  std::mt19937 random(5);
  std::vector<glm::vec3> means;
  for (int i = 0; i < 500; ++i) means.push_back(in_cube(random, 10));
  const ActivatedCloud cloud = cloud_of(means);
  const VoxelGrid grid = arrange_by_voxels(cloud, 1.0F).table;
  const GridTable table{grid};
  const glm::ivec3 cells = occupied_cells(grid);
  RayWalk walk(RayPath<>(grid.frame), table);
  std::size_t exact = 0, by_coarse = 0, by_fine = 0;
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 origin = in_cube(random, 20);
    const Ray ray = ray_from(origin, in_cube(random, 8) - origin);
    const auto all = traced(walk, ray);
    exact += all.size();
    for (const float step : {0.5F, 0.01F}) {
      const SampleSpace space = sample_space(origin, grid.frame, cells, step, 0);
      RayWalk sampling(CellSamplePath(grid.frame, space), table);
      const auto some = traced(sampling, ray);
      (step == 0.5F ? by_coarse : by_fine) += some.size();
      // A subsequence.
      auto at = all.begin();
      for (const std::uint32_t voxel : some) {
        at = std::find(at, all.end(), voxel);
        REQUIRE(at != all.end());
      }
      CHECK(by_number(grid, space, ray) == some);
    }
  }
  CHECK(100 * by_fine >= 98 * exact);
  CHECK(10 * by_coarse >= 7 * exact);
  CHECK(by_coarse < by_fine);
}

TEST_CASE("cell samples: the distance from the eye's cell rises from cell to cell") {
  std::mt19937 random(6);
  const VoxelFrame frame{0.7F, glm::ivec3(-20), 3};
  for (int i = 0; i < 300; ++i) {
    const glm::vec3 eye = in_cube(random, i % 2 == 0 ? 30.0F : 3.0F);
    glm::vec3 direction = in_cube(random, 1);
    if (i % 5 == 0) direction[i % 3] = 0;
    CellSamples<> samples(sample_space(eye, frame, {50, 40, 30}, 0.37F, 0));
    samples.begin(direction);
    glm::ivec3 before(-1);
    std::uint32_t last = 0;
    for (; !samples.done(); samples.next()) {
      glm::ivec3 cell;
      if (!samples.find_cell(cell) || cell == before) continue;
      const std::uint32_t distance = samples.cells_from_eye(cell);
      CHECK((before.x < 0 || distance > last));
      before = cell;
      last = distance;
    }
  }
  CellSamples<> none(sample_space({0, 0, 0}, frame, {50, 40, 30}, 0.5F, 0));
  none.begin({0, 0, 0});
  CHECK(none.done());
  // A sample whose number is too large to count on would be taken for ever.
  CHECK_NOTHROW(sample_space({0, 0, 0}, frame, {50, 40, 30}, 1e-5F, 0));
  for (const auto& [eye, step] : {std::pair(0.0F, 1e-6F), std::pair(1e7F, 0.5F)}) {
    CHECK_THROWS_AS(sample_space({eye, 0, 0}, frame, {50, 40, 30}, step, 0), InputError);
  }
}

TEST_CASE("cell samples: a ray ends at a distance, or with the box") {
  const VoxelFrame frame{2, glm::ivec3(0), 3};
  const auto count = [&](float far_voxels) {
    CellSamples<> samples(sample_space({1, 1, 1}, frame, {50, 40, 30}, 0.5F, far_voxels));
    samples.begin({0, 3, 0});
    std::uint64_t samples_taken = 0;
    for (; !samples.done(); samples.next()) ++samples_taken;
    return samples_taken;
  };
  // The eye lies half a voxel within the box; there is a sample at the eye.
  CHECK(count(0) == 80);
  CHECK(count(10) == 21);
  CHECK(count(10.4F) == 21);
  CHECK(count(10.5F) == 22);
  CHECK(count(1000) == 80);
}

TEST_CASE("renaming table: every voxel and no empty cell, in either form") {
  std::mt19937 random(8);
  std::vector<glm::vec3> means;
  for (int i = 0; i < 3000; ++i) means.push_back(in_cube(random, 12));
  const VoxelGrid grid = arrange_by_voxels(cloud_of(means), 1.0F).table;
  const glm::ivec3 cells = occupied_cells(grid);
  std::vector<std::uint32_t> of_form[2];
  for (const RenamingForm form : {RenamingForm::kHashed, RenamingForm::kDense}) {
    const RenamingTable table = renaming_table(grid, form);
    std::vector<std::uint32_t>& found = of_form[form == RenamingForm::kDense ? 1 : 0];
    for (int z = 0; z < cells.z; ++z) {
      for (int y = 0; y < cells.y; ++y) {
        for (int x = 0; x < cells.x; ++x) found.push_back(voxel_at(table, {x, y, z}));
      }
    }
    std::set<std::uint32_t> voxels(found.begin(), found.end());
    voxels.erase(kNoVoxelThere);
    CHECK(voxels.size() == grid.voxels.size());
    CHECK(*voxels.rbegin() == grid.voxels.size() - 1);
  }
  CHECK(of_form[0] == of_form[1]);
}

TEST_CASE("renaming table: a box with too many cells is refused by its form") {
  const ActivatedCloud cloud = cloud_of({{0.5F, 0.5F, 0.5F}, {300.5F, 300.5F, 300.5F}});
  const VoxelGrid grid = arrange_by_voxels(cloud, 1.0F).table;  // 9 bits an axis
  CHECK(renaming_table(grid, RenamingForm::kHashed).lines.size() == 1);
  CHECK_THROWS_WITH(renaming_table(grid, RenamingForm::kDense),
                    Catch::Contains("27 bits, expected at most 24, or hashed"));
  const VoxelGrid fine = arrange_by_voxels(cloud, 0.001F).table;
  CHECK_THROWS_WITH(renaming_table(fine, RenamingForm::kHashed),
                    Catch::Contains("57 bits, expected at most 44"));
}

}  // namespace
}  // namespace sgs
