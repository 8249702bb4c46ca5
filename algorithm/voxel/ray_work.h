// What a step of a ray through the voxel tree executes, counted by running it with the counting
// scalar. The ray and the voxel size are values, the place of the root is a constant.
#pragma once

#include "algorithm/splat/operation_counts.h"

namespace sgs {

// Of the longest step, which crosses an empty block of several cells: three planes to leave it by,
// and the cells of the two axes that it is not left along. A unit that takes a step at fixed
// intervals has to be built for this. Looking into a node and climbing the tree are integer work.
OperationCounts ray_step_work();

}  // namespace sgs
