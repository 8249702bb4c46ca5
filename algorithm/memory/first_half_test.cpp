// The two bounds.
#include "algorithm/memory/first_half_test.h"

#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/extent_bound.h"

namespace sgs {

FirstHalfTest test_first_half(const RecordSplit& split, const SplitFirstHalf& first,
                              const View<float>& view, const PixelRect& group) {
  const auto tested = [&](const auto& bound) -> FirstHalfTest {
    return {bound.in_front && touches(bound, group), bound.depth};
  };
  const VisibleExtents& known = first.extents;
  if (split.bound_by == CoarseBoundBy::kLargestScale) {
    return tested(coarse_bound(view, first.mean, known.scale_max));
  }
  return tested(extent_bound(view, first.mean, known.extent, known.scale_max));
}

}  // namespace sgs
