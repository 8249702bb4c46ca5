// The pictures that a tuning compares with: photographs of a data set, or the scene's own reference
// pictures.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "algorithm/dataset/dataset.h"
#include "algorithm/scene/camera.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/rects.h"
#include "algorithm/train/photographs.h"

namespace sgs {

struct TuningViews {
  std::unique_ptr<const Dataset> dataset;  // the photographs are read from it
  std::vector<Camera> cameras;             // one for each view that is tuned on
  Photographs tune, test;                  // loaded
  std::string says;                        // a line for the terminal
};

// The views of a data set that has views to test with.
TuningViews views_of_dataset(Dataset dataset);

// The pictures that `cloud` gives from `cameras` in the reference order: of every eighth, from the
// first on, to test with and of the others to tune on; one camera serves for both. With
// between > 0 all of them are to test with, and so many between them (photographs.h), drawn by
// seed, are tuned on. pictures: what to call them on the terminal.
TuningViews views_of_scene(const std::string& pictures, const ActivatedCloud& cloud,
                           const std::vector<Camera>& cameras, std::uint32_t between,
                           std::uint64_t seed);

// Sizes of the pictures that are tuned on, in px.
std::vector<PixelSize> frame_sizes(const TuningViews& views);

}  // namespace sgs
