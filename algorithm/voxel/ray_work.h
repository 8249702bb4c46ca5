// What a ray through the voxel tree executes, counted by running it with the counting scalar. The
// ray, its cell and the voxel size are values, the place of the root is a constant.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "algorithm/splat/lane_steps.h"
#include "algorithm/splat/longest_path.h"
#include "algorithm/splat/operation_counts.h"

namespace sgs {

// The first step of a ray in a root of 16 cells of 0.7 a side, all of whose nodes have these
// children. Origin: in the root; world units.
struct StepCase {
  glm::vec3 origin, direction;
  std::uint64_t children;
};

// One that crosses an empty block of many cells: three planes to leave it by, and the cells of the
// two axes that it is not left along, each with the planes before and behind it. A unit that takes
// a step at fixed intervals has to be built for this.
StepCase longest_step_case();
// One out of a single cell, along one axis.
StepCase cell_step_case();

// Looking into a node and climbing the tree are not counted: bits are compared and moved.
OperationCounts ray_step_work(const StepCase& step);
LongestPath ray_step_path(const StepCase& step, const OperationLatencies& latencies);
std::vector<LaneStep> ray_step_steps(const StepCase& step, const OperationLatencies& latencies);

// Of a ray's beginning, the longest: its direction from its pixel, three reciprocals, and, from an
// eye beyond the root along all axes, where it enters the root. The view is a value but for its
// focal lengths, whose reciprocals are made once a frame.
OperationCounts pixel_ray_work();
LongestPath pixel_ray_path(const OperationLatencies& latencies);
std::vector<LaneStep> pixel_ray_steps(const OperationLatencies& latencies);

}  // namespace sgs
