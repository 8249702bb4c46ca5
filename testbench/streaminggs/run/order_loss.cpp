// The chain of pictures from the reference to the frame.
#include "testbench/streaminggs/run/order_loss.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "algorithm/image/quality.h"
#include "algorithm/render/reference_renderer.h"

namespace sgs {

OrderLoss order_loss(const Image* reference, const Image& decoded_reference,
                     const GoldenFrame& golden, const Image& frame) {
  if (golden.missed > 0 && !golden.in_order) {
    throw std::logic_error("golden frame: splats were missed, and no picture tells which");
  }
  OrderLoss loss;
  loss.in_order = golden.missed > 0 ? golden.in_order() : decoded_reference;
  // An order that loses nothing gives the reference picture.
  loss.exactly = !golden.computed_exactly ? golden.image
                 : loses_order(golden)    ? golden.computed_exactly()
                                          : decoded_reference;
  std::vector<const Image*> chain = {&decoded_reference, &loss.in_order, &loss.exactly,
                                     &golden.image, &frame};
  if (reference != nullptr) chain.insert(chain.begin(), reference);
  const std::vector<ErrorPart> parts = error_parts(chain);
  auto part = parts.begin();
  if (reference != nullptr) loss.encoding = *part++;
  loss.missed = *part++;
  loss.misordered = *part++;
  if (golden.computed_exactly) loss.arithmetic = *part;
  loss.pixel_format = *++part;
  return loss;
}

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
