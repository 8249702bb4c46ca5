// Files written for the command, and its frames.
#include "tests/system/extreme_scenes.h"

#include <catch2/catch.hpp>
#include <utility>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/ply_writer.h"

namespace sgs::test {

void add(GaussianCloud& cloud, const glm::vec3& mean, float log_scale, float opacity_logit,
         const glm::vec3& colour) {
  cloud.means.push_back(mean);
  cloud.log_scales.emplace_back(log_scale);
  cloud.quats.push_back({1, 0, 0, 0});
  cloud.opacity_logits.push_back(opacity_logit);
  cloud.sh_coeffs.push_back(colour);
}

Camera camera_at(const glm::dvec3& position, int width, int height) {
  Camera camera;
  camera.name = "test";
  camera.width = width;
  camera.height = height;
  camera.focal_x = camera.focal_y = 60;
  camera.position = position;
  return camera;
}

std::vector<nlohmann::json> check_machine(const char* machine, const GaussianCloud& cloud,
                                          const std::vector<Camera>& cameras,
                                          const Arguments& options) {
  const ScratchFolder scratch;
  write_ply(scratch.path("scene.ply"), cloud);
  write_cameras(scratch.path("cameras.json"), cameras);
  INFO(machine);
  const Simulation simulation(
      joined({scratch.path("scene.ply"), "--cameras", scratch.path("cameras.json"), "--view", "all",
              "--config", machine},
             options));
  simulation.check();
  return simulation.views();
}

std::vector<nlohmann::json> check_scene(const GaussianCloud& cloud,
                                        const std::vector<Camera>& cameras,
                                        const Arguments& voxels) {
  std::vector<nlohmann::json> views = check_machine("paper", cloud, cameras, voxels);
  for (const char* machine : {"exact", "gscore", "gscore_lossless_boxes"}) {
    for (nlohmann::json& view : check_machine(machine, cloud, cameras)) {
      views.push_back(std::move(view));
    }
  }
  return views;
}

}  // namespace sgs::test
