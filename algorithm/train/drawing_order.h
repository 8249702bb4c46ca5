// The order that a tuning's pictures are drawn in, and how.
#pragma once

#include <cstddef>
#include <functional>

#include "algorithm/tune/group_sequences.h"
#include "algorithm/tune/visit_plan.h"

namespace sgs {

struct DrawingOrder {
  // Of view number `at`, of a cloud whose Gaussians stand where they stood at the first call.
  std::function<GroupSequences(std::size_t at, const View<float>& view,
                               const ActivatedCloud& cloud)>
      sequences;
  glm::vec3 background{0.0F};
  BlendPrecision precision = BlendPrecision::kSingle;
};

inline DrawingOrder reference_order() {
  return {[](std::size_t, const View<float>& view, const ActivatedCloud& cloud) {
    return reference_sequences(view, cloud);
  }};
}

// plan: must outlive the order.
inline DrawingOrder paper_order(VisitPlan& plan) {
  return {[&plan](std::size_t at, const View<float>& view, const ActivatedCloud& cloud) {
            return plan.sequences(at, view, cloud);
          },
          plan.order().background, plan.order().precision};
}

}  // namespace sgs
