// Balls, their camera, their files.
#include "tests/system/made_scenes.h"

#include <cmath>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/ply_writer.h"

namespace sgs::test {
namespace {

constexpr int kSidePx = 64;

float activated(float logit) {
  return static_cast<float>(1 / (1 + std::exp(-static_cast<double>(logit))));
}

// Of 128/255.
float logit_of_a_code() {
  constexpr float kOpacity = 128.0F / 255.0F;
  float logit = 0;
  for (float step = 0.25F; step > 0; step /= 2) {
    if (activated(logit + step) <= kOpacity) logit += step;
  }
  return logit;
}

}  // namespace

GaussianCloud cloud_of(const std::vector<Ball>& balls) {
  constexpr float kInvisible = -8;
  const float visible = logit_of_a_code();
  GaussianCloud cloud;
  for (const Ball& ball : balls) {
    cloud.means.push_back(ball.mean);
    cloud.log_scales.emplace_back(std::log(ball.scale));
    cloud.quats.push_back({1, 0, 0, 0});
    cloud.opacity_logits.push_back(ball.visible ? visible : kInvisible);
    cloud.sh_coeffs.push_back(ball.dc);
  }
  return cloud;
}

GaussianCloud padded(GaussianCloud cloud, int degree) {
  const auto had = static_cast<std::size_t>(sh_coeff_count(cloud.sh_degree));
  const auto has = static_cast<std::size_t>(sh_coeff_count(degree));
  std::vector<glm::vec3> sh(cloud.size() * has, glm::vec3(0));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (std::size_t k = 0; k < had; ++k) sh[i * has + k] = cloud.sh_coeffs[i * had + k];
  }
  cloud.sh_coeffs = std::move(sh);
  cloud.sh_degree = degree;
  return cloud;
}

glm::vec3 at_pixel(float x, float y, float depth) {
  constexpr float kMiddle = kSidePx / 2.0F;
  return {(x - kMiddle) / kSidePx * depth, (y - kMiddle) / kSidePx * depth, depth};
}

MadeScene::MadeScene(const GaussianCloud& cloud) {
  Camera camera;
  camera.width = camera.height = kSidePx;
  camera.focal_x = camera.focal_y = kSidePx;
  write_ply(folder_.path("scene.ply"), cloud);
  write_cameras(folder_.path("cameras.json"), {camera});
}

Arguments MadeScene::arguments(const char* machine, const Arguments& set) const {
  const Arguments scene = {folder_.path("scene.ply"), "--cameras", folder_.path("cameras.json"),
                           "--config", machine};
  const bool has_groups = std::string(machine).rfind("gscore", 0) != 0;
  return with_settings(
      with_settings(scene, has_groups ? Arguments{"group_width_px=16", "group_height_px=16",
                                                  "sram.shared_bytes=0", "sram.input_bytes=0"}
                                      : Arguments{}),
      set);
}

}  // namespace sgs::test
