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
  std::vector<const Image*> chain = {&decoded_reference, &loss.in_order, &golden.frame.image,
                                     &frame};
  if (scene.original_known()) chain.insert(chain.begin(), &reference);
  const std::vector<ErrorPart> parts = error_parts(chain);
  auto part = parts.begin();
  if (scene.original_known()) loss.encoding = *part++;
  loss.missed = *part++;
  loss.misordered = *part++;
  loss.pixel_format = *part;
  return loss;
}

}  // namespace sgs
