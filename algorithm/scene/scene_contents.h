// What a scene file holds, and how it is to be read, whatever its form.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

struct SceneReadOptions {
  // Leave out Gaussians with NaN, infinite values, values beyond gaussian_cloud.h or a zero
  // quaternion instead of refusing the file.
  bool drop_invalid = false;
  // Of a scene with levels of detail, 0 the finest, which is also the default.
  std::optional<std::uint32_t> level = {};
  // Where x, y and z of the file point: r or l, d or u, f or b, as in "rub". The scene is turned
  // to right, down, forward, as the cameras of its photographs stand. Empty: as the file states,
  // else as it is stored.
  std::string axes = {};
};

struct SceneContents {
  GaussianCloud cloud;
  std::uint64_t dropped_invalid = 0;  // Gaussians left out because of drop_invalid
  std::string axes = {};  // as the file states them, see SceneReadOptions; empty: it does not
  // What was changed on reading, and what the file holds that no picture here shows. A sentence
  // each.
  std::vector<std::string> notes = {};
};

}  // namespace sgs
