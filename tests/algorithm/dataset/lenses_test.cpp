// Photographs through lenses: made those of a pinhole, or refused by name. The lenses are written
// here as the formulas have them, and inverted by Newton's method.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

#include "algorithm/dataset/dataset.h"
#include "tests/algorithm/dataset/damaged_datasets.h"
#include "tests/algorithm/dataset/made_datasets.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using namespace sgs::test;
using Catch::Matchers::Contains;

namespace {

using Distort = std::function<glm::dvec2(const glm::dvec2&)>;

Distort radial(const std::function<double(double)>& factor_of_r2) {
  return [=](const glm::dvec2& at) { return at * factor_of_r2(glm::dot(at, at)); };
}

Distort by_angle(const std::function<double(double)>& of_angle) {
  return [=](const glm::dvec2& at) {
    const double r = glm::length(at);
    return r == 0 ? at : at * (of_angle(std::atan(r)) / r);
  };
}

Distort tangential(double p1, double p2) {
  return [=](const glm::dvec2& p) {
    const double r2 = glm::dot(p, p);
    return glm::dvec2(2 * p1 * p.x * p.y + p2 * (r2 + 2 * p.x * p.x),
                      p1 * (r2 + 2 * p.y * p.y) + 2 * p2 * p.x * p.y);
  };
}

struct LensRow {
  std::string camera;  // of cameras.txt, behind its size
  Distort distort;
  double least_seen = 0.8;
};

const std::vector<LensRow>& lenses() {
  static const std::vector<LensRow> kRows = {
      {"SIMPLE_RADIAL 60 32 24 -0.12", radial([](double r2) { return 1 - 0.12 * r2; })},
      {"SIMPLE_RADIAL 60 32 24 0.15", radial([](double r2) { return 1 + 0.15 * r2; }), 0.7},
      {"RADIAL 60 32 24 -0.2 0.05",
       radial([](double r2) { return 1 - 0.2 * r2 + 0.05 * r2 * r2; })},
      {"OPENCV 60 60 32 24 -0.1 0.02 0.01 -0.02",
       [](const glm::dvec2& p) {
         return radial([](double r2) { return 1 - 0.1 * r2 + 0.02 * r2 * r2; })(p) +
                tangential(0.01, -0.02)(p);
       }},
      {"FULL_OPENCV 60 60 32 24 0.2 -0.1 0.01 0.005 0.03 0.4 0.02 -0.01",
       [](const glm::dvec2& p) {
         return radial([](double r2) {
                  return (1 + 0.2 * r2 - 0.1 * r2 * r2 + 0.03 * r2 * r2 * r2) /
                         (1 + 0.4 * r2 + 0.02 * r2 * r2 - 0.01 * r2 * r2 * r2);
                })(p) +
                tangential(0.01, 0.005)(p);
       }},
      {"FOV 60 60 32 24 0.8",
       [](const glm::dvec2& p) {
         const double r = glm::length(p);
         return r == 0 ? p * (2 * std::tan(0.4) / 0.8)
                       : p * (std::atan(2 * r * std::tan(0.4)) / (0.8 * r));
       }},
      {"SIMPLE_DIVISION 60 32 24 -0.1",
       radial([](double r2) { return 2 / (1 + std::sqrt(1 + 0.4 * r2)); })},
      {"OPENCV_FISHEYE 60 60 32 24 0.05 -0.02 0.01 -0.005", by_angle([](double a) {
         return a + 0.05 * std::pow(a, 3) - 0.02 * std::pow(a, 5) + 0.01 * std::pow(a, 7) -
                0.005 * std::pow(a, 9);
       })},
      {"SIMPLE_RADIAL_FISHEYE 60 32 24 0.1",
       by_angle([](double a) { return a + 0.1 * std::pow(a, 3); })},
      {"RADIAL_FISHEYE 60 32 24 -0.1 0.03",
       by_angle([](double a) { return a - 0.1 * std::pow(a, 3) + 0.03 * std::pow(a, 5); })},
      {"SIMPLE_FISHEYE 60 32 24", by_angle([](double a) { return a; })}};
  return kRows;
}

// The ray that ends at `wanted`.
glm::dvec2 undistorted_ray(const Distort& distort, const glm::dvec2& wanted) {
  constexpr double kStep = 1e-6;
  glm::dvec2 at = wanted;
  for (int i = 0; i < 50; ++i) {
    const glm::dvec2 off = distort(at) - wanted;
    if (glm::length(off) < 1e-12) break;
    const glm::dvec2 by_x = (distort(at + glm::dvec2(kStep, 0)) - distort(at)) / kStep;
    const glm::dvec2 by_y = (distort(at + glm::dvec2(0, kStep)) - distort(at)) / kStep;
    at -= glm::inverse(glm::dmat2(by_x, by_y)) * off;
  }
  return at;
}

// What is seen along a ray: smooth, and nowhere the same.
glm::dvec3 colour_of(const glm::dvec2& ray) {
  return 0.5 +
         0.4 * glm::dvec3(std::sin(5 * ray.x), std::sin(4 * ray.y), std::cos(3 * (ray.x + ray.y)));
}

RgbaImage photographed(const Distort& distort) {
  RgbaImage image(64, 48);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const glm::dvec2 px(x + 0.5 - 32, y + 0.5 - 24);
      image.at(x, y) = glm::vec4(colour_of(undistorted_ray(distort, px / 60.0)), 1);
    }
  }
  return image;
}

