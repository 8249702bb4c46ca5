// The lanes of the voxel sorting units: their operations, recorded by running them, and the
// schedule on lanes of given latencies.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "modules/chunks/chunk_flows.h"
#include "modules/datapath/lane_steps.h"
#include "modules/streaminggs/vsu/exact_vsu_config.h"
#include "modules/streaminggs/vsu/paper_vsu_config.h"
#include "tlm/datapath.h"

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

// The ray, its cell and the voxel size are values, the place of the root is a constant. Looking
// into a node and climbing the tree are not counted: bits are compared and moved.
FlowPart ray_step_flow(const StepCase& step);

// Operations of the longest beginning of a ray: its direction from its pixel, three reciprocals,
// and, from an eye beyond the root along all axes, where it enters the root. The view is a value
// but for its focal lengths, whose reciprocals are made once a frame.
FlowPart pixel_ray_flow();

// A sample of a ray: the next number, its coordinates, the cell, and whether it lies in the box.
FlowPart ray_sample_flow();
// Operations of the beginning of a ray that is sampled: its direction from its pixel, the way from
// sample to sample, and the first and the last sample in the box.
FlowPart sampled_ray_flow();

// An item a child.
Datapath chunk_test_pipeline(const ExactVsuConfig& config, std::uint32_t eyes,
                             const OperationLatencies& latencies);
// An item a ray; a step of one, out of a block.
Datapath pixel_ray_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies);
Datapath ray_step_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies);
// A step out of a single cell, on the lanes of the steps and in their turns. Where a lane does one
// thing only, a cell's steps are the first of a block's, and end sooner. Folded lanes would meet
// two schedules at a time: there both kinds take the block's.
Datapath cell_step_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies);
// Rays that are sampled: an item a ray, and an item a sample, which takes as many lanes as it has
// multiply-accumulates; a copy of these for each sample of a cycle.
Datapath sampled_ray_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies);
Datapath ray_sample_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies);

}  // namespace sgs
