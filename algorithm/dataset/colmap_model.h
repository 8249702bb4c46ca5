// A sparse model of COLMAP: cameras, images, points (colmap.github.io/format.html).
#pragma once

#include <cstdint>
#include <glm/ext/vector_uint3_sized.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "algorithm/dataset/stated_view.h"

namespace sgs {

struct ColmapImage {
  std::string where;  // file and entry, for messages
  std::string name;   // path below the folder of images
  Pose pose;
  std::uint32_t camera_id = 0;
};

struct ColmapModel {
  std::map<std::uint32_t, Intrinsics> cameras;  // by their id
  std::vector<ColmapImage> images;
  std::vector<SfmPoint> points;
};

// Reads cameras.bin, images.bin and points3D.bin of `folder`. Throws InputError with file, entry or
// byte, what was found and what was expected: also counts that the file cannot hold, bytes after
// the last record, camera models but PINHOLE and SIMPLE_PINHOLE, an id twice.
ColmapModel read_colmap_binary(const std::string& folder);

// The same of cameras.txt, images.txt and points3D.txt.
ColmapModel read_colmap_text(const std::string& folder);

// Both make their models by these. All throw InputError that begins with `where`.

// Numbers that a camera of this model has. Refuses models other than PINHOLE and SIMPLE_PINHOLE.
int colmap_parameter_count(std::string_view model, const std::string& where);

// parameters: as many as the model has. Refuses sizes that are no number of px from 1.
Intrinsics colmap_intrinsics(std::uint64_t width, std::uint64_t height,
                             const std::vector<double>& parameters, const std::string& where);

void add_colmap_camera(ColmapModel& model, std::uint32_t id, const Intrinsics& camera,
                       const std::string& where);

}  // namespace sgs
