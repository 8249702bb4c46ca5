// A second reference picture, where it can be another.
#include "testbench/streaminggs/run/file_order.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "algorithm/image/quality.h"
#include "algorithm/render/tied_depths.h"

namespace sgs {

std::optional<FileOrderDifference> file_order_difference(const PreparedScene& scene,
                                                         const View<float>& view,
                                                         const glm::vec3& background,
                                                         const Image& reference) {
  const auto& file_indices = scene.stored.file_indices;
  if (!file_indices) return {};
  const std::vector<char> tiles = tiles_of_ties(view, scene.given(), *file_indices);
  if (std::find(tiles.begin(), tiles.end(), 1) == tiles.end()) {
    return FileOrderDifference{std::numeric_limits<double>::infinity()};
  }
  const Image picture =
      picture_by_ranks(view, scene.given(), *file_indices, background, tiles, reference);
  return FileOrderDifference{psnr_db(reference, picture), max_abs_error(reference, picture),
                             differing_pixels(reference, picture)};
}

}  // namespace sgs
