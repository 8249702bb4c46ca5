// Photographs with the cameras that took them: what a scene is trained from.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/image/image_header.h"
#include "algorithm/scene/camera.h"
#include "algorithm/scene/describe.h"

namespace sgs {

enum class Split { kTrain, kTest };

// Where the split comes from.
enum class SplitBy { kDataset, kEveryEighth };

struct DatasetView {
  std::string name;        // path of the image as the data set has it, without extension
  std::string image_path;  // PNG or JPEG
  ImageHeader file;        // as the image lies in its file
  // Of the image as it is used: at the size of the file, whatever size the data set states, less
  // the pixels that were cut off to have the principal point in the middle. camera.id is the view's
  // number in Dataset::views, camera.name its name.
  Camera camera;
  glm::ivec2 crop_px{0};  // top left pixel of what is used
  Split split = Split::kTrain;
};

// A point that structure from motion found.
struct SfmPoint {
  glm::vec3 position{0.0f};  // world frame
  glm::vec3 colour{0.0f};    // 0 to 1
};

struct Dataset {
  std::string folder;
  std::string layout;              // for people: "COLMAP", "NSVF", ...
  std::vector<DatasetView> views;  // by name; one or more of Split::kTrain
  SplitBy split_by = SplitBy::kDataset;
  int left_out = 0;              // views that are neither for training nor for testing: validation
  std::vector<SfmPoint> points;  // empty where the layout brings none
  std::optional<Extent> bounds;  // of what is to be seen, world frame, where the layout states them
};

// Numbers of the views of `split`, rising.
std::vector<int> views_of(const Dataset& dataset, Split split);

}  // namespace sgs
