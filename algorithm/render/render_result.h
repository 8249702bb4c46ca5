// What every renderer returns: the picture and, per pixel, what is left of the light and how many
// splats were blended.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/image/image.h"

namespace sgs {

struct RenderResult {
  Image image;                              // colour composed over the background
  std::vector<float> transmittance;         // [height, width]
  std::vector<std::uint32_t> contributors;  // [height, width] splats blended
};

}  // namespace sgs
