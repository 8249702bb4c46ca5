// The lanes of the voxel sorting units, scheduled on lanes of such latencies.
#pragma once

#include "algorithm/splat/longest_path.h"
#include "algorithm/voxel/ray_work.h"
#include "modules/streaminggs/vsu/exact_vsu_config.h"
#include "modules/streaminggs/vsu/paper_vsu_config.h"
#include "tlm/datapath.h"

namespace sgs {

// An item a child.
Datapath chunk_test_pipeline(const ExactVsuConfig& config, const OperationLatencies& latencies);
// An item a ray; a step of one, out of a block.
Datapath pixel_ray_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies);
Datapath ray_step_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies);
// A step out of a single cell, on the lanes of the steps and in their turns. Where a lane does one
// thing only, a cell's steps are the first of a block's, and end sooner. Folded lanes would meet
// two schedules at a time: there both kinds take the block's.
Datapath cell_step_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies);

}  // namespace sgs
