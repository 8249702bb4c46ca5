// Seeded random scenes of every kind that makes bounds and orders hard, small enough to be put to
// brute force: needles, giants, points, coincident centres, equal depths, the near plane, a camera
// inside, coordinates far from the origin.
#pragma once

#include <cstdint>
#include <random>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs::test {

struct HardScene {
  GaussianCloud cloud;
  Camera camera;
};

class HardScenes {
 public:
  explicit HardScenes(unsigned seed) : random_(seed) {}

  // A cloud of `gaussians` in clusters, before a camera with sides of 1 to longest_px, narrow or
  // wide, its pixels not quite square, anywhere in the world and turned anyhow.
  HardScene next(std::size_t gaussians, int longest_px);

  int pick(int choices) { return std::uniform_int_distribution<int>(0, choices - 1)(random_); }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  // What the Gaussians of one cluster have in common.
  struct Cluster {
    glm::dvec3 centre;  // camera frame
    double spread;      // of the centres, world units
    double scale;       // largest scale
    double ratio;       // largest scale over the others, at most
    int arrangement;    // of the centres
  };

  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  double normal() { return std::normal_distribution<double>()(random_); }
  glm::dvec3 normal3() { return {normal(), normal(), normal()}; }
  Camera camera(int longest_px);
  Cluster cluster(const Camera& camera);
  glm::dvec3 centre_in(const Cluster& cluster);
  double opacity_logit();

  std::mt19937_64 random_;
};

}  // namespace sgs::test
