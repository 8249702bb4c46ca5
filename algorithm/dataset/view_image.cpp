// Sizes, and the reading of images and masks.
#include "algorithm/dataset/view_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "algorithm/files/input_error.h"
#include "algorithm/image/image_io.h"

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

}  // namespace

bool of_one_shape(int width, int height, int stated_width, int stated_height) {
  const auto factor = [](int px, int stated_px, int off_px) {
    return static_cast<double>(px + off_px) / stated_px;
  };
  return std::max(factor(width, stated_width, -1), factor(height, stated_height, -1)) <
         std::min(factor(width, stated_width, 1), factor(height, stated_height, 1));
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
    out.used_px = {file.width, file.height};
    out.camera = camera_of(view, stated);
    out.camera.width = file.width;
    out.camera.height = file.height;
    out.camera.focal_x = out.taken.focal_px.x;
    out.camera.focal_y = out.taken.focal_px.y;
    out.camera.principal_offset *= scale;
  } else {
    const PinholePicture picture = pinhole_picture(out.taken, file.width, file.height, view.where);
    out.used_px = picture.size_px;
    out.seen = picture.seen;
    out.camera = camera_of(view, {picture.size_px.x, picture.size_px.y, out.taken.focal_px,
                                  0.5 * glm::dvec2(picture.size_px)});
  }
  out.camera.name = out.name;
  return out;
}

namespace {

RgbaImage checked(const DatasetView& view, RgbaImage image) {
  if (image.width == view.file.width && image.height == view.file.height) return image;
  throw InputError(fmt::format("{}: got {}x{} px, expected {}x{} as when the data set was opened",
                               view.image_path, image.width, image.height, view.file.width,
                               view.file.height));
}

// image: of the file's size. Made a pinhole's, then averaged.
RgbaImage as_seen(const DatasetView& view, RgbaImage image, const Camera& camera) {
  if (!is_pinhole(view.taken.lens)) image = undistorted(image, view.taken, view.used_px);
  if (image.width == camera.width && image.height == camera.height) return image;
  return area_averaged(image, camera.width, camera.height);
}

// Alpha 1 where the mask is not black. Of the file's size, whatever size the mask has.
RgbaImage mask_of(const DatasetView& view) {
  const RgbaImage mask = read_photograph(view.mask_path);
  const int width = view.file.width, height = view.file.height;
  if (!of_one_shape(mask.width, mask.height, width, height)) {
    throw InputError(fmt::format("{}: got a mask of {}x{} px, expected the shape of {}, {}x{} px",
                                 view.mask_path, mask.width, mask.height, view.image_path, width,
                                 height));
  }
  RgbaImage counts(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto at = [](int px, int size, int of) {
        return static_cast<int>((static_cast<std::int64_t>(px) * of + of / 2) / size);
      };
      const glm::vec4& pixel = mask.at(at(x, width, mask.width), at(y, height, mask.height));
      if (pixel.x > 0 || pixel.y > 0 || pixel.z > 0) counts.at(x, y).w = 1;
    }
  }
  return counts;
}

}  // namespace

RgbaImage load_view(const DatasetView& view, double downscale) {
  const Camera camera = downscaled_camera(view, downscale);
  return as_seen(view, checked(view, read_photograph(view.image_path)), camera);
}

std::vector<std::uint8_t> load_mask(const DatasetView& view, double downscale) {
  constexpr float kWhole = 0.999F;  // but for rounding, no black has a part in it
  if (view.mask_path.empty()) return {};
  const RgbaImage seen = as_seen(view, mask_of(view), downscaled_camera(view, downscale));
  std::vector<std::uint8_t> counts;
  counts.reserve(seen.pixels.size());
  for (const glm::vec4& pixel : seen.pixels) counts.push_back(pixel.w >= kWhole ? 1 : 0);
  if (std::find(counts.begin(), counts.end(), 1) == counts.end()) {
    throw InputError(
        fmt::format("{}: got a mask that leaves no pixel, expected one or more that "
                    "are not black",
                    view.mask_path));
  }
  return counts;
}

}  // namespace sgs
