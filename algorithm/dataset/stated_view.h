// What the files of a data set state, before images and cameras are brought together.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/dataset/dataset.h"

namespace sgs {

struct Intrinsics {
  int width = 0, height = 0;                  // px, from 1; the image may have another size
  double focal_x = 0, focal_y = 0;            // px
  std::optional<glm::dvec2> principal_point;  // px from the top left corner; else the middle
};

// Axes as in Camera.
struct Pose {
  glm::dvec3 position{0.0};
  glm::dmat3 world_from_camera{1.0};
};

struct StatedView {
  std::string where;  // file and entry, for messages
  std::string name, image_path;
  ImageHeader image;
  Intrinsics intrinsics;
  Pose pose;
  Split split = Split::kTrain;  // where the data set has a split
};

struct StatedDataset {
  std::vector<std::string> files;  // of the data set, but its images
  std::vector<StatedView> views;
  SplitBy split_by = SplitBy::kEveryEighth;
  std::string tests_from;  // file and entry that name the test views, where there is a split
  int left_out = 0;
  std::vector<SfmPoint> points;
  std::optional<Extent> bounds;
};

}  // namespace sgs
