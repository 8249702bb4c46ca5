// The check that two pictures can be compared, and the comparison of two pixels.
#include "algorithm/image/image_pair.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "algorithm/input_error.h"

namespace sgs {
namespace {

double channel_error(float a, float b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0;
  const double error = std::abs(static_cast<double>(a) - static_cast<double>(b));
  return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
}

}  // namespace

double pixel_error(const glm::vec3& a, const glm::vec3& b) {
  return std::max({channel_error(a.x, b.x), channel_error(a.y, b.y), channel_error(a.z, b.z)});
}

void check_same_size(const Image& a, const Image& b) {
  if (a.width == b.width && a.height == b.height && !a.pixels.empty() &&
      a.pixels.size() == b.pixels.size()) {
    return;
  }
  throw InputError(fmt::format(
      "comparing images: sizes {}x{} and {}x{}, expected the same size and at least one pixel",
      a.width, a.height, b.width, b.height));
}

}  // namespace sgs
