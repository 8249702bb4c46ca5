// The chain of pictures from the reference to the frame.
#include "testbench/streaminggs/order_loss.h"

#include <vector>

namespace sgs {

OrderLoss order_loss(const MachineDesign& design, const StoredScene& scene, const FrameJob& job,
                     const Image& reference, const Image& decoded_reference,
                     const StreamingResult& golden, const Image& frame) {
  OrderLoss loss;
  loss.in_order =
      golden.stats.missed > 0 ? design.golden_in_order(scene, job, golden) : decoded_reference;
  const std::vector<ErrorPart> parts =
      error_parts({&reference, &decoded_reference, &loss.in_order, &golden.frame.image, &frame});
  loss.encoding = parts[0];
  loss.missed = parts[1];
  loss.misordered = parts[2];
  loss.pixel_format = parts[3];
  return loss;
}

}  // namespace sgs
