#include "algorithm/dataset/lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

constexpr double kNearAxis = 1e-9;  // as close to it the quotients of angles are at their limits

glm::dvec2 perspective(const Lens& lens, const glm::dvec2& at) {
  const auto& k = lens.k;
  const double r2 = glm::dot(at, at);
  const double radial =
      (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]))) / (1 + r2 * (k[3] + r2 * (k[4] + r2 * k[5])));
  const double both = 2 * at.x * at.y;
  return at * radial + glm::dvec2(lens.p1 * both + lens.p2 * (r2 + 2 * at.x * at.x),
                                  lens.p1 * (r2 + 2 * at.y * at.y) + lens.p2 * both);
}

double field_of_view(double angle, double r) {
  const double slope = 2 * std::tan(0.5 * angle);
  return r < kNearAxis ? slope / angle : std::atan(r * slope) / (r * angle);
}

double fisheye(const Lens& lens, double r) {
  const auto& k = lens.k;
  if (r < kNearAxis) return 1;
  const double angle = std::atan(r), a2 = angle * angle;
  return angle * (1 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3])))) / r;
}

}  // namespace

bool is_pinhole(const Lens& lens) {
  if (lens.kind == LensKind::kFisheye || lens.kind == LensKind::kOther) return false;
  return lens.p1 == 0 && lens.p2 == 0 &&
         std::all_of(lens.k.begin(), lens.k.end(), [](double k) { return k == 0; });
}

glm::dvec2 distorted(const Lens& lens, const glm::dvec2& at) {
  if (is_pinhole(lens)) return at;
  const double r = glm::length(at);
  switch (lens.kind) {
    case LensKind::kDivision:
      return at * (2 / (1 + std::sqrt(1 - 4 * lens.k[0] * r * r)));
    case LensKind::kFov:
      return at * field_of_view(lens.k[0], r);
    case LensKind::kFisheye:
      return at * fisheye(lens, r);
    default:
      return perspective(lens, at);
  }
}

void check_lens(const Lens& lens, const std::string& where) {
  if (lens.kind == LensKind::kOther) {
    throw InputError(
        fmt::format("{}: got the camera model {}, expected a pinhole, OPENCV, RADIAL, FULL_OPENCV, "
                    "FOV, DIVISION, "
                    "OPENCV_FISHEYE, RADIAL_FISHEYE, FISHEYE or a SIMPLE_ one of these",
                    where, lens.model));
  }
  std::array<double, 8> numbers{lens.p1, lens.p2};
  std::copy(lens.k.begin(), lens.k.end(), numbers.begin() + 2);
  for (const double number : numbers) {
    if (!std::isfinite(number)) {
      throw InputError(fmt::format("{}: {}: got the coefficient {}, expected finite numbers", where,
                                   lens.model, number));
    }
  }
}

}  // namespace sgs
