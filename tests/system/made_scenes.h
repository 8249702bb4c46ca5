// Small scenes of which is known by construction what a frame does not need.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "tests/support/scratch_folder.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {

// A ball of one colour.
struct Ball {
  glm::vec3 mean;
  float scale = 0.02F;
  glm::vec3 dc{1, 0.5F, 0};  // SH of degree 0
  bool visible = true;       // else of an opacity below 1/255
};

// No light from anywhere: before nothing it changes no pixel.
constexpr glm::vec3 kBlack{-5};

// Of opacity 128/255, to the bit: codebooks keep it as it is.
GaussianCloud cloud_of(const std::vector<Ball>& balls);
// With bands up to `degree` that add nothing.
GaussianCloud padded(GaussianCloud cloud, int degree);

// The centre of a pixel of the made scenes' camera at a depth: it looks along z from the origin, 64
// px wide and high, 64 px of focal length.
glm::vec3 at_pixel(float x, float y, float depth);

// A cloud and that camera as files.
class MadeScene {
 public:
  explicit MadeScene(const GaussianCloud& cloud);
  Arguments arguments(const char* machine, const Arguments& set) const;

 private:
  ScratchFolder folder_;
};

}  // namespace sgs::test
