// The data sets around a file that is fuzzed: read every time, so of few views and few pixels.
#pragma once

#include "tests/algorithm/dataset/made_datasets.h"

namespace sgs::test {

inline PhotographedScene few_views() {
  PhotographedScene scene = made_scene();
  scene.cameras.resize(4);  // of a NeRF synthetic one the first three are to test with
  scene.points.resize(2);
  scene.width = 16;
  scene.height = 12;
  scene.principal = {8, 6};
  return scene;
}

// Names its points in points.ply, which it has not.
inline void write_transforms_with_points(const std::string& folder,
                                         const PhotographedScene& scene) {
  write_transforms(folder, scene);
  write_file(folder, "transforms.json",
             R"({"fl_x": 9, "w": 16, "h": 12, "ply_file_path": "points.ply", "frames": [
 {"file_path": "images/shot_00.jpg", "transform_matrix":
  [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]},
 {"file_path": "images/shot_01.jpg", "transform_matrix":
  [[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}]})");
}

}  // namespace sgs::test
