// The search for the file; sizes, limits and crops.
#include "algorithm/dataset/view_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "algorithm/files/input_error.h"
#include "algorithm/image/image_io.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 6> kExtensions = {".png", ".jpg", ".jpeg",
                                                    ".PNG", ".JPG", ".JPEG"};

bool is_there(const fs::path& path) {
  std::error_code unknown;
  return fs::exists(path, unknown) && !fs::is_directory(path, unknown);
}

std::vector<std::string> files_of(const std::vector<std::string>& folders,
                                  const std::string& name) {
  std::vector<std::string> found;
  for (const std::string& folder : folders) {
    const std::string path = (fs::path(folder) / name).lexically_normal().string();
    const bool known = std::find(found.begin(), found.end(), path) != found.end();
    if (is_there(path) && !known) found.push_back(path);  // an absolute name is in every folder
  }
  return found;
}

}  // namespace

FoundImage find_image(const std::vector<std::string>& folders, const std::string& name,
                      const std::string& where) {
  std::vector<std::string> found = files_of(folders, name);
  if (found.empty()) {
    for (const char* extension : kExtensions) {
      for (std::string& path : files_of(folders, name + extension)) {
        found.push_back(std::move(path));
      }
    }
  }
  if (found.empty()) {
    throw InputError(fmt::format(
        "{}: no image '{}' in {}, expected it there, or with .png, .jpg or .jpeg behind", where,
        name, join(folders, " or ")));
  }
  if (found.size() > 1) {
    throw InputError(fmt::format("{}: image '{}': got {}, expected one of them", where, name,
                                 join(found, " and ")));
  }
  return {found[0], read_photograph_header(found[0])};
}

std::string view_name(const std::string& name) {
  fs::path path = fs::path(name).lexically_normal();
  const std::string extension = path.extension().string();
  if (std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end()) {
    path.replace_extension();
  }
  return path.string();
}

namespace {

constexpr int kMostSidePx = 65536;  // sub-tile bounds are 16-bit numbers

void check_sizes(const StatedView& view) {
  const Intrinsics& stated = view.intrinsics;
  if (!of_one_shape(view.image.width, view.image.height, stated.width, stated.height)) {
    throw InputError(fmt::format(
        "{}: {} is {}x{} px, expected {}x{} px as its camera, or both sides by one factor",
        view.where, view.image_path, view.image.width, view.image.height, stated.width,
        stated.height));
  }
  if (std::max(view.image.width, view.image.height) > kMostSidePx) {
    throw InputError(fmt::format("{}: {} is {}x{} px, expected at most {} a side", view.where,
                                 view.image_path, view.image.width, view.image.height,
                                 kMostSidePx));
  }
}

void check_numbers(const StatedView& view) {
  const Intrinsics& stated = view.intrinsics;
  for (const double focal_px : {stated.focal_x, stated.focal_y}) {
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

DatasetView complete_view(const StatedView& view) {
  check_sizes(view);
  check_numbers(view);
  const Intrinsics& stated = view.intrinsics;
  const glm::dvec2 scale(static_cast<double>(view.image.width) / stated.width,
                         static_cast<double>(view.image.height) / stated.height);
  const glm::dvec2 principal =
      scale * stated.principal_point.value_or(glm::dvec2(stated.width, stated.height) * 0.5);
  const Cut x = cut_around(view, "x", principal.x, view.image.width);
  const Cut y = cut_around(view, "y", principal.y, view.image.height);

  DatasetView out;
  out.name = view.name;
  out.image_path = view.image_path;
  out.file = view.image;
  out.crop_px = {x.first, y.first};
  out.used_px = {x.size, y.size};
  out.split = view.split;
  out.camera.name = view.name;
  out.camera.width = x.size;
  out.camera.height = y.size;
  out.camera.focal_x = stated.focal_x * scale.x;
  out.camera.focal_y = stated.focal_y * scale.y;
  out.camera.position = view.pose.position;
  out.camera.world_from_camera = view.pose.world_from_camera;
  return out;
}

}  // namespace sgs
