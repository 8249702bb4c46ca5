// The lens of a camera: where in the picture a ray ends.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <string>

namespace sgs {

enum class LensKind {
  kPerspective,  // OpenCV's: radial, a quotient of polynomials, and tangential; none is a pinhole
  kDivision,     // one coefficient (Fitzgibbon)
  kFov,          // one angle (Devernay and Faugeras)
  kFisheye,      // a polynomial of the angle from the axis
  kOther,        // one that is not read: equirectangular and others
};

struct Lens {
  std::string model = "PINHOLE";  // its name in the data set
  LensKind kind = LensKind::kPerspective;
  std::array<double, 6> k{};  // k1 to k6; of a field of view the angle, radians, of division k
  double p1 = 0, p2 = 0;
};

// True where distorted() changes nothing.
bool is_pinhole(const Lens& lens);

// The place of a ray, in focal lengths from the principal point. at: its x / z and y / z. NaN where
// the lens has no such ray. Formulas: OpenCV's documentation of calib3d;
// colmap.github.io/cameras.html.
glm::dvec2 distorted(const Lens& lens, const glm::dvec2& at);

// Throws InputError that begins with `where`: kOther, by name, or a coefficient that is not finite.
void check_lens(const Lens& lens, const std::string& where);

}  // namespace sgs
