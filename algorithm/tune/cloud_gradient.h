// The derivatives of a loss with respect to the parameters of the Gaussians that a picture shows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

// By rank: of the r-th Gaussian that is blended into at least one pixel, or that has been given a
// row. All others' are 0.
struct CloudGradient {
  std::vector<std::uint32_t> indices;  // in the cloud, ascending
  GaussianCloud parameters;            // dL/d of the file's parameters of the same name
  std::vector<glm::vec2> centres;      // dL/d of the centre on the screen, 1/px

  std::size_t size() const { return indices.size(); }
  void resize(std::size_t count, int sh_degree) {
    indices.resize(count);
    parameters.resize(count, sh_degree);
    centres.resize(count);
  }
  // These Gaussians get rows of zeros where they have none. more: ascending.
  void add_rows(const std::vector<std::uint32_t>& more);
};

}  // namespace sgs
