// A sparse model of COLMAP: cameras, images, points (colmap.github.io/format.html).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithm/dataset/stated_view.h"

namespace sgs {

// A camera as the file has it: whether it can be used is asked of those that images have.
struct ColmapCamera {
  std::string where;  // file and entry, for messages
  std::string model;
  std::uint64_t width = 0, height = 0;
  std::vector<double> parameters;  // as many as the model has
};

struct ColmapImage {
  std::string where;  // file and entry, for messages
  std::string name;   // path below the folder of images
  Pose pose;
  std::uint32_t camera_id = 0;
};

struct ColmapModel {
  std::map<std::uint32_t, ColmapCamera> cameras;  // by their id
  std::vector<ColmapImage> images;
};

// Reads cameras.bin and images.bin of `folder`, or points3D.bin. Both throw InputError with file,
// entry or byte, what was found and what was expected: also counts that the file cannot hold, bytes
// after the last record, a number of a camera model that COLMAP has not, an id twice.
ColmapModel read_colmap_binary(const std::string& folder);
std::vector<SfmPoint> read_colmap_points_binary(const std::string& folder);

// The same of cameras.txt and images.txt, and points3D.txt. The line of points behind an image may
// be missing: whatever stands there is points, another image, or refused.
ColmapModel read_colmap_text(const std::string& folder);
std::vector<SfmPoint> read_colmap_points_text(const std::string& folder);

// Both make their models by what follows.

// Throws InputError that begins with camera.where: its id a second time.
void add_colmap_camera(ColmapModel& model, std::uint32_t id, ColmapCamera camera);

// The camera models (colmap.github.io/cameras.html; src/colmap/sensor/models.h).

// Its name by its number in binary files. Throws InputError that begins with `where`: no such
// number.
std::string colmap_model_name(std::int32_t number, const std::string& where);

// Numbers that a camera of this model has; nothing of a model that is not COLMAP's.
std::optional<int> colmap_parameter_count(std::string_view model);

// Throws InputError that begins with camera.where: a size that is no number of px from 1, a
// parameter that is not finite. A model that is not read is one of LensKind::kOther.
Intrinsics colmap_intrinsics(const ColmapCamera& camera);

}  // namespace sgs
