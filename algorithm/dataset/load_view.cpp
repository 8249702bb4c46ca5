// Reading and shrinking of load_view.h.
#include "algorithm/dataset/load_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithm/image/photograph.h"
#include "algorithm/input_error.h"
#include "algorithm/scene/cameras.h"

namespace sgs {

Camera downscaled_camera(const DatasetView& view, double downscale) {
  if (!(downscale >= 1 && std::isfinite(downscale))) {
    throw InputError(
        fmt::format("view '{}': downscale {}, expected a number from 1", view.name, downscale));
  }
  const auto smaller = [downscale](int px) {
    return std::max(1, static_cast<int>(std::lround(px / downscale)));
  };
  return scaled_to(view.camera, smaller(view.camera.width), smaller(view.camera.height));
}

RgbaImage load_view(const DatasetView& view, double downscale) {
  const Camera camera = downscaled_camera(view, downscale);
  RgbaImage image = read_photograph(view.image_path);
  if (image.width != view.file.width || image.height != view.file.height) {
    throw InputError(fmt::format("{}: got {}x{} px, expected {}x{} as when the data set was opened",
                                 view.image_path, image.width, image.height, view.file.width,
                                 view.file.height));
  }
  if (view.used_px.x != image.width || view.used_px.y != image.height) {
    image = cropped(image, view.crop_px.x, view.crop_px.y, view.used_px.x, view.used_px.y);
  }
  if (image.width == camera.width && image.height == camera.height) return image;
  return area_averaged(image, camera.width, camera.height);
}

}  // namespace sgs
