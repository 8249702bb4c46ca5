// Sizes, limits and crops.
#include "algorithm/dataset/view_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "algorithm/files/input_error.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {
namespace {

constexpr int kMostSidePx = 65536;  // sub-tile bounds are 16-bit numbers

void check_sizes(const StatedView& view, const FoundImage& found, const Projection& stated) {
  const ImageHeader& image = found.header;
  if (!of_one_shape(image.width, image.height, stated.width, stated.height)) {
    throw InputError(fmt::format(
        "{}: {} is {}x{} px, expected {}x{} px as its camera, or both sides by one factor",
        view.where, found.path, image.width, image.height, stated.width, stated.height));
  }
  if (std::max(image.width, image.height) > kMostSidePx) {
    throw InputError(fmt::format("{}: {} is {}x{} px, expected at most {} a side", view.where,
                                 found.path, image.width, image.height, kMostSidePx));
  }
}

struct Cut {
  int first = 0, size = 0;  // px
};

// Along one axis: what to use of `size` px so that `principal` is in the middle.
Cut cut_around(const StatedView& view, const char* axis, double principal, int size) {
  const double off_px = principal - 0.5 * size;
  if (!(std::abs(off_px) < 0.25 * size)) {
    throw InputError(
        fmt::format("{}: principal point: got {} at {} px of {}, expected it in the middle half",
                    view.where, axis, principal, size));
  }
  if (std::abs(off_px) <= 0.5) return {0, size};
  const int less = static_cast<int>(std::lround(2 * std::abs(off_px)));
  return {off_px > 0 ? less : 0, size - less};
}

}  // namespace

bool of_one_shape(int width, int height, int stated_width, int stated_height) {
  const auto factor = [](int px, int stated_px, int off_px) {
    return static_cast<double>(px + off_px) / stated_px;
  };
  return std::max(factor(width, stated_width, -1), factor(height, stated_height, -1)) <
         std::min(factor(width, stated_width, 1), factor(height, stated_height, 1));
}

void check_camera(const StatedView& view, const Projection& stated) {
  check_lens(view.intrinsics.lens, view.where);
  for (const double focal_px : {stated.focal.x, stated.focal.y}) {
    if (!(focal_px > 0 && focal_px <= kMaxFocalPx)) {
      throw InputError(fmt::format("{}: focal length: got {}, expected px above 0, at most {}",
                                   view.where, focal_px, kMaxFocalPx));
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(view.pose.position[axis]) <= kMaxCoordinate)) {
      const glm::dvec3& at = view.pose.position;
      throw InputError(
          fmt::format("{}: position: got ({}, {}, {}), expected finite numbers of at most {}",
                      view.where, at.x, at.y, at.z, kMaxCoordinate));
    }
  }
}

DatasetView complete_view(const StatedView& view, const FoundImage& found) {
  const ImageHeader& file = found.header;
  const Projection stated = projection_of(view.intrinsics, file.width, file.height);
  check_sizes(view, found, stated);
  check_camera(view, stated);
  const glm::dvec2 scale(static_cast<double>(file.width) / stated.width,
                         static_cast<double>(file.height) / stated.height);

  DatasetView out;
  out.name = view_name(found.name);
  out.image_path = found.path;
  out.file = file;
  out.split = view.split;
  out.taken = {view.intrinsics.lens, stated.focal * scale, stated.centre * scale};
  if (is_pinhole(view.intrinsics.lens)) {
    const Cut x = cut_around(view, "x", out.taken.centre_px.x, file.width);
    const Cut y = cut_around(view, "y", out.taken.centre_px.y, file.height);
    out.crop_px = {x.first, y.first};
    out.used_px = {x.size, y.size};
    out.seen = static_cast<double>(x.size) / file.width * y.size / file.height;
  } else {
    const PinholePicture picture = pinhole_picture(out.taken, file.width, file.height, view.where);
    out.used_px = picture.size_px;
    out.seen = picture.seen;
  }
  out.camera.name = out.name;
  out.camera.width = out.used_px.x;
  out.camera.height = out.used_px.y;
  out.camera.focal_x = out.taken.focal_px.x;
  out.camera.focal_y = out.taken.focal_px.y;
  out.camera.position = view.pose.position;
  out.camera.world_from_camera = view.pose.world_from_camera;
  return out;
}

}  // namespace sgs
