// Sections 1 to 3 of the rendering semantics, one after the other.
#include "testbench/oracle/double_oracle.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace sgs {
namespace {

int tile_of(double value, int tiles) {
  return static_cast<int>(std::clamp(std::trunc(value / 16), 0.0, static_cast<double>(tiles)));
}

glm::dmat3 rotation_of(const std::array<float, 4>& quat) {
  double r = quat[0], x = quat[1], y = quat[2], z = quat[3];
  const double length = std::sqrt(r * r + x * x + y * y + z * z);
  r /= length, x /= length, y /= length, z /= length;
  // glm takes columns.
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + r * z), 2 * (x * z - r * y)},
          {2 * (x * y - r * z), 1 - 2 * (x * x + z * z), 2 * (y * z + r * x)},
          {2 * (x * z + r * y), 2 * (y * z - r * x), 1 - 2 * (x * x + y * y)}};
}

glm::dvec3 colour_of(int degree, const glm::vec3* sh, const glm::dvec3& direction) {
  const double x = direction.x, y = direction.y, z = direction.z;
  const double basis[16] = {0.28209479177387814,
                            -0.4886025119029199 * y,
                            0.4886025119029199 * z,
                            -0.4886025119029199 * x,
                            1.0925484305920792 * x * y,
                            -1.0925484305920792 * y * z,
                            0.31539156525252005 * (2 * z * z - x * x - y * y),
                            -1.0925484305920792 * x * z,
                            0.5462742152960396 * (x * x - y * y),
                            -0.5900435899266435 * y * (3 * x * x - y * y),
                            2.890611442640554 * x * y * z,
                            -0.4570457994644658 * y * (4 * z * z - x * x - y * y),
                            0.3731763325901154 * z * (2 * z * z - 3 * x * x - 3 * y * y),
                            -0.4570457994644658 * x * (4 * z * z - x * x - y * y),
                            1.445305721320277 * z * (x * x - y * y),
                            -0.5900435899266435 * x * (x * x - 3 * y * y)};
  glm::dvec3 colour(0.5);
  for (int k = 0; k < (degree + 1) * (degree + 1); ++k) colour += basis[k] * glm::dvec3(sh[k]);
  return glm::max(colour, glm::dvec3(0));
}

// Determinant of [u; w] [u; w]^T + 0.3 I, |u| >= |w|: rows (u, sqrt(0.3), 0) and (w, 0, sqrt(0.3))
// made orthogonal. a c - b^2 has no digit left for splats wider than 10^8 px; this loses one for
// each ten times of width.
double determinant(const glm::dvec3& u, const glm::dvec3& w) {
  const double a = glm::dot(u, u) + 0.3;
  const double share = glm::dot(u, w) / a;
  const glm::dvec3 rest = w - share * u;
  return a * (glm::dot(rest, rest) + share * share * 0.3 + 0.3);
}

OracleSplat project_one(const Camera& camera, const GaussianCloud& cloud, std::size_t i,
                        const glm::dvec3& v) {
  OracleSplat s{};
  s.index = static_cast<std::uint32_t>(i);
  s.depth = v.z;
  s.depth_key = static_cast<float>(v.z);
  s.opacity = 1 / (1 + std::exp(-static_cast<double>(cloud.opacity_logits[i])));

  const double width = camera.width, height = camera.height;
  const double tan_x = width / (2 * camera.focal_x), tan_y = height / (2 * camera.focal_y);
  const glm::dvec2 off = camera.principal_offset;
  s.x = ((v.x / (v.z * tan_x) + 1) * width - 1) / 2 + off.x;
  s.y = ((v.y / (v.z * tan_y) + 1) * height - 1) / 2 + off.y;

  const glm::dmat3 r = rotation_of(cloud.quats[i]);
  const glm::dvec3 scale = glm::exp(glm::dvec3(cloud.log_scales[i]));
  const glm::dmat3 m(r[0] * scale.x, r[1] * scale.y, r[2] * scale.z);
  const double limit_x = 1.3 * tan_x + std::abs(off.x) / camera.focal_x;
  const double limit_y = 1.3 * tan_y + std::abs(off.y) / camera.focal_y;
  const double slope_x = std::clamp(v.x / v.z, -limit_x, limit_x) * v.z;
  const double slope_y = std::clamp(v.y / v.z, -limit_y, limit_y) * v.z;
  // Rows of J R^T, world frame.
  const glm::dmat3& axes = camera.world_from_camera;
  const glm::dvec3 row_x =
      camera.focal_x / v.z * axes[0] - camera.focal_x * slope_x / (v.z * v.z) * axes[2];
  const glm::dvec3 row_y =
      camera.focal_y / v.z * axes[1] - camera.focal_y * slope_y / (v.z * v.z) * axes[2];
  const glm::dvec3 u = row_x * m, w = row_y * m;  // rows of the covariance's factor
  s.a = glm::dot(u, u) + 0.3;
  s.b = glm::dot(u, w);
  s.c = glm::dot(w, w) + 0.3;

  const double det = s.a >= s.c ? determinant(u, w) : determinant(w, u);
  s.conic[0] = s.c / det;
  s.conic[1] = -s.b / det;
  s.conic[2] = s.a / det;
  const double mid = (s.a + s.c) / 2;
  s.radius_px = 3 * std::sqrt(mid + std::sqrt(std::max(0.1, mid * mid - det)));
  const double radius = std::ceil(s.radius_px);
  if (det != 0) {
    const int tiles_x = (camera.width + 15) / 16, tiles_y = (camera.height + 15) / 16;
    s.x0 = tile_of(s.x - radius, tiles_x);
    s.y0 = tile_of(s.y - radius, tiles_y);
    s.x1 = tile_of(s.x + radius + 15, tiles_x);
    s.y1 = tile_of(s.y + radius + 15, tiles_y);
  }
  const glm::dvec3 direction = glm::normalize(glm::dvec3(cloud.means[i]) - camera.position);
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(cloud.sh_degree));
  s.rgb = colour_of(cloud.sh_degree, &cloud.sh_coeffs[i * coeffs], direction);
  return s;
}

