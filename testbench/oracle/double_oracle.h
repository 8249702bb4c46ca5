// The rendering semantics in plain double precision, per pixel, written from their text alone: the
// oracle that the reference renderer is judged by. Shares no code with algorithm/splat.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

// A Gaussian after section 2: [x0, x1) x [y0, y1) is its tile rectangle.
struct OracleSplat {
  std::uint32_t index;  // in the cloud
  float depth_key;      // v_z as float
  double depth;         // v_z
  double x, y;          // px
  double a, b, c;       // px^2, covariance
  double conic[3];      // 1/px^2
  double opacity;
  double radius_px;  // 3 sqrt(lambda), before ceil
  glm::dvec3 rgb;
  int x0, y0, x1, y1;  // tiles
};

struct OracleImage {
  int width = 0, height = 0;                // px
  std::vector<glm::dvec3> pixels;           // [height, width]
  std::vector<double> transmittance;        // [height, width]
  std::vector<std::uint32_t> contributors;  // [height, width]
};

// Section 2 for every Gaussian in front of the near plane, tile rectangle empty or not, in the
// order of the cloud.
std::vector<OracleSplat> oracle_project(const Camera& camera, const GaussianCloud& cloud);

// Without those of empty rectangle, ordered by (depth_key, index).
std::vector<OracleSplat> oracle_order(std::vector<OracleSplat> splats);

// Section 3; `ordered` as oracle_order returns it. finished_below: transmittance at which a pixel
// takes no more.
OracleImage oracle_blend(const Camera& camera, const std::vector<OracleSplat>& ordered,
                         const glm::dvec3& background = glm::dvec3(0),
                         double finished_below = 0.0001);

OracleImage oracle_render(const Camera& camera, const GaussianCloud& cloud,
                          const glm::dvec3& background = glm::dvec3(0));

}  // namespace sgs
