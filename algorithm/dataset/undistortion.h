// Photographs taken through a lens, made those of a pinhole.
#pragma once

#include <glm/vec2.hpp>
#include <string>

#include "algorithm/dataset/lens.h"
#include "algorithm/image/image.h"

namespace sgs {

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
