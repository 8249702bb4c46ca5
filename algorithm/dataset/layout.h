// The layouts of data sets: the choice of one by the files that are there, and what each reader
// looks for and gives. Conventions: README.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/dataset/stated_view.h"

namespace sgs {

struct Layout {
  const char* name;        // for people
  const char* key;         // of DatasetOptions
  const char* looked_for;  // file or files
  bool (*holds)(const std::string& folder);
  StatedDataset (*read)(const std::string& folder);
};

// The layout with this key, or where it is empty the only one that `folder` holds; a model of
// COLMAP that may lie beside other layouts counts where nothing else is there. Throws InputError:
// no such folder, no layout (says what was looked for) or more than one (names them), an unknown
// key, a key of a layout that is not there.
const Layout& layout_of(const std::string& folder, const std::string& key);

// All readers throw InputError with file, entry, what was found and what was expected: a file that
// is missing or damaged, a value that is not finite or means nothing.

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

// cameras.json, as the original writes it; images beside it or in images.
bool holds_cameras_json(const std::string& folder);
StatedDataset read_cameras_json(const std::string& folder);

// intrinsics.txt with pose and rgb.
bool holds_nsvf(const std::string& folder);
StatedDataset read_nsvf(const std::string& folder);

// A document by itself, read from the file `path`; views in its order. transforms.json; an array of
// {id, img_name, width, height, position, rotation, fx, fy} with cx and cy or without, or an object
// {cameras, closed} with such an array; a camera path of nerfstudio: camera_to_world, 16 numbers
// row by row, and fov, the degrees that render_height spans.
StatedDataset views_of_transforms(const nlohmann::ordered_json& document, const std::string& path);
StatedDataset views_of_cameras_json(const nlohmann::ordered_json& document,
                                    const std::string& path);
StatedDataset views_of_camera_path(const nlohmann::ordered_json& document, const std::string& path);

// The points with colours that nerfstudio keeps of structure from motion, a PLY file: reads x y z
// of any type and red green blue as uchar of the element `vertex`, which comes first, in text or
// binary of either byte order; other properties and what follows are skipped. Throws InputError:
// not a PLY, another element first, a property that is missing, a list or of another type, a file
// cut off, a number that is none or too large.
std::vector<SfmPoint> read_points_ply(const std::string& path);

// points3D.ply or points3d.ply in `folder`, where it is there.
std::optional<std::string> points_file_in(const std::string& folder);

}  // namespace sgs