// A COLMAP folder of 10 such photographs.
void write_photographed(const std::string& folder, const LensRow& lens) {
  write_colmap_text(folder, made_scene());
  write_file(folder, "sparse/0/cameras.txt",
             "3 " + lens.camera.substr(0, lens.camera.find(' ')) + " 64 48" +
                 lens.camera.substr(lens.camera.find(' ')) + "\n");
  const std::string png = rgba_png(photographed(lens.distort));
  for (int i = 0; i < 10; ++i) write_file(folder, fmt::format("images/shot_{:02}.png", i), png);
}

// Half an 8-bit step, and what lies between two pixels of these colours.
constexpr double kBound = 0.005;

void check_pinhole(const DatasetView& view) {
  const RgbaImage image = load_view(view);
  REQUIRE(image.width == view.camera.width);
  REQUIRE(image.height == view.camera.height);
  double worst = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const glm::dvec2 ray(x + 0.5 - 0.5 * image.width, y + 0.5 - 0.5 * image.height);
      const glm::dvec3 off = glm::dvec3(image.at(x, y)) - colour_of(ray / 60.0);
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(off[c]));
    }
  }
  CHECK(worst < kBound);
}

}  // namespace

TEST_CASE("lenses: every model's photographs are made a pinhole's, to a step of 255") {
  for (const LensRow& lens : lenses()) {
    INFO(lens.camera);
    const ScratchFolder scratch;
    write_photographed(scratch.path(""), lens);
    const Dataset dataset = open_dataset(scratch.path(""));
    const DatasetView& view = dataset.views[4];
    CHECK(view.camera.focal_x == 60);
    CHECK(view.camera.focal_y == 60);
    CHECK(view.camera.width % 2 == 0);
    CHECK(view.camera.principal_offset == glm::dvec2(0));
    check_pinhole(view);
    // Pixels of the file whose rays are in the picture.
    int seen = 0;
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 64; ++x) {
        const glm::dvec2 ray =
            undistorted_ray(lens.distort, glm::dvec2(x + 0.5 - 32, y + 0.5 - 24) / 60.0);
        seen += std::abs(ray.x) * 120 <= view.camera.width &&
                std::abs(ray.y) * 120 <= view.camera.height;
      }
    }
    CHECK(view.seen == Approx(seen / (64.0 * 48)).margin(0.03));
    CHECK(view.seen > lens.least_seen);
    REQUIRE(dataset.notes.size() == 1);
    CHECK(dataset.notes[0].first == "undistorted");
    CHECK(dataset.notes[0].second.find("10 views (" + view.taken.lens.model + "), ") == 0);
    CHECK_THAT(dataset.notes[0].second, Contains(" % of their pixels are lost"));
  }
}

