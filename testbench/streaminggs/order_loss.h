// What a lossy order cost a picture, divided between splats that it missed and blends in the wrong
// order.
#pragma once

#include <optional>

#include "algorithm/image/error_parts.h"
#include "algorithm/image/image.h"
#include "modules/golden_frame.h"

namespace sgs {

// The frame is four steps away from the reference picture, and its squared error is divided among
// them as error_parts.h says: the scene is encoded, splats are missed (`in_order` instead of the
// reference picture of the scene as encoded), what is left is blended in the wrong order (the
// golden picture instead of `in_order`), pixels are rounded.
struct OrderLoss {
  Image in_order;                     // everything that the order streams, blended by depth
  std::optional<ErrorPart> encoding;  // none where the original is not known
  ErrorPart missed, misordered, pixel_format;
};

inline bool is_lossy(const GoldenFrame& golden) { return golden.missed + golden.misordered > 0; }

// Of a lossy order. reference, decoded_reference: of the scene as given, null where it is not known
// (then the error counts from the latter), and as encoded. frame: `golden` in the frame buffer's
// format.
OrderLoss order_loss(const Image* reference, const Image& decoded_reference,
                     const GoldenFrame& golden, const Image& frame);

}  // namespace sgs
