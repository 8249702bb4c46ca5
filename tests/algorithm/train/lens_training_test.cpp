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
#include "algorithm/train/evaluation.h"
#include "algorithm/train/start_cloud.h"
#include "algorithm/train/trainer.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/shared_inputs.h"

namespace sgs::test {
namespace {

namespace fs = std::filesystem;

// desk's model is of 1906x1070 px. COLMAP's automatic reconstruction leaves SIMPLE_RADIAL.
constexpr glm::dvec2 kModelPx(1906, 1070);
constexpr double kFocalPx = 1510, kRadial = 0.08;

// r of r (1 + kRadial r^2).
double undistorted_radius(double wanted) {
  double r = wanted;
  for (int i = 0; i < 20; ++i) {
    r -= (r * (1 + kRadial * r * r) - wanted) / (1 + 3 * kRadial * r * r);
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
Image through_lens(const DatasetView& view) {
  const RgbaImage plain = load_view(view);
  const glm::dvec2 size(2 * plain.width, 2 * plain.height);
  const glm::dvec2 focal = kFocalPx * size / kModelPx;
  const glm::dvec2 plain_focal(view.camera.focal_x, view.camera.focal_y);
  Image out(2 * plain.width, 2 * plain.height);
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      const glm::dvec2 ends = (glm::dvec2(x, y) + 0.5 - 0.5 * size) / focal;
      const double r = glm::length(ends);
      const glm::dvec2 ray = r == 0 ? ends : ends * (undistorted_radius(r) / r);
      const glm::dvec2 middle(0.5 * plain.width, 0.5 * plain.height);
      out.at(x, y) = glm::vec3(between(plain, middle + ray * plain_focal - 0.5));
    }
  }
  return out;
}

void write_through_lens(const ScratchFolder& scratch, const Dataset& desk) {
  fs::create_directories(scratch.path("sparse/0"));
  fs::create_directories(scratch.path("images"));
  for (const char* name : {"images.bin", "points3D.bin"}) {
    fs::copy_file(desk.folder + "/sparse/0/" + name, scratch.path(std::string("sparse/0/") + name));
  }
  // The one camera there is, with another model: number 2, then size, f, c_x, c_y and k.
  std::string bytes = bytes_of(desk.folder + "/sparse/0/cameras.bin");
  const double parameters[] = {kFocalPx, kModelPx.x / 2, kModelPx.y / 2, kRadial};
  constexpr std::size_t kModelAt = 12, kParametersAt = 32;
  const std::int32_t model = 2;
  std::memcpy(&bytes[kModelAt], &model, sizeof model);
  std::memcpy(&bytes[kParametersAt], parameters, sizeof parameters);
  scratch.write("sparse/0/cameras.bin", bytes);
  for (const DatasetView& view : desk.views) {
    write_image(scratch.path("p.png"), through_lens(view));
    fs::rename(scratch.path("p.png"),
               scratch.path("images/" + fs::path(view.image_path).filename().string()));
  }
}

double trained_psnr(const Dataset& dataset) {
  TrainingConfig config;
  config.steps = 3000;
  config.most_gaussians = 20000;
  config.start_gaussians = 5000;
  config.background = Background::kBlack;
  std::vector<Camera> cameras;
  for (const int view : views_of(dataset, Split::kTrain)) {
    cameras.push_back(dataset.views[static_cast<std::size_t>(view)].camera);
  }
  Photographs train(dataset, Split::kTrain), test(dataset, Split::kTest);
  test.load(1);
  Trainer trainer(config, train, scene_extent(cameras),
                  start_at_points(dataset.points, config.start_gaussians, config.start, 1));
  while (!trainer.done()) trainer.step();
  return mean_quality(qualities(activate(trainer.cloud()), test, glm::vec3(0))).psnr_db;
}

}  // namespace

TEST_CASE("training: desk through a SIMPLE_RADIAL lens is as good as without",
          "[shared][nightly]") {
  const std::string folder = shared_path("data/desk");
  const Dataset desk = open_dataset(folder);
  const ScratchFolder scratch;
  write_through_lens(scratch, desk);
  const DatasetOptions half{2, "", ""}, quarter{4, "", ""};
  const Dataset through_lens = open_dataset(scratch.path(""), quarter);
  for (const auto& [title, text] : through_lens.notes) fmt::print("{} {}\n", title, text);
  const double without = trained_psnr(open_dataset(folder, half));
  const double with = trained_psnr(through_lens);
  fmt::print("test views: {:.2f} dB without a lens, {:.2f} dB through it\n", without, with);
  CHECK(std::abs(with - without) < 0.3);
}

}  // namespace sgs::test
