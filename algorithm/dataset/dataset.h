// Photographs with the cameras that took them: what a scene is trained from.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/dataset/lens.h"
#include "algorithm/image/image.h"
#include "algorithm/scene/camera.h"
#include "algorithm/scene/describe.h"

namespace sgs {

enum class Split { kTrain, kTest };

// The source of the split: the data set, or every eighth view.
enum class SplitBy { kDataset, kEveryEighth };

struct DatasetView {
  std::string name;        // path of the image as the data set has it, without extension
  std::string image_path;  // PNG, JPEG, WebP or TIFF
  std::string mask_path;   // black where a pixel counts for nothing; empty where all count
  ImageHeader file;        // as the image lies in its file
  // The camera of the file, whatever size the data set states, as many times smaller as the data
  // set was opened. camera.id is the view's number in Dataset::views, camera.name its name.
  Camera camera;
  glm::ivec2 used_px{0};  // size of the file or, through a lens, of the picture that is made of it
  LensProjection taken;
  double seen = 1;  // share of the file's pixels that are used
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
  std::vector<std::string> files;  // its own, but the images
  std::vector<DatasetView> views;  // by name; one or more of Split::kTrain
  SplitBy split_by = SplitBy::kDataset;
  std::string tests_from;        // file and entry that name the test views, where it has a split
  int left_out = 0;              // views that are neither for training nor for testing: validation
  std::vector<SfmPoint> points;  // empty where the layout brings none
  std::optional<Extent> bounds;  // region to be seen, world frame, where the layout states it
  // What else a user wants to know of the reading: lenses, masks, names that say nothing. Each a
  // title and a sentence.
  std::vector<std::pair<std::string, std::string>> notes;
};

// The choices of who opens a data set.
struct DatasetOptions {
  double downscale = 1;  // from 1
  // A layout by its key: colmap, nerf-synthetic, transforms, cameras or nsvf; empty: the one that
  // is there.
  std::string layout;
  // The folder to take instead of `images`; empty: images, or the one of images_2, images_4 and
  // images_8 that is there without it.
  std::string images;
};

// Numbers of the views of `split`, rising.
std::vector<int> views_of(const Dataset& dataset, Split split);

// Reads cameras, points and the headers of all images below `folder`; no pixel yet. Views are
// `downscale` times smaller than their files, as downscaled_camera() makes them. The layout is
// recognised by the files that are there. Test views are the data set's own, or every 8th in the
// order of names, from the first, as the original takes them. Throws InputError: no such folder, no
// layout or more than one (says what was looked for), what the readers in layout.h and
// complete_view() refuse, a name twice, no view to train from, a downscale that is not from 1.
Dataset open_dataset(const std::string& folder, const DatasetOptions& options = {});

// Throws InputError where there is none, with what was to name them.
void require_test_views(const Dataset& dataset);

// The view's camera for an image `downscale` times smaller still, each side rounded, at least 1 px.
// Throws InputError unless downscale is finite and from 1.
Camera downscaled_camera(const DatasetView& view, double downscale);

// The view's image as that camera sees it, each pixel the mean over its area of the file. Throws
// InputError as read_photograph() and downscaled_camera() do, and when the file has changed its
// size since the data set was opened. Several threads may load at once.
RgbaImage load_view(const DatasetView& view, double downscale = 1);

// For each pixel of load_view()'s image whether it counts: 0 where black of the mask has a part in
// it. Empty where the view has no mask. Throws InputError as load_view() does, for a mask of
// another shape than its image, and for one that leaves no pixel.
std::vector<std::uint8_t> load_mask(const DatasetView& view, double downscale = 1);

}  // namespace sgs
