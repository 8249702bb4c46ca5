// A second reference picture, where it can be another.
#include "testbench/streaminggs/file_order.h"

#include <tbb/parallel_sort.h>

#include <limits>
#include <numeric>
#include <vector>

#include "algorithm/image/quality.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/render/tied_depths.h"
#include "algorithm/splat/reorder.h"

namespace sgs {
namespace {

// Slots in the order of the file.
std::vector<std::uint32_t> slots_by_file(const std::vector<std::uint32_t>& file_indices) {
  std::vector<std::uint32_t> slots(file_indices.size());
  std::iota(slots.begin(), slots.end(), 0U);
  tbb::parallel_sort(slots.begin(), slots.end(), [&](std::uint32_t a, std::uint32_t b) {
    return file_indices[a] < file_indices[b];
  });
  return slots;
}

}  // namespace

std::optional<FileOrderDifference> file_order_difference(const PreparedScene& scene,
                                                         const View<float>& view,
                                                         const glm::vec3& background,
                                                         const Image& reference) {
  const auto& file_indices = scene.stored.file_indices;
  if (!file_indices) return {};
  if (!reorders_ties(view, scene.given(), *file_indices)) {
    return FileOrderDifference{std::numeric_limits<double>::infinity()};
  }
  const ActivatedCloud in_file = reordered(scene.given(), slots_by_file(*file_indices));
  const Image picture = render_reference(view, in_file, background).image;
  return FileOrderDifference{psnr_db(reference, picture), max_abs_error(reference, picture),
                             differing_pixels(reference, picture)};
}

}  // namespace sgs
