// The error of a picture because of a machine's order and arithmetic. It is divided among missed
// splats, blends in the wrong order, and computations that differ from the reference.
#pragma once

#include <cstdint>
#include <optional>

#include "algorithm/image/image.h"
#include "algorithm/image/quality.h"
#include "algorithm/splat/view.h"
#include "modules/golden_frame.h"
#include "testbench/streaminggs/run/prepared_scene.h"

namespace sgs {

// The frame is up to five steps away from the reference picture, and its squared error is divided
// among them as quality.h says: the scene is encoded, splats are missed (`in_order` instead of
// the reference picture of the scene as encoded), what is left is blended in the wrong order
// (`exactly` instead of `in_order`), half precision and boxes round and cut (the golden picture
// instead of `exactly`), pixels are rounded.
struct OrderLoss {
  Image in_order;                     // everything that the order streams, blended by depth
  Image exactly;                      // as it comes, in the reference's arithmetic
  std::optional<ErrorPart> encoding;  // none where the original is not known
  ErrorPart missed, misordered;
  std::optional<ErrorPart> arithmetic;  // none where the machine computes as the reference
  ErrorPart pixel_format;
};

inline bool loses_order(const GoldenFrame& golden) { return golden.missed + golden.misordered > 0; }
inline bool is_lossy(const GoldenFrame& golden) {
  return loses_order(golden) || golden.computed_exactly;
}

// Computes the loss of a lossy frame. reference: the picture of the scene as given, null where it
// is not known; then the error counts from decoded_reference. decoded_reference: that of the scene
// as encoded. frame: `golden` in the frame buffer's format.
OrderLoss order_loss(const Image* reference, const Image& decoded_reference,
                     const GoldenFrame& golden, const Image& frame);

// The error of a picture because ties of depth are broken by storage slot. Renderers of the scene's
// file break them by place in the file.

// The reference picture in storage order against the one in the order of the file.
struct FileOrderDifference {
  double psnr_db;  // infinite where they are equal
  double max_abs_error = 0;
  std::uint64_t pixels = 0;  // pixels that differ in any bit of a channel's value
};

// reference: of scene.given(). The other picture is made only of tiles where some tie is broken
// otherwise; elsewhere both are the same by construction. None of a packed scene: its file's order
// is not known.
std::optional<FileOrderDifference> file_order_difference(const PreparedScene& scene,
                                                         const View<float>& view,
                                                         const glm::vec3& background,
                                                         const Image& reference);

}  // namespace sgs
