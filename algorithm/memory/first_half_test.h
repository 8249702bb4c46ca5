// The coarse test of a first half, whatever it is bounded by.
#pragma once

#include "algorithm/memory/record_split.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/view.h"

namespace sgs {

struct FirstHalfTest {
  bool touches;  // false: behind the near plane, or no pixel of the group can change
  float depth;   // v_z
};

FirstHalfTest test_first_half(const RecordSplit& split, const SplitFirstHalf& first,
                              const View<float>& view, const PixelRect& group);

}  // namespace sgs