TEST_CASE("lenses: SIMPLE_RADIAL undistorts to the pixels of the set without distortion") {
  const LensRow& lens = lenses()[0];
  const ScratchFolder with, without;
  write_photographed(with.path(""), lens);
  write_photographed(without.path(""),
                     {"SIMPLE_PINHOLE 60 32 24", [](const glm::dvec2& at) { return at; }});
  const Dataset distorted = open_dataset(with.path("")), plain = open_dataset(without.path(""));
  CHECK(plain.notes.empty());
  for (std::size_t i = 0; i < plain.views.size(); ++i) {
    const RgbaImage a = load_view(distorted.views[i]), b = load_view(plain.views[i]);
    const int left = (a.width - b.width) / 2, top = (a.height - b.height) / 2;
    double worst = 0;
    int compared = 0;
    for (int y = std::max(0, top); y < std::min(a.height, b.height + top); ++y) {
      for (int x = std::max(0, left); x < std::min(a.width, b.width + left); ++x) {
        const glm::vec4 off = a.at(x, y) - b.at(x - left, y - top);
        for (int c = 0; c < 4; ++c) worst = std::max(worst, std::abs(static_cast<double>(off[c])));
        ++compared;
      }
    }
    CHECK(worst < kBound);
    CHECK(compared > 0.9 * 64 * 48);
  }
}

TEST_CASE("lenses: smaller photographs, and a principal point beside the middle, as well") {
  const LensRow& lens = lenses()[0];
  const ScratchFolder scratch;
  write_photographed(scratch.path(""), lens);
  // A model made at thrice the size.
  write_file(scratch.path(""), "sparse/0/cameras.txt", "3 SIMPLE_RADIAL 192 144 180 96 72 -0.12\n");
  check_pinhole(open_dataset(scratch.path("")).views[0]);
  const Dataset half = open_dataset(scratch.path(""), {2, "", ""});
  const RgbaImage image = load_view(half.views[0]);
  CHECK(image.width == half.views[0].camera.width);
  CHECK(half.views[0].camera.focal_x == Approx(60.0 * image.width / half.views[0].used_px.x));
  // The same rays in a file that has lost its left eight columns.
  RgbaImage cut(56, 48);
  const RgbaImage whole = photographed(lens.distort);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 56; ++x) cut.at(x, y) = whole.at(x + 8, y);
  }
  for (int i = 0; i < 10; ++i) {
    write_file(scratch.path(""), fmt::format("images/shot_{:02}.png", i), rgba_png(cut));
  }
  write_file(scratch.path(""), "sparse/0/cameras.txt", "3 SIMPLE_RADIAL 56 48 60 24 24 -0.12\n");
  check_pinhole(open_dataset(scratch.path("")).views[0]);
}

TEST_CASE("lenses: without distortion every model is a pinhole, to the bit") {
  const ScratchFolder plain_set;
  write_colmap_text(plain_set.path(""), made_scene());
  const Dataset plain = open_dataset(plain_set.path(""));
  for (const char* camera :
       {"PINHOLE 64 48 60 60 32 24", "SIMPLE_RADIAL 64 48 60 32 24 0", "RADIAL 64 48 60 32 24 0 0",
        "OPENCV 64 48 60 60 32 24 0 0 0 0.0", "FULL_OPENCV 64 48 60 60 32 24 0 0 0 0 0 0 0 0",
        "FOV 64 48 60 60 32 24 0", "DIVISION 64 48 60 60 32 24 0"}) {
    INFO(camera);
    const ScratchFolder scratch;
    write_colmap_text(scratch.path(""), made_scene());
    // Cameras that no image has refuse nothing, whatever they are.
    write_file(scratch.path(""), "sparse/0/cameras.txt",
               fmt::format("1 EQUIRECTANGULAR 64 48 64 48\n3 {}\n4 MADE_UP 0 0 1 two\n"
                           "5 SIMPLE_RADIAL 0 48 0 0 0 9\n6 OPENCV_FISHEYE 64 48 0 0 0 0 0 0 0 0\n",
                           camera));
    const Dataset dataset = open_dataset(scratch.path(""));
    CHECK(dataset.notes.empty());
    REQUIRE(dataset.views.size() == plain.views.size());
    for (std::size_t i = 0; i < plain.views.size(); ++i) {
      CHECK(dataset.views[i].camera.focal_x == plain.views[i].camera.focal_x);
      CHECK(dataset.views[i].camera.position == plain.views[i].camera.position);
      CHECK(load_view(dataset.views[i]).pixels == load_view(plain.views[i]).pixels);
    }
  }
}

