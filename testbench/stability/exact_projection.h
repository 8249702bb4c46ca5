// Section 2 of the rendering semantics as it is written: matrices multiplied out, the determinant
// as a c - b^2, the inverse by it. No form that algorithm/splat chose for its rounding.
#pragma once

#include "algorithm/scene/camera.h"
#include "testbench/stability/exact.h"

namespace sgs {

struct ExactView {
  ExactVector position;
  ExactMatrix cam_from_world;
  Exact focal_x, focal_y, limit_x, limit_y, centre_x, centre_y;
};
ExactView exact_view(const Camera& camera);

struct ExactGaussian {
  ExactVector mean, scale;
  std::array<Exact, 4> quat;  // (w, x, y, z), as if of unit length
};

struct ExactSplat {
  Exact x, y, depth;
  Exact cov_a, cov_b, cov_c, determinant;
  Exact conic_a, conic_b, conic_c;
  Exact lambda;  // the radius is 3 sqrt(lambda)
};

// v = R^T (p - c).
ExactVector exact_to_camera(const ExactView& view, const ExactVector& mean);

// v: the centre in the camera frame.
ExactSplat exact_project(const ExactView& view, const ExactGaussian& g, const ExactVector& v);

// The covariance [a b; b c] of two rows u1, u2 = J R^T M, low-pass included, and what follows.
void complete(ExactSplat& splat);

}  // namespace sgs
