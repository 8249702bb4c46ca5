// The lens of a camera: where in the picture a ray ends, and photographs taken through one, made
// those of a pinhole.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <string>

#include "algorithm/image/image.h"

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

// How a photograph was taken, in px of its file.
struct LensProjection {
  Lens lens;
  glm::dvec2 focal_px{0.0};
  glm::dvec2 centre_px{0.0};  // principal point, from the top left corner
};

// The widest field of view that a lens is made a pinhole of, along either side.
constexpr double kWidestFieldDegrees = 120;

// A pinhole's picture with the focal lengths of the lens and the principal point in its middle.
struct PinholePicture {
  glm::ivec2 size_px{0};
  double seen = 1;  // share of the file's pixels that are in it
};

// The largest one that lies all in a file of `width` x `height` px, where rays farther out end
// farther out, and in kWidestFieldDegrees. Its sides are as even or odd as the file's, so that
// pixels of a lens in the middle keep their places. Throws InputError that begins with `where`:
// what check_lens() refuses, a lens that leaves no pixel, one that makes four times the side.
PinholePicture pinhole_picture(const LensProjection& taken, int width, int height,
                               const std::string& where);

// That picture of `image`, which has the file's size, between its pixels by cubics.
RgbaImage undistorted(const RgbaImage& image, const LensProjection& taken,
                      const glm::ivec2& size_px);

}  // namespace sgs