namespace {

// transforms.json with `keys` in place of its camera_model and coefficients.
Damage with_keys(const std::string& keys) {
  return [=](const std::string& folder) {
    replace("transforms.json", "\"camera_model\": \"OPENCV\", ", keys)(folder);
    replace("transforms.json", " \"k1\": 0.0, \"p1\": 0,", "")(folder);
  };
}

Dataset transforms_with(const ScratchFolder& scratch, const std::string& keys) {
  write_transforms(scratch.path(""), made_scene());
  with_keys(keys)(scratch.path(""));
  return open_dataset(scratch.path(""));
}

}  // namespace

TEST_CASE("lenses of transforms.json: coefficients by themselves or as a list, and fisheyes") {
  struct Row {
    const char* keys;
    LensKind kind;
    std::array<double, 6> k;
    double p1, p2;
  };
  const auto kPlain = LensKind::kPerspective, kFisheye = LensKind::kFisheye;
  for (const Row& row :
       {Row{R"("k1": 0.1, "k2": -0.05, "p1": 0.001, "p2": 0.002,)",
            kPlain,
            {0.1, -0.05},
            1e-3,
            2e-3},
        Row{R"("distortion_params": [0.1, -0.05, 0.01, 0, 0.001, 0.002],)",
            kPlain,
            {0.1, -0.05, 0.01},
            1e-3,
            2e-3},
        Row{R"("camera_model": "SIMPLE_RADIAL", "k1": 0.1,)", kPlain, {0.1}, 0, 0},
        Row{R"("camera_model": "FULL_OPENCV", "k1": 0.1, "k4": 0.02, "k6": 0.01,)",
            kPlain,
            {0.1, 0, 0, 0.02, 0, 0.01},
            0,
            0},
        Row{R"("is_fisheye": true, "k1": 0.02, "k4": 0.01,)", kFisheye, {0.02, 0, 0, 0.01}, 0, 0},
        Row{R"("is_fisheye": true, "camera_model": "OPENCV",)", kFisheye, {}, 0, 0},
        Row{R"("camera_model": "OPENCV_FISHEYE", "distortion_params": [0.02, 0, 0, 0.01],)",
            kFisheye,
            {0.02, 0, 0, 0.01},
            0,
            0},
        Row{R"("is_fisheye": false, "rolling_shutter": [0, 0, 0], "sk_x": 0, "latlong": false,)",
            kPlain,
            {},
            0,
            0}}) {
    INFO(row.keys);
    const ScratchFolder scratch;
    const Dataset dataset = transforms_with(scratch, row.keys);
    const Lens& lens = dataset.views[0].taken.lens;
    CHECK(lens.kind == row.kind);
    CHECK(lens.k == row.k);
    CHECK(lens.p1 == row.p1);
    CHECK(lens.p2 == row.p2);
    CHECK(dataset.notes.empty() == is_pinhole(lens));
  }
  // A frame's own list stands before what is said of all.
  const ScratchFolder scratch;
  write_transforms(scratch.path(""), made_scene());
  with_keys("\"distortion_params\": [0, 0, 0, 0, 0, 0], ")(scratch.path(""));
  replace("transforms.json", "{\"file_path\"",
          "{\"distortion_params\": [-0.1, 0, 0, 0, 0, 0], \"file_path\"")(scratch.path(""));
  const Dataset dataset = open_dataset(scratch.path(""));
  CHECK_FALSE(is_pinhole(dataset.views[0].taken.lens));
  CHECK(is_pinhole(dataset.views[1].taken.lens));
  CHECK_THAT(dataset.notes[0].second, Contains("1 views (OPENCV)"));
}

