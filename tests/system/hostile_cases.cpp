// The extremes, each a function that adds to a scene or turns what is there.
#include "tests/system/hostile_cases.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs::test {
namespace {

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

float logit(double p) { return static_cast<float>(std::log(p) - std::log1p(-p)); }

// A scene in the making. World units; the first camera looks along z from (0, 0, -5).
class Draft {
 public:
  explicit Draft(std::uint64_t seed) : random_(seed) {
    cloud_.sh_degree = pick(4);
    Camera camera;
    camera.width = 33 + pick(32);
    camera.height = 25 + pick(24);
    camera.focal_x = uniform(30, 90);
    camera.focal_y = camera.focal_x * uniform(0.8, 1.25);
    camera.position = {0, 0, -5};
    cameras_.push_back(camera);
  }

  int pick(int choices) { return std::uniform_int_distribution<int>(0, choices - 1)(random_); }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  double normal() { return std::normal_distribution<double>()(random_); }
  glm::dvec3 normal3() { return {normal(), normal(), normal()}; }

  std::size_t add(const glm::dvec3& mean, const glm::dvec3& scale, double opacity) {
    const std::size_t i = cloud_.size();
    cloud_.resize(i + 1, cloud_.sh_degree);
    cloud_.means[i] = mean;
    cloud_.log_scales[i] = glm::vec3(glm::log(scale));
    for (float& component : cloud_.quats[i]) component = static_cast<float>(normal());
    cloud_.opacity_logits[i] = logit(opacity);
    const auto coeffs = static_cast<std::size_t>(sh_coeff_count(cloud_.sh_degree));
    for (std::size_t k = 0; k < coeffs; ++k) {
      cloud_.sh_coeffs[i * coeffs + k] = glm::vec3(0.4 * normal3());
    }
    return i;
  }
  // A usual Gaussian somewhere in view.
  std::size_t add_plain() {
    return add(normal3() * 0.8, log_uniform(0.02, 0.4) * glm::dvec3(1, uniform(0.1, 1), 1),
               uniform(0.02, 0.98));
  }
  void add_plain(int count) {
    for (int i = 0; i < count; ++i) add_plain();
  }
  // A second look at the scene: the first camera, elsewhere.
  Camera& add_camera(const glm::dvec3& position) {
    cameras_.push_back(cameras_[0]);
    cameras_.back().position = position;
    return cameras_.back();
  }
  void look_along(Camera& camera, const glm::dvec3& forward) {
    const glm::dvec3 z = glm::normalize(forward);
    const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(0.3, 1, 0.2)));
    camera.world_from_camera = glm::dmat3(x, glm::cross(z, x), z);
  }
  GaussianCloud& cloud() { return cloud_; }
  std::vector<Camera>& cameras() { return cameras_; }
  void refuse(const std::string& word) { refused_ = word; }

  HostileCase finished() && {
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      cameras_[i].id = static_cast<int>(i);
      cameras_[i].name = "view" + std::to_string(i);
    }
    return {"", std::move(cloud_), std::move(cameras_), refused_};
  }

 private:
  std::mt19937_64 random_;
  GaussianCloud cloud_;
  std::vector<Camera> cameras_;
  std::string refused_;
};

// --- what is there ---

void one(Draft& d) { d.add({0.1, 0.05, 0}, {0.2, 0.1, 0.3}, 0.8); }

void one_point(Draft& d) {
  const glm::dvec3 at = d.normal3() * 0.3;
  const int count = 300 + d.pick(900);
  for (int i = 0; i < count; ++i) d.add(at, glm::dvec3(d.log_uniform(0.01, 0.2)), 0.3);
}

void equal_depths(Draft& d) {
  const double z = d.uniform(-3, 3);
  for (int i = 0; i < 250; ++i) {
    d.add({d.normal(), d.normal(), z}, glm::dvec3(d.log_uniform(0.02, 0.3)), 0.5);
  }
}

void needles(Draft& d) {
  for (int i = 0; i < 60; ++i) {
    const double longest = d.log_uniform(0.1, 100), thin = longest / d.log_uniform(1e3, 1e10);
    d.add(d.normal3(), {longest, thin, d.pick(2) == 0 ? thin : longest}, 0.7);
  }
  d.cloud().log_scales[0] = {16.118F, -3e38F, -3e38F};  // the limits
}

