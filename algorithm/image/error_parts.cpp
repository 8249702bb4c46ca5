// Sums of products of differences.
#include "algorithm/image/error_parts.h"

#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "algorithm/image/quality.h"

namespace sgs {

std::vector<ErrorPart> error_parts(const std::vector<const Image*>& chain) {
  const Image& first = *chain.front();
  for (const Image* image : chain) check_same_size(first, *image);
  std::vector<ErrorPart> parts(chain.size() - 1);
  double whole = 0;
  for (std::size_t pixel = 0; pixel < first.pixels.size(); ++pixel) {
    const auto shown = [&](const Image& image) {
      return glm::dvec3(clamp_to_unit(image.pixels[pixel]));
    };
    const glm::dvec3 error = shown(*chain.back()) - shown(first);
    whole += glm::dot(error, error);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const glm::dvec3 step = shown(*chain[i + 1]) - shown(*chain[i]);
      parts[i].share += glm::dot(step, error);
      parts[i].alone += glm::dot(step, step);
    }
  }
  for (ErrorPart& part : parts) {
    part.share /= whole;
    part.alone /= whole;
  }
  return parts;
}

}  // namespace sgs