TEST_CASE("lenses: a fisheye of 180 degrees is seen to 120") {
  const ScratchFolder scratch;
  write_photographed(scratch.path(""), {"SIMPLE_FISHEYE 20 32 24", by_angle([](double a) {
                                          return 3 * a;  // a third of the focal length of 60
                                        })});
  const Dataset dataset = open_dataset(scratch.path(""));
  const DatasetView& view = dataset.views[0];
  // Its sides are farther out than 60 degrees, which 34.6 px of a pinhole are.
  CHECK(view.camera.width == 68);
  CHECK(view.camera.height == 68);
  CHECK(view.camera.focal_x == 20);
  CHECK_THAT(dataset.notes[0].second, Contains("at most 120 degrees are seen"));
}

TEST_CASE("dataset refuses: cameras that are neither pinhole nor fisheye, by name") {
  check_refused({
      {write_colmap_text,
       replace("sparse/0/cameras.txt", "SIMPLE_PINHOLE", "MADE_UP"),
       {"images.txt: line 2: got the camera model MADE_UP, expected a pinhole, OPENCV"}},
      {write_colmap_text,
       with("sparse/0/cameras.txt", "3 EQUIRECTANGULAR 64 48 64 48\n"),
       {"images.txt: line 2: got the camera model EQUIRECTANGULAR"}},
      {write_colmap_text,
       with("sparse/0/cameras.txt", "3 THIN_PRISM_FISHEYE 64 48 60 60 32 24 0 0 0 0 0 0 0 0\n"),
       {"got the camera model THIN_PRISM_FISHEYE"}},
      {write_colmap_text,
       with("sparse/0/cameras.txt", "3 SIMPLE_RADIAL 64 48 60 320 24 0.1\n"),
       {"images.txt: line 2: the lens SIMPLE_RADIAL leaves no pixel of 64x48"}},
      {write_transforms,
       with_keys("\"camera_model\": \"EQUIRECTANGULAR\", "),
       {"transforms.json: frame 0: got the camera model EQUIRECTANGULAR"}},
      {write_transforms,
       with_keys("\"camera_model\": \"FISHEYE624\", "),
       {"frame 0: got the camera model FISHEYE624"}},
      {write_transforms,
       with_keys("\"equirectangular\": true, "),
       {"frame 0: equirectangular: got true, expected a pinhole or a fisheye"}},
      {write_transforms, with_keys("\"latlong\": true, "), {"frame 0: latlong: got true"}},
      {write_transforms, with_keys("\"ftheta_p0\": 0.1, "), {"frame 0: ftheta_p0: got 0.1"}},
      {write_transforms, with_keys("\"sk_x\": 0.5, "), {"frame 0: sk_x: got 0.5, expected 0"}},
      {write_transforms, with_keys("\"skew\": 0.5, "), {"frame 0: skew: got 0.5, expected 0"}},
      {write_transforms,
       with_keys("\"rolling_shutter\": [0, 0, 0.5], "),
       {"frame 0: rolling_shutter[2]: got 0.5, expected 0"}},
      {write_transforms,
       with_keys("\"k4\": 0.5, "),
       {"frame 0: k4: got 0.5, expected 0: but of FULL_OPENCV"}},
      {write_transforms,
       with_keys("\"is_fisheye\": true, \"p1\": 0.5, "),
       {"frame 0: p1: got 0.5, expected 0: a fisheye has k1 to k4"}},
      {write_transforms,
       with_keys("\"distortion_params\": [1, 2], "),
       {"frame 0: distortion_params: got 2 numbers, expected k1"}},
      {write_transforms,
       with_keys("\"distortion_params\": [0.1, 0, 0, 0, 0, 0], \"k1\": 0.2, "),
       {"frame 0: k1: got 0.2, expected it as distortion_params has it"}},
      {write_transforms,
       with_keys("\"is_fisheye\": 1, "),
       {"frame 0: is_fisheye: got 1, expected true or false"}},
      {write_transforms, with_keys("\"k1\": \"x\", "), {"frame 0: k1: got \"x\""}},
  });
}