void opacities(Draft& d) {
  d.add_plain(60);
  for (std::size_t i = 0; i < d.cloud().size(); ++i) {
    const float choices[] = {-200, 200, logit(1.0 / 255), logit(d.log_uniform(0.00391, 0.00394)),
                             logit(0.99)};
    d.cloud().opacity_logits[i] = choices[d.pick(5)];
  }
  d.cloud().opacity_logits[0] = 3e38F;  // the limit
}

void long_quaternions(Draft& d) {
  d.add_plain(80);
  for (auto& quat : d.cloud().quats) {
    const double length = d.log_uniform(1e-30, 1e30);
    for (float& component : quat) component = static_cast<float>(component * length);
  }
  d.cloud().quats[0] = {1e-38F, 2e-38F, 0, 0};  // the limits
  d.cloud().quats[1] = {3e38F, 3e38F, -3e38F, 3e38F};
}

void at_the_camera(Draft& d) {
  d.add_plain(40);
  for (const Camera& camera : d.cameras()) {
    const glm::dvec3 z = camera.world_from_camera[2];
    for (const double depth : {0.0, 0.19999, 0.2, 0.2000001, 0.21, -0.2, -3.0}) {
      d.add(camera.position + depth * z, glm::dvec3(d.log_uniform(1e-3, 0.3)), 0.6);
    }
  }
}

void giants(Draft& d) {
  d.add_plain(80);
  for (int i = 0; i < 4; ++i) d.add(d.normal3(), glm::dvec3(d.log_uniform(1e2, 1e7)), 0.4);
}

void faint_layers(Draft& d) {
  const int layers = 500 + d.pick(2000);
  for (int i = 0; i < layers; ++i) {
    const std::size_t at = d.add({0, 0, 1e-3 * i}, glm::dvec3(3), 0.5);
    d.cloud().opacity_logits[at] = logit(1.0 / 255 * (1 + 1e-3 * d.pick(3)));
  }
}

void strong_colours(Draft& d) {
  d.add_plain(60);
  const double strength = d.log_uniform(10, 1e17);
  for (auto& coeff : d.cloud().sh_coeffs) coeff = glm::vec3(strength * d.normal3());
}

void wide_extents(Draft& d) {
  for (int i = 0; i < 100; ++i) {
    d.add(d.normal3() * 0.5, glm::dvec3(d.log_uniform(1e-3, 1e-2)), 0.8);
    const double far = d.log_uniform(1e2, 2e5);
    d.add(glm::dvec3(d.normal(), d.normal(), 1) * far, glm::dvec3(0.05 * far), 0.5);
  }
}

// A lattice of faces of voxels.
void lattice(Draft& d) {
  for (int i = 0; i < 216; ++i) {
    d.add(glm::dvec3(i % 6, i / 6 % 6, i / 36) * 0.4 - 1.0, glm::dvec3(0.05), 0.6);
  }
}

// Cameras inside of a voxel, on a face, an edge, and outside of all.
void on_faces(Draft& d) {
  lattice(d);
  for (const auto& at :
       {glm::dvec3(0.11, 0.13, 0.17), {0, 0.13, 0.17}, {0, 0.4, -0.4}, {40, 0, 0}}) {
    d.look_along(d.add_camera(at), -at + glm::dvec3(0.01, 0.02, 1));
  }
}

void axis_parallel(Draft& d) {
  lattice(d);
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  for (const auto& axes :
       {glm::dmat3(x, y, z), glm::dmat3(y, z, x), glm::dmat3(z, x, y), glm::dmat3(-x, y, -z)}) {
    Camera& camera = d.add_camera(-5.0 * axes[2]);
    camera.world_from_camera = axes;
    camera.width |= 1;
    camera.height |= 1;
  }
}

// --- how it is looked at ---

void tiny_frames(Draft& d) {
  d.add_plain(60);
  constexpr int kSizes[][2] = {{1, 1}, {1, 40}, {67, 1}, {3, 5}};
  const auto& size = kSizes[d.pick(4)];
  for (Camera& camera : d.cameras()) camera.width = size[0], camera.height = size[1];
}

void focal_lengths(Draft& d) {
  d.add_plain(60);
  for (Camera& camera : d.cameras()) {
    camera.focal_x = d.pick(2) == 0 ? d.log_uniform(1e-3, 1) : d.log_uniform(1e3, 1e8);
    camera.focal_y = camera.focal_x * d.log_uniform(0.1, 10);
  }
}

