// What a lossy order cost a picture, divided between splats that it missed and blends in the wrong
// order.
#pragma once

#include <optional>

#include "algorithm/image/error_parts.h"
#include "algorithm/image/image.h"
#include "algorithm/render/streaming_result.h"
#include "modules/machine_design.h"

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

inline bool is_lossy(const StreamingStats& stats) { return stats.missed + stats.misordered > 0; }

// Of a lossy order. reference, decoded_reference: of the scene as given, and as encoded; where the
// original is not known the error counts from the latter. golden: of
// this job, and `frame` the same in the frame buffer's format.
OrderLoss order_loss(const MachineDesign& design, const StoredScene& scene, const FrameJob& job,
                     const Image& reference, const Image& decoded_reference,
                     const StreamingResult& golden, const Image& frame);

}  // namespace sgs
