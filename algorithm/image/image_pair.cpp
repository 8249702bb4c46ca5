// The check that two pictures can be compared.
#include "algorithm/image/image_pair.h"

#include <fmt/format.h>

#include "algorithm/input_error.h"

namespace sgs {

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
