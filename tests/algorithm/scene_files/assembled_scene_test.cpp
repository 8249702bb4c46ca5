// assembled_scene.h: a moved Gaussian looks from a moved place as it did before; names of axes.
#include "algorithm/scene_files/assembled_scene.h"

#include <array>
#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "algorithm/scene/ply_vertex.h"
#include "algorithm/scene_files/decoded_scene.h"
#include "algorithm/splat/spherical_harmonics.h"
#include "testbench/builtin/random.h"

using namespace sgs;

namespace {

using Slots = std::array<float, kMaxSlots>;

Slots some_slots() {
  Random random(3);
  Slots slots{};
  for (float& slot : slots) slot = static_cast<float>(random.uniform(-1, 1));
  return slots;
}

// The covariance, up to the scale's exponential.
glm::dmat3 covariance(const Slots& slots) {
  const float* q = &slots[kRotationSlot];
  const glm::dmat3 rotation = glm::mat3_cast(glm::normalize(glm::dquat(q[0], q[1], q[2], q[3])));
  glm::dmat3 axes(0);
  for (int i = 0; i < 3; ++i) axes[i] = rotation[i] * std::exp(double(slots[kScaleSlot + i]));
  return axes * glm::transpose(axes);
}

double colour(const Slots& slots, const glm::dvec3& direction) {
  double basis[16];
  sh_basis(3, direction.x, direction.y, direction.z, basis);
  double sum = 0;
  for (int k = 1; k < 16; ++k) sum += basis[k] * slots[rest_slot(3, 1, k - 1)];
  return sum;
}

}  // namespace

TEST_CASE("placement: centre, covariance and colour turn, move and scale together") {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, -0.5));
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1), 1.1, axis);
  const glm::dmat4 matrix =
      glm::scale(glm::translate(glm::dmat4(1), glm::dvec3(3, -4, 5)) * turn, glm::dvec3(2.5));
  const Slots before = some_slots();
  Slots after = before;
  Placement::of(matrix)->apply(3, after.data());
  const glm::dvec4 centre = matrix * glm::dvec4(before[0], before[1], before[2], 1);
  const glm::dmat3 linear(matrix);
  const glm::dmat3 expected = linear * covariance(before) * glm::transpose(linear);
  const glm::dmat3 got = covariance(after);
  for (int i = 0; i < 3; ++i) {
    CHECK(after[i] == Approx(centre[i]).epsilon(1e-6));
    for (int k = 0; k < 3; ++k) CHECK(got[i][k] == Approx(expected[i][k]).margin(1e-5));
  }
  for (const glm::dvec3 direction :
       {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::normalize(glm::dvec3(1, -3, 2))}) {
    CHECK(colour(after, glm::dmat3(turn) * direction) ==
          Approx(colour(before, direction)).margin(1e-5));
  }
}

TEST_CASE("placement: half a turn is exact") {
  const glm::dmat4 half_turn = glm::scale(glm::dmat4(1), glm::dvec3(-1, -1, 1));
  const Slots before = some_slots();
  Slots after = before;
  const Placement placement = *Placement::of(half_turn);
  placement.apply(3, after.data());
  CHECK(after[0] == -before[0]);
  CHECK(after[2] == before[2]);
  CHECK(after[rest_slot(3, 0, 0)] == -before[rest_slot(3, 0, 0)]);
  CHECK(after[rest_slot(3, 0, 1)] == before[rest_slot(3, 0, 1)]);
  placement.apply(3, after.data());
  for (int k = 0; k < 4; ++k) after[kRotationSlot + k] *= -1;  // the same rotation
  CHECK(after == before);
}

TEST_CASE("placement: none for shear, mirrors and scales that differ") {
  CHECK_FALSE(Placement::of(glm::scale(glm::dmat4(1), glm::dvec3(1, 1, 2))));
  CHECK_FALSE(Placement::of(glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1))));
  CHECK_FALSE(Placement::of(glm::scale(glm::dmat4(1), glm::dvec3(0))));
  glm::dmat4 shear(1);
  shear[1][0] = 0.5;
  CHECK_FALSE(Placement::of(shear));
}

TEST_CASE("placement: half of all names of axes turn, the others mirror or name an axis twice") {
  int turning = 0;
  const std::string letters = "rludfb";
  for (const char x : letters) {
    for (const char y : letters) {
      for (const char z : letters) {
        const std::string axes{x, y, z};
        const auto placement = Placement::from_axes(axes);
        turning += placement ? 1 : 0;
        if (!placement) continue;
        // The centre (1, 2, 3) lies one step along the first axis, and so on.
        Slots slots = some_slots();
        for (int i = 0; i < 3; ++i) slots[kMeanSlot + i] = static_cast<float>(i + 1);
        placement->apply(0, slots.data());
        for (int i = 0; i < 3; ++i) {
          const std::size_t at = letters.find(axes[static_cast<std::size_t>(i)]);
          const bool negative = axes[static_cast<std::size_t>(i)] == 'l' ||
                                axes[static_cast<std::size_t>(i)] == 'u' ||
                                axes[static_cast<std::size_t>(i)] == 'b';
          CHECK(slots[kMeanSlot + at / 2] == static_cast<float>(negative ? -i - 1 : i + 1));
        }
      }
    }
  }
  CHECK(turning == 24);
  for (const char* none : {"", "rd", "rdfx", "RUB", "rux"}) CHECK_FALSE(Placement::from_axes(none));
}