void blend_pixel(const std::vector<OracleSplat>& splats, const std::vector<std::uint32_t>& list,
                 int x, int y, const glm::dvec3& background, double finished_below,
                 OracleImage& image) {
  double t = 1;
  glm::dvec3 colour(0);
  std::uint32_t contributors = 0;
  for (const std::uint32_t i : list) {
    const OracleSplat& s = splats[i];
    const double dx = s.x - x, dy = s.y - y;
    const double power = -(s.conic[0] * dx * dx + s.conic[2] * dy * dy) / 2 - s.conic[1] * dx * dy;
    if (power > 0 || power < -5.6) continue;  // exp(-5.6) < 1/255: saves most of the time
    const double alpha = std::min(0.99, s.opacity * std::exp(power));
    if (alpha < 1.0 / 255) continue;
    const double after = t * (1 - alpha);
    if (after < finished_below) break;
    colour += s.rgb * alpha * t;
    t = after;
    ++contributors;
  }
  const auto at = static_cast<std::size_t>(y) * image.width + x;
  image.pixels[at] = colour + t * background;
  image.transmittance[at] = t;
  image.contributors[at] = contributors;
}

}  // namespace

std::vector<OracleSplat> oracle_project(const Camera& camera, const GaussianCloud& cloud) {
  const glm::dmat3 cam_from_world = glm::transpose(camera.world_from_camera);
  std::vector<OracleSplat> splats;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const glm::dvec3 v = cam_from_world * (glm::dvec3(cloud.means[i]) - camera.position);
    if (v.z > 0.2) splats.push_back(project_one(camera, cloud, i, v));
  }
  return splats;
}

std::vector<OracleSplat> oracle_order(std::vector<OracleSplat> splats) {
  splats.erase(std::remove_if(splats.begin(), splats.end(),
                              [](const OracleSplat& s) { return s.x1 <= s.x0 || s.y1 <= s.y0; }),
               splats.end());
  std::sort(splats.begin(), splats.end(), [](const OracleSplat& a, const OracleSplat& b) {
    return a.depth_key < b.depth_key || (a.depth_key == b.depth_key && a.index < b.index);
  });
  return splats;
}

OracleImage oracle_blend(const Camera& camera, const std::vector<OracleSplat>& ordered,
                         const glm::dvec3& background, double finished_below) {
  OracleImage image;
  image.width = camera.width;
  image.height = camera.height;
  const auto pixels = static_cast<std::size_t>(camera.width) * camera.height;
  image.pixels.resize(pixels);
  image.transmittance.resize(pixels);
  image.contributors.resize(pixels);
  const int tiles_x = (camera.width + 15) / 16, tiles_y = (camera.height + 15) / 16;
  tbb::parallel_for(0, tiles_y, [&](int tile_y) {
    std::vector<std::vector<std::uint32_t>> lists(static_cast<std::size_t>(tiles_x));
    for (std::uint32_t i = 0; i < ordered.size(); ++i) {
      const OracleSplat& s = ordered[i];
      if (tile_y < s.y0 || tile_y >= s.y1) continue;
      for (int x = s.x0; x < s.x1; ++x) lists[static_cast<std::size_t>(x)].push_back(i);
    }
    for (int y = tile_y * 16; y < std::min(tile_y * 16 + 16, camera.height); ++y) {
      for (int x = 0; x < camera.width; ++x) {
        blend_pixel(ordered, lists[static_cast<std::size_t>(x / 16)], x, y, background,
                    finished_below, image);
      }
    }
  });
  return image;
}

OracleImage oracle_render(const Camera& camera, const GaussianCloud& cloud,
                          const glm::dvec3& background) {
  return oracle_blend(camera, oracle_order(oracle_project(camera, cloud)), background);
}

}  // namespace sgs
