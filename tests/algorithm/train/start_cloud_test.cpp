// What training begins with, and where it is looked for.
#include "algorithm/train/start_cloud.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "algorithm/splat/spherical_harmonics.h"
#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

TEST_CASE("start: distances to the three nearest") {
  std::vector<glm::vec3> grid;
  for (int i = 0; i < 125; ++i) {
    grid.emplace_back(0.5F * static_cast<float>(i % 5), 0.5F * static_cast<float>(i / 5 % 5),
                      0.5F * static_cast<float>(i / 25));
  }
  for (const float distance : neighbour_distances(grid)) CHECK(distance == Approx(0.5));
  CHECK(neighbour_distances({}).empty());
  CHECK(neighbour_distances({{1, 2, 3}}) == std::vector<float>{0});
  const auto two = neighbour_distances({{0, 0, 0}, {0, 3, 4}});
  CHECK(two[0] == Approx(5));
}

TEST_CASE("start: a Gaussian for each point, as large as they lie apart") {
  std::vector<SfmPoint> points;
  for (int i = 0; i < 8; ++i) {
    points.push_back({{i % 2, i / 2 % 2, i / 4}, {0.125F * static_cast<float>(i), 0.5F, 1}});
  }
  const GaussianCloud cloud = start_at_points(points, 100, {}, 1);
  REQUIRE(cloud.size() == 8);
  CHECK(cloud.sh_degree == 0);
  for (std::size_t i = 0; i < 8; ++i) {
    CHECK(cloud.means[i] == points[i].position);
    CHECK(std::exp(cloud.log_scales[i].x) == Approx(0.5));
    CHECK(cloud.opacity_logits[i] == Approx(0).margin(1e-6));
    const glm::vec3 rgb = sh_colour(0, &cloud.sh_coeffs[i], glm::vec3(0, 0, 1));
    CHECK(glm::distance(rgb, points[i].colour) < 1e-6F);
  }
}

TEST_CASE("start: points of the data set, random ones where it brings none, no three") {
  Dataset dataset;
  dataset.folder = "set";
  dataset.layout = "COLMAP";
  dataset.bounds = Extent{{-1, -1, -1}, {1, 1, 1}};
  CHECK(points_to_start_at(dataset, 7, 1).size() == 7);
  for (int count = 1; count <= 5; ++count) {
    dataset.points.push_back({{count, 0, 0}, {1, 0, 0}});
    INFO(count);
    if (count < 4) {
      CHECK_THAT(input_error_of([&] { points_to_start_at(dataset, 7, 1); }),
                 Catch::Matchers::Contains(fmt::format("set: got {} points to begin with", count)));
    } else {
      CHECK(points_to_start_at(dataset, 7, 1).size() == static_cast<std::size_t>(count));
    }
  }
}

TEST_CASE("start: no more than there is room for, drawn by the seed") {
  const Extent box{{-1, 0, 2}, {1, 3, 2.5F}};
  const auto points = random_points(box, 500, 3);
  for (const SfmPoint& point : points) {
    for (int axis = 0; axis < 3; ++axis) {
      REQUIRE(point.position[axis] >= box.min[axis]);
      REQUIRE(point.position[axis] <= box.max[axis]);
    }
  }
  const GaussianCloud a = start_at_points(points, 50, {}, 1),
                      b = start_at_points(points, 50, {}, 1);
  REQUIRE(a.size() == 50);
  CHECK(a.means == b.means);
  CHECK(a.means != start_at_points(points, 50, {}, 2).means);
}

TEST_CASE("start: points at one place have a size all the same") {
  const GaussianCloud cloud = start_at_points(std::vector<SfmPoint>(5), 5, {}, 1);
  for (const glm::vec3& scale : cloud.log_scales) CHECK(std::isfinite(scale.x));
}

Dataset looking_at(const glm::dvec3& middle, double distance) {
  Dataset dataset;
  for (int i = 0; i < 12; ++i) {
    DatasetView view;
    const double turn = 0.5 * i, rise = 0.1 * i;
    const glm::dvec3 z = -glm::normalize(glm::dvec3(std::cos(turn), std::sin(turn), rise));
    const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(0, 0, 1)));
    view.camera.world_from_camera = glm::dmat3(x, glm::cross(z, x), z);
    view.camera.position = middle - distance * z;
    dataset.views.push_back(view);
  }
  return dataset;
}

TEST_CASE("start: the box is around what the cameras look at, or the one that is stated") {
  Dataset dataset = looking_at({1, -2, 3}, 6);
  const Extent box = box_to_fill(dataset);
  CHECK(glm::distance(0.5F * (box.min + box.max), glm::vec3(1, -2, 3)) < 1e-5F);
  CHECK(box.max.x - box.min.x == Approx(4));
  dataset.bounds = Extent{{0, 0, 0}, {1, 2, 3}};
  CHECK(box_to_fill(dataset).max == glm::vec3(1, 2, 3));
}

TEST_CASE("start: parallel cameras have a box as well") {
  Dataset dataset;
  dataset.views.resize(3);
  for (std::size_t i = 0; i < 3; ++i) dataset.views[i].camera.position = {double(i), 0, 0};
  const Extent box = box_to_fill(dataset);
  for (int axis = 0; axis < 3; ++axis) CHECK(std::isfinite(box.max[axis]));
}

}  // namespace
}  // namespace sgs::test
