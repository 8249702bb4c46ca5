// The two bounds.
#include "algorithm/memory/first_half_test.h"

namespace sgs {

FirstHalfBound bound_first_half(const RecordSplit& split, const SplitFirstHalf& first,
                                const View<float>& view) {
  const VisibleExtents& known = first.extents;
  if (split.bound_by == CoarseBoundBy::kLargestScale) {
    return coarse_bound(view, first.mean, known.scale_max);
  }
  return extent_bound(view, first.mean, known.extent, known.scale_max);
}

}  // namespace sgs
