// Clouds put together one Gaussian at a time, and their frames by every machine.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/gaussian_cloud.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {

constexpr float kUnitScale = -3;  // logarithm of a scale of 0.05

// A ball of SH degree 0. log_scale: of its three axes; colour: f_dc.
void add(GaussianCloud& cloud, const glm::vec3& mean, float log_scale, float opacity_logit,
         const glm::vec3& colour);

// Looks along z from `position`.
Camera camera_at(const glm::dvec3& position, int width = 65, int height = 49);

// Simulates all views and checks them (check_frame).
std::vector<nlohmann::json> check_machine(const char* machine, const GaussianCloud& cloud,
                                          const std::vector<Camera>& cameras,
                                          const Arguments& options = {});

// By paper order, then exact order, then the tile-centric machine, without loss too: their views in
// this order. voxels: options of paper order.
std::vector<nlohmann::json> check_scene(const GaussianCloud& cloud,
                                        const std::vector<Camera>& cameras,
                                        const Arguments& voxels = {});

}  // namespace sgs::test
