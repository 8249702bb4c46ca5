// Real photographs: do their cameras see what the pictures show? Each test would fail with an axis
// turned over, and says so by trying.
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <optional>

#include "algorithm/dataset/dataset.h"
#include "tests/support/shared_inputs.h"

using namespace sgs;

namespace {

// The same camera with axes turned over; signs of x, y, z.
Camera turned(Camera camera, const glm::dvec3& signs) {
  for (int axis = 0; axis < 3; ++axis) camera.world_from_camera[axis] *= signs[axis];
  return camera;
}

// The pixel that has `point`, where there is one.
std::optional<glm::ivec2> pixel_in_view(const Camera& camera, const glm::dvec3& point) {
  const glm::dvec3 v = glm::transpose(camera.world_from_camera) * (point - camera.position);
  if (v.z <= 0) return {};
  const double x = camera.focal_x * v.x / v.z + 0.5 * camera.width;
  const double y = camera.focal_y * v.y / v.z + 0.5 * camera.height;
  if (!(x >= 0 && y >= 0 && x < camera.width && y < camera.height)) return {};
  return glm::ivec2(static_cast<int>(x), static_cast<int>(y));
}

const std::vector<glm::dvec3> kTurns = {
    {1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {-1, 1, 1}, {1, -1, 1}};

// Share of all points in all pictures where the pixel's colour is near the point's. Not all of
// them: things stand before each other.
double share_of_equal_colours(const Dataset& dataset, const std::vector<RgbaImage>& images,
                              const glm::dvec3& signs) {
  constexpr float kNear = 0.1f;
  std::size_t equal = 0;
  for (std::size_t i = 0; i < dataset.views.size(); ++i) {
    const Camera camera = turned(dataset.views[i].camera, signs);
    for (const SfmPoint& point : dataset.points) {
      const auto at = pixel_in_view(camera, glm::dvec3(point.position));
      equal += at && glm::length(glm::vec3(images[i].at(at->x, at->y)) - point.colour) < kNear;
    }
  }
  return static_cast<double>(equal) /
         static_cast<double>(dataset.views.size() * dataset.points.size());
}

constexpr double kShrink = 8;

// Lattice points of a cube about the origin that are inside of the object in every view of `split`.
std::vector<glm::dvec3> visual_hull(const Dataset& dataset, const std::vector<RgbaImage>& images,
                                    Split split, const glm::dvec3& signs) {
  constexpr int kSide = 64;
  constexpr double kHalf = 1.5;  // world units
  std::vector<glm::dvec3> hull;
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const glm::dvec3 cell(i % kSide, i / kSide % kSide, i / (kSide * kSide));
    hull.push_back(((cell + 0.5) / static_cast<double>(kSide) * 2.0 - 1.0) * kHalf);
  }
  for (const int number : views_of(dataset, split)) {
    const auto view = static_cast<std::size_t>(number);
    const Camera camera = turned(downscaled_camera(dataset.views[view], kShrink), signs);
    const auto outside = [&](const glm::dvec3& point) {
      const auto at = pixel_in_view(camera, point);
      return !at || images[view].at(at->x, at->y).w == 0;
    };
    hull.erase(std::remove_if(hull.begin(), hull.end(), outside), hull.end());
  }
  return hull;
}

// How well the hull of the training views fills the object in the test views: pixels of both over
// pixels of either.
double overlap(const Dataset& dataset, const std::vector<RgbaImage>& images,
               const glm::dvec3& signs) {
  const std::vector<glm::dvec3> hull = visual_hull(dataset, images, Split::kTrain, signs);
  std::size_t both = 0, either = 0;
  for (const int number : views_of(dataset, Split::kTest)) {
    const auto view = static_cast<std::size_t>(number);
    const RgbaImage& image = images[view];
    const Camera camera = turned(downscaled_camera(dataset.views[view], kShrink), signs);
    std::vector<bool> seen(image.pixels.size());
    for (const glm::dvec3& point : hull) {
      if (const auto at = pixel_in_view(camera, point)) {
        seen[static_cast<std::size_t>(at->y) * image.width + at->x] = true;
      }
    }
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const bool object = image.pixels[i].w > 0;
      both += object && seen[i];
      either += object || seen[i];
    }
  }
  return static_cast<double>(both) / static_cast<double>(either);
}

}  // namespace

TEST_CASE("shared data sets: desk is what COLMAP says of it", "[shared]") {
  const Dataset desk = open_dataset(test::shared_path("data/desk"));
  CHECK(desk.layout == "COLMAP");
  CHECK(desk.views.size() == 29);
  CHECK(views_of(desk, Split::kTest) == std::vector<int>{0, 8, 16, 24});
  for (const DatasetView& view : desk.views) {
    CHECK(view.camera.width == 635);
    CHECK(view.camera.height == 356);
    // The file's focal lengths, at 1906x1070 px.
    CHECK(view.camera.focal_x == Approx(1510.8499978366908 * 635 / 1906));
    CHECK(view.camera.focal_y == Approx(1501.5404827038178 * 356 / 1070));
    CHECK_FALSE(view.file.has_alpha);
  }
}

TEST_CASE("shared data sets: desk's points have the colours of the pixels where they are seen",
          "[shared]") {
  const Dataset desk = open_dataset(test::shared_path("data/desk"));
  std::vector<RgbaImage> images;
  for (const DatasetView& view : desk.views) images.push_back(load_view(view));
  REQUIRE(desk.points.size() > 1000);
  const double right = share_of_equal_colours(desk, images, {1, 1, 1});
  CHECK(right > 0.3);  // the rest is hidden, or finer than a pixel of these pictures
  for (const glm::dvec3& signs : kTurns) {
    INFO(signs.x << " " << signs.y << " " << signs.z);
    CHECK(share_of_equal_colours(desk, images, signs) < right / 3);
  }
}

TEST_CASE("shared data sets: what all of lego's training views hold fills its test views",
          "[shared]") {
  const Dataset lego = open_dataset(test::shared_path("data/lego"));
  CHECK(lego.layout == "NeRF synthetic");
  CHECK(views_of(lego, Split::kTrain).size() == 100);
  CHECK(views_of(lego, Split::kTest).size() == 50);
  CHECK(lego.points.empty());
  std::vector<RgbaImage> images;
  for (const DatasetView& view : lego.views) {
    CHECK(view.file.has_alpha);
    images.push_back(load_view(view, kShrink));
    // The object stands at the origin.
    const auto origin = pixel_in_view(view.camera, glm::dvec3(0));
    REQUIRE(origin.has_value());
    CHECK(glm::length(glm::dvec2(*origin) - glm::dvec2(200)) < 1.5);
  }
  CHECK(overlap(lego, images, {1, 1, 1}) > 0.9);
  for (const glm::dvec3& signs : kTurns) {
    INFO(signs.x << " " << signs.y << " " << signs.z);
    CHECK(overlap(lego, images, signs) < 0.75);
  }
}
