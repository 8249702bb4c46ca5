// The canonical form is the same ellipsoid, and the same form for each of its names.
#include "algorithm/vq/vq_points.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <random>

namespace sgs {
namespace {

using Quat = std::array<float, 4>;

glm::dmat3 rotation(const Quat& q) { return glm::mat3_cast(glm::dquat(q[0], q[1], q[2], q[3])); }

// R diag(s)^2 R^T
glm::dmat3 covariance(const glm::vec3& scale, const Quat& quat) {
  const glm::dmat3 r = rotation(quat);
  glm::dmat3 scaled = r;
  for (int axis = 0; axis < 3; ++axis) {
    scaled[axis] *= static_cast<double>(scale[axis]) * scale[axis];
  }
  return scaled * glm::transpose(r);
}

Quat random_quat(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const glm::dquat q =
      glm::normalize(glm::dquat(normal(random), normal(random), normal(random), normal(random)));
  return {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
          static_cast<float>(q.z)};
}

void check_form(const CanonicalShape& shape) {
  CHECK(shape.scale[0] >= shape.scale[1]);
  CHECK(shape.scale[1] >= shape.scale[2]);
  double squared = 0;
  for (const float component : shape.quat) {
    CHECK(shape.quat[0] >= std::abs(component));
    squared += static_cast<double>(component) * component;
  }
  CHECK(squared == Approx(1).epsilon(1e-6));
}

void check_same_ellipsoid(const glm::vec3& scale, const Quat& quat) {
  INFO(scale.x << " " << scale.y << " " << scale.z);
  const CanonicalShape shape = canonical_shape(scale, quat);
  check_form(shape);
  const glm::dmat3 before = covariance(scale, quat), after = covariance(shape.scale, shape.quat);
  const double largest = std::pow(static_cast<double>(shape.scale[0]), 2);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      CHECK(std::abs(after[column][row] - before[column][row]) <= 1e-6 * largest);
    }
  }
}

TEST_CASE("canonical shape: the same ellipsoid, scales falling, w largest") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<float> log_scale(-8, 4);
  for (int i = 0; i < 2000; ++i) {
    glm::vec3 scale;
    for (int axis = 0; axis < 3; ++axis) scale[axis] = std::exp(log_scale(random));
    check_same_ellipsoid(scale, random_quat(random));
  }
}

TEST_CASE("canonical shape: equal scales, scales of nought, ratios of 1e-10") {
  std::mt19937_64 random(2);
  const glm::vec3 scales[] = {
      {1, 1, 1},       {1, 1, 0.5F},    {1, 0.5F, 1},       {0.5F, 1, 1},
      {1, 0.5F, 0.5F}, {0.5F, 1, 0.5F}, {0.5F, 0.5F, 1},    {0, 0, 0},
      {1, 0, 0},       {0, 1, 0},       {0, 0, 1},          {0, 1, 1},
      {1e-10F, 1, 1},  {1, 1e-10F, 1},  {1e-10F, 1, 1e-5F}, {1e15F, 1e5F, 1}};
  for (const glm::vec3& scale : scales) {
    for (int i = 0; i < 20; ++i) check_same_ellipsoid(scale, random_quat(random));
    for (const Quat& quat : {Quat{1, 0, 0, 0},
                             {0, 1, 0, 0},
                             {0, 0, 1, 0},
                             {0, 0, 0, -1},
                             {0.5F, 0.5F, 0.5F, 0.5F},
                             {-0.5F, 0.5F, -0.5F, 0.5F}}) {
      check_same_ellipsoid(scale, quat);
    }
  }
}

// All ways to name an ellipsoid: axes permuted, turned over so that the system stays right-handed,
// and the quaternion's sign.
std::vector<CanonicalShape> namings(const glm::vec3& scale, const Quat& quat) {
  const glm::dmat3 r = rotation(quat);
  std::vector<CanonicalShape> all;
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (int flips = 0; flips < 8; ++flips) {
      glm::dmat3 named;
      CanonicalShape naming{};
      for (int axis = 0; axis < 3; ++axis) {
        const int from = order[static_cast<std::size_t>(axis)];
        named[axis] = (flips >> axis & 1) != 0 ? -r[from] : r[from];
        naming.scale[axis] = scale[from];
      }
      if (glm::determinant(named) < 0) continue;
      const glm::dquat q = glm::quat_cast(named);
      for (const double sign : {1.0, -1.0}) {
        naming.quat = {static_cast<float>(sign * q.w), static_cast<float>(sign * q.x),
                       static_cast<float>(sign * q.y), static_cast<float>(sign * q.z)};
        all.push_back(naming);
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return all;
}

TEST_CASE("canonical shape: all 48 names of an ellipsoid give one form") {
  std::mt19937_64 random(3);
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    const Quat quat = random_quat(random);
    const CanonicalShape first = canonical_shape({0.3F, 2, 0.7F}, quat);
    // Where another component is as large as w rounding decides between two forms.
    float second = 0;
    for (std::size_t k = 1; k < 4; ++k) second = std::max(second, std::abs(first.quat[k]));
    if (first.quat[0] - second < 1e-4F) continue;
    const std::vector<CanonicalShape> names = namings({0.3F, 2, 0.7F}, quat);
    REQUIRE(names.size() == 48);
    for (const CanonicalShape& name : names) {
      const CanonicalShape shape = canonical_shape(name.scale, name.quat);
      CHECK(shape.scale == first.scale);
      for (std::size_t k = 0; k < 4; ++k) {
        CHECK(std::abs(shape.quat[k] - first.quat[k]) < 1e-6F);
      }
    }
    ++compared;
  }
  CHECK(compared > 250);
}

}  // namespace
}  // namespace sgs
