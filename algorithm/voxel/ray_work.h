// What a ray through the voxel tree executes, counted by running it with the counting scalar. The
// ray and the voxel size are values, the place of the root is a constant.
#pragma once

#include "algorithm/splat/lane_steps.h"
#include "algorithm/splat/longest_path.h"
#include "algorithm/splat/operation_counts.h"

namespace sgs {

// Of the longest step, which crosses an empty block of several cells: three planes to leave it by,
// and the cells of the two axes that it is not left along. A unit that takes a step at fixed
// intervals has to be built for this. Looking into a node and climbing the tree are integer work.
OperationCounts ray_step_work();
LongestPath ray_step_path(const OperationLatencies& latencies);
std::vector<LaneStep> ray_step_steps(const OperationLatencies& latencies);

// Of a ray's beginning, the longest: its direction from its pixel, three reciprocals, and, from an
// eye beyond the root along all axes, where it enters the root. The view is a value but for its
// focal lengths, whose reciprocals are made once a frame.
OperationCounts pixel_ray_work();
LongestPath pixel_ray_path(const OperationLatencies& latencies);
std::vector<LaneStep> pixel_ray_steps(const OperationLatencies& latencies);

}  // namespace sgs
