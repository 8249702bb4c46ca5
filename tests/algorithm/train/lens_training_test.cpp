// A scene trained from photographs through a lens is as good as one from those of a pinhole.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "algorithm/dataset/dataset.h"
#include "algorithm/image/image_io.h"
#include "algorithm/splat/activate.h"
#include "algorithm/train/comparison.h"
#include "algorithm/train/start_cloud.h"
#include "algorithm/train/trainer.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/shared_inputs.h"

namespace sgs::test {
namespace {

namespace fs = std::filesystem;

// desk's model is of 1906x1070 px. COLMAP's automatic reconstruction leaves SIMPLE_RADIAL.
constexpr glm::dvec2 kModelPx(1906, 1070);
constexpr double kFocalPx = 1510;

// r of r (1 + radial r^2).
double undistorted_radius(double wanted, double radial) {
  double r = wanted;
  for (int i = 0; i < 20; ++i) {
    r -= (r * (1 + radial * r * r) - wanted) / (1 + 3 * radial * r * r);
  }
  return r;
}

glm::vec4 between(const RgbaImage& image, const glm::dvec2& at) {
  const glm::ivec2 last(image.width - 1, image.height - 1);
  const glm::ivec2 a = glm::clamp(glm::ivec2(glm::floor(at)), glm::ivec2(0), last);
  const glm::ivec2 b = glm::min(a + 1, last);
  const glm::vec2 t(at - glm::dvec2(a));
  return glm::mix(glm::mix(image.at(a.x, a.y), image.at(b.x, a.y), t.x),
                  glm::mix(image.at(a.x, b.y), image.at(b.x, b.y), t.x), t.y);
}

// The photograph as that lens would have taken it, in twice its size: sharper than its pixels.
Image through_lens(const DatasetView& view, double radial) {
  const RgbaImage plain = load_view(view);
  const glm::dvec2 size(2 * plain.width, 2 * plain.height);
  const glm::dvec2 focal = kFocalPx * size / kModelPx;
  const glm::dvec2 plain_focal(view.camera.focal_x, view.camera.focal_y);
  Image out(2 * plain.width, 2 * plain.height);
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      const glm::dvec2 ends = (glm::dvec2(x, y) + 0.5 - 0.5 * size) / focal;
      const double r = glm::length(ends);
      const glm::dvec2 ray = r == 0 ? ends : ends * (undistorted_radius(r, radial) / r);
      const glm::dvec2 middle(0.5 * plain.width, 0.5 * plain.height);
      out.at(x, y) = glm::vec3(between(plain, middle + ray * plain_focal - 0.5));
    }
  }
  return out;
}

void write_through_lens(const ScratchFolder& scratch, const Dataset& desk, double radial) {
  fs::create_directories(scratch.path("sparse/0"));
  fs::create_directories(scratch.path("images"));
  for (const char* name : {"images.bin", "points3D.bin"}) {
    fs::copy_file(desk.folder + "/sparse/0/" + name, scratch.path(std::string("sparse/0/") + name));
  }
  // The one camera there is, with another model: number 2, then size, f, c_x, c_y and k.
  std::string bytes = bytes_of(desk.folder + "/sparse/0/cameras.bin");
  const double parameters[] = {kFocalPx, kModelPx.x / 2, kModelPx.y / 2, radial};
  constexpr std::size_t kModelAt = 12, kParametersAt = 32;
  const std::int32_t model = 2;
  std::memcpy(&bytes[kModelAt], &model, sizeof model);
  std::memcpy(&bytes[kParametersAt], parameters, sizeof parameters);
  scratch.write("sparse/0/cameras.bin", bytes);
  for (const DatasetView& view : desk.views) {
    write_image(scratch.path("p.png"), through_lens(view, radial));
    fs::rename(scratch.path("p.png"),
               scratch.path("images/" + fs::path(view.image_path).filename().string()));
  }
}

// Of desk's photographs so taken, made a quarter as large: half as large as desk's own.
Dataset opened(const ScratchFolder& scratch, const Dataset& desk, double radial) {
  write_through_lens(scratch, desk, radial);
  return open_dataset(scratch.path(""), {4, "", ""});
}

ActivatedCloud trained(const Dataset& dataset) {
  TrainingConfig config;
  config.steps = 1500;
  config.most_gaussians = 10000;
  config.start_gaussians = 5000;
  config.background = Background::kBlack;
  std::vector<Camera> cameras;
  for (const int view : views_of(dataset, Split::kTrain)) {
    cameras.push_back(dataset.views[static_cast<std::size_t>(view)].camera);
  }
  Photographs photographs(dataset, Split::kTrain);
  Trainer trainer(config, photographs, scene_extent(cameras),
                  start_at_points(dataset.points, config.start_gaussians, config.start, 1));
  while (!trainer.done()) trainer.step();
  return activate(trainer.cloud());
}

double psnr_on(const Dataset& dataset, const ActivatedCloud& cloud) {
  Photographs test(dataset, Split::kTest);
  test.load(1);
  return mean_quality(qualities(cloud, test, glm::vec3(0))).psnr_db;
}

}  // namespace

TEST_CASE("training: desk through a SIMPLE_RADIAL lens is as good as without",
          "[shared][nightly]") {
  const Dataset desk = open_dataset(shared_path("data/desk"));
  const ScratchFolder of_plain, of_lens;
  const Dataset plain = opened(of_plain, desk, 0), lens = opened(of_lens, desk, 0.08);
  const ActivatedCloud from_plain = trained(plain), from_lens = trained(lens);
  const double own = psnr_on(lens, from_lens), other = psnr_on(lens, from_plain);
  const double without = psnr_on(plain, from_plain);
  fmt::print(
      "test views through the lens: {:.2f} dB from them, {:.2f} dB from the others; without: "
      "{:.2f} dB\n",
      own, other, without);
  // The lens sees less of what few cameras see: its own views are easier.
  CHECK(own > without - 0.3);
  CHECK(std::abs(own - other) < 0.3);
}

}  // namespace sgs::test