// Everything so far, far from the origin.
void far_coordinates(Draft& d) {
  d.add_plain(80);
  const glm::dvec3 far = 1e6 * glm::dvec3(d.uniform(-1, 1), d.uniform(-1, 1), 1);
  for (glm::vec3& mean : d.cloud().means) mean = glm::vec3(glm::dvec3(mean) + far);
  for (Camera& camera : d.cameras()) camera.position += far;
}

void far_camera(Draft& d) {
  d.add_plain(60);
  Camera& camera = d.add_camera(-d.log_uniform(1e3, 1e7) * glm::normalize(d.normal3()));
  camera.focal_x = camera.focal_y = 20 * glm::length(camera.position);
  d.look_along(camera, -camera.position);
}

// --- what nobody can draw ---

void zero_quaternion(Draft& d) {
  d.add_plain(20);
  d.cloud().quats[static_cast<std::size_t>(d.pick(20))] = {0, 0, 0, 0};
  d.refuse("rot_0");
}

void no_numbers(Draft& d) {
  d.add_plain(20);
  const auto at = static_cast<std::size_t>(d.pick(20));
  const float bad = d.pick(2) == 0 ? kNoNumber : d.pick(2) == 0 ? kInfinity : -kInfinity;
  switch (d.pick(5)) {
    case 0:
      d.cloud().means[at].y = bad;
      return d.refuse("property y");
    case 1:
      d.cloud().log_scales[at].z = bad;
      return d.refuse("scale_2");
    case 2:
      d.cloud().quats[at][3] = bad;
      return d.refuse("rot_3");
    case 3:
      d.cloud().opacity_logits[at] = bad;
      return d.refuse("opacity");
    default:
      d.cloud().sh_coeffs[at * static_cast<std::size_t>(sh_coeff_count(d.cloud().sh_degree))].x =
          bad;
      return d.refuse("f_dc_0");
  }
}

void beyond_limits(Draft& d) {
  d.add_plain(20);
  const auto at = static_cast<std::size_t>(d.pick(20));
  switch (d.pick(3)) {
    case 0:
      d.cloud().means[at].x = -2e18F;
      return d.refuse("property x");
    case 1:
      d.cloud().log_scales[at].y = 43;
      return d.refuse("scale_1");
    default:
      d.cloud().sh_coeffs[at * static_cast<std::size_t>(sh_coeff_count(d.cloud().sh_degree))].y =
          3e38F;
      return d.refuse("f_dc_1");
  }
}

struct Extreme {
  const char* name;
  void (*apply)(Draft&);
};

void nothing(Draft&) {}

// Those that turn what is there behind those that add to it.
constexpr Extreme kExtremes[] = {
    {"nothing", nothing},
    {"one", one},
    {"all at one point", one_point},
    {"equal depths", equal_depths},
    {"needles of 10^10", needles},
    {"opacities at both ends and at 1/255", opacities},
    {"quaternions of any length", long_quaternions},
    {"giants", giants},
    {"layers of 1/255", faint_layers},
    {"strong colours", strong_colours},
    {"extents of 10^5", wide_extents},
    {"cameras on faces", on_faces},
    {"rays along axes", axis_parallel},
    {"tiny frames", tiny_frames},
    {"focal lengths", focal_lengths},
    {"at the camera", at_the_camera},
    {"a camera far away", far_camera},
    {"coordinates of 10^6", far_coordinates},
    {"a quaternion of zero", zero_quaternion},
    {"no numbers", no_numbers},
    {"beyond limits", beyond_limits},
};
constexpr std::size_t kCount = std::size(kExtremes), kRefused = 3;

}  // namespace

std::uint64_t hostile_extremes() { return kCount; }

HostileCase hostile_case(std::uint64_t seed) {
  Draft draft(seed);
  std::vector<std::size_t> chosen = {seed};
  if (seed >= kCount) {
    // What is refused anyway needs no company.
    chosen.clear();
    const int several = 2 + draft.pick(3);
    for (int i = 0; i < several; ++i) {
      chosen.push_back(1 + static_cast<std::size_t>(draft.pick(kCount - kRefused - 1)));
    }
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  }
  std::string what;
  for (const std::size_t extreme : chosen) {
    kExtremes[extreme].apply(draft);
    what += (what.empty() ? "" : ", ") + std::string(kExtremes[extreme].name);
  }
  HostileCase made = std::move(draft).finished();
  made.what = what;
  return made;
}

}  // namespace sgs::test
