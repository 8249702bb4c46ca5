// Random Gaussians before a random camera, for those studies that begin at the projection.
#pragma once

#include "algorithm/splat/projection.h"
#include "testbench/stability/exact.h"
#include "testbench/stability/study.h"

namespace sgs {

// 1280 x 720 px, at the origin, looking anywhere.
Camera turned_camera(Random& random);

// The inputs of a formula, exactly.
template <class T>
glm::vec<3, T> given(const glm::vec3& v) {
  return {T(v.x), T(v.y), T(v.z)};
}
template <class T>
Gaussian<T> given(const Gaussian<float>& g) {
  Gaussian<T> out{};
  out.mean = given<T>(g.mean);
  out.scale = given<T>(g.scale);
  for (std::size_t k = 0; k < 4; ++k) out.quat[k] = T(g.quat[k]);
  out.opacity = T(g.opacity);
  return out;
}

// With what rounding took of the camera; where it stands is in two parts, the first of which is
// taken as it is.
template <class T>
View<T> bounded_view(const Camera& camera) {
  View<T> view = make_view<T>(camera);
  for (int k = 0; k < 3; ++k) view.position[k].error = 0;
  return view;
}

// One Gaussian by its centre in the camera frame. All of it is exact.
struct ProjectedCase {
  Camera camera;
  glm::vec3 v;  // camera frame
  Gaussian<float> gaussian;

  ExactGaussian exact_gaussian() const;
  ExactSplat exact_splat() const;
  template <class T>
  Projected<T> projected() const {
    return project(bounded_view<T>(camera), given<T>(gaussian), given<T>(v));
  }
};

// A needle, or every third time a disc seen on edge, that lies across the screen; the condition
// tr^2 / det of its covariance on the screen is `condition` within a factor of some units.
ProjectedCase long_splat(double condition, Random& random);

// An ellipse of 1000 px whose axes differ by this part, in the middle of the frame.
ProjectedCase nearly_round(double difference, Random& random);

// A disc of so many px, seen at an angle.
ProjectedCase wide_disc(double sigma_px, Random& random);

// Half as wide as it is far away, so far behind the near plane.
ProjectedCase near_plane(double distance, Random& random);

}  // namespace sgs
