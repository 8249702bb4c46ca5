// The readers of each layout: what they look for, and what they give. Conventions: README.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/dataset/dataset.h"
#include "algorithm/dataset/stated_view.h"

namespace sgs {

// All readers throw InputError with file, entry, what was found and what was expected: a file that
// is missing or damaged, a value that is not finite or means nothing, a view without an image.

// A sparse model, binary before text, in sparse/0 or sparse; images in images. Models in
// colmap/sparse/0, in 0 or in the folder itself lie beside other layouts too: holds_colmap_aside().
bool holds_colmap(const std::string& folder);
bool holds_colmap_aside(const std::string& folder);
StatedDataset read_colmap(const std::string& folder);

// transforms_train.json, and transforms_test.json where there is one: NeRF's synthetic scenes.
bool holds_split_transforms(const std::string& folder);
StatedDataset read_split_transforms(const std::string& folder);

// transforms.json, as instant-ngp and nerfstudio write it.
bool holds_transforms(const std::string& folder);
StatedDataset read_transforms(const std::string& folder);

// Such a document by itself, read from the file `path`: all frames in their order.
StatedDataset frames_of_transforms(const nlohmann::ordered_json& document, const std::string& path);

// cameras.json, as the original writes it; images beside it or in images.
bool holds_cameras_json(const std::string& folder);
StatedDataset read_cameras_json(const std::string& folder);

// intrinsics.txt with pose and rgb.
bool holds_nsvf(const std::string& folder);
StatedDataset read_nsvf(const std::string& folder);

// The points with colours that nerfstudio keeps of structure from motion, a PLY file: reads x y z
// of any type and red green blue as uchar of the element `vertex`, which comes first, in text or
// binary of either byte order; other properties and what follows are skipped. Throws InputError:
// not a PLY, another element first, a property that is missing, a list or of another type, a file
// cut off, a number that is none or too large.
std::vector<SfmPoint> read_points_ply(const std::string& path);

// points3D.ply or points3d.ply in `folder`, where it is there.
std::optional<std::string> points_file_in(const std::string& folder);

}  // namespace sgs
