// A trained 3D Gaussian scene with the parameters as the file holds them, before any activation
// (Kerbl et al. 2023, section 4), and how large these may be.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

namespace sgs {

// Spherical-harmonics coefficients per colour channel: 1, 4, 9, 16 for degrees 0 to 3.
constexpr int sh_coeff_count(int degree) { return (degree + 1) * (degree + 1); }

struct GaussianCloud {
  int sh_degree = 0;                        // 0 to 3
  std::vector<glm::vec3> means;             // [N] centre, world frame
  std::vector<glm::vec3> log_scales;        // [N] scale = exp(log_scale), world units
  std::vector<std::array<float, 4>> quats;  // [N] (w, x, y, z), any length but zero
  std::vector<float> opacity_logits;        // [N] opacity = sigmoid(logit)
  std::vector<glm::vec3> sh_coeffs;         // [N, (degree+1)^2] rgb; entry 0 is f_dc

  std::size_t size() const { return means.size(); }
  void resize(std::size_t count, int degree) {
    sh_degree = degree;
    means.resize(count);
    log_scales.resize(count);
    quats.resize(count);
    opacity_logits.resize(count);
    sh_coeffs.resize(count * static_cast<std::size_t>(sh_coeff_count(degree)));
  }
};

// Files and training keep opacities as logits: ln(p / (1 - p)) of p in [0, 1]; -inf and inf at its
// ends.
inline double logit(double p) { return std::log(p / (1 - p)); }

// Its inverse.
inline double sigmoid(double logit) { return 1 / (1 + std::exp(-logit)); }

// How large the parameters of Gaussians and cameras may be: what lies within is drawn, what lies
// beyond is refused by name, so that nothing vanishes where a computation leaves float.
//
// The steepest computation is the projection. With f the focal length, v_z > 0.2 the depth and S
// the largest scale, a splat is up to sigma = f S / v_z px wide. Its covariance, sigma^2, stays
// within float for every f and S within the limits. The determinant, sigma^4, does not: from sigma
// of 4 10^9 px it may be infinite and the conic 0, so that the splat is as opaque everywhere as it
// is at its centre. That is right to the eye unless the centre lies as far off the frame as a tenth
// of sigma, and takes a Gaussian of scale 10^7 nearer than f / 430. No limit on S alone lets pass
// all that some camera could show, from far enough, and nothing that another would lose. Distances
// are squared for the direction of colour: coordinates of 10^18 give 1.2e37. SH coefficients are
// squared where codebooks are trained.
constexpr double kMaxCoordinate = 1e18;      // magnitude, world units: Gaussians and cameras
constexpr double kMaxCoefficient = 1e18;     // magnitude of SH coefficients
constexpr double kMaxScale = 1e7;            // world units
constexpr double kMaxLogScale = 16.1180956;  // ln(kMaxScale)
constexpr double kMaxFocalPx = 1e9;

// What a scene file holds, and how it is to be read, whatever its form.
struct SceneReadOptions {
  // Leave out Gaussians with NaN, infinite values, values beyond gaussian_cloud.h or a zero
  // quaternion instead of refusing the file.
  bool drop_invalid = false;
  // Of a scene with levels of detail, 0 the finest, which is also the default.
  std::optional<std::uint32_t> level = {};
  // Where x, y and z of the file point: r or l, d or u, f or b, as in "rub". The scene is turned
  // to right, down, forward, as the cameras of its photographs stand. Empty: as the file states,
  // else as it is stored.
  std::string axes = {};
};

struct SceneContents {
  GaussianCloud cloud;
  std::uint64_t dropped_invalid = 0;  // Gaussians left out because of drop_invalid
  std::string axes = {};  // as the file states them, see SceneReadOptions; empty: it does not
  // What was changed on reading, and what the file holds that no picture here shows. A sentence
  // each.
  std::vector<std::string> notes = {};
};

}  // namespace sgs
