// Counts and schedules of chunk tests and of rays.
#include "modules/streaminggs/vsu/vsu_datapaths.h"

#include "algorithm/voxel/chunk_work.h"
#include "algorithm/voxel/ray_work.h"
#include "modules/datapath/counted_datapath.h"
#include "modules/datapath/scheduled_datapath.h"

namespace sgs {
namespace {

Datapath pipeline(const char* name, const OperationCounts& work, std::uint32_t lanes,
                  const std::vector<LaneStep>& steps, const OperationLatencies& latencies) {
  Datapath path = counted_datapath(name, "vsu", work);
  path.lanes = lanes;
  schedule(path, steps, latencies);
  return path;
}

}  // namespace

Datapath chunk_test_pipeline(const ExactVsuConfig& config, const OperationLatencies& latencies) {
  const ChunkCase longest = longest_chunk_case();
  const auto steps = chunk_steps(longest, latencies);
  Datapath path = pipeline("chunk_test", chunk_work(longest), config.test_lanes, steps, latencies);
  set_by_group(path, steps);
  return path;
}

Datapath pixel_ray_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies) {
  return pipeline("pixel_ray", pixel_ray_work(), config.ray_lanes, pixel_ray_steps(latencies),
                  latencies);
}

Datapath ray_step_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies) {
  const StepCase step = longest_step_case();
  return pipeline("ray_step", ray_step_work(step), config.step_lanes,
                  ray_step_steps(step, latencies), latencies);
}

Datapath cell_step_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies) {
  Datapath block = ray_step_pipeline(config, latencies);
  if (block.interval_cycles() > 1) return block;
  const StepCase step = cell_step_case();
  return pipeline("ray_step", ray_step_work(step), config.step_lanes,
                  ray_step_steps(step, latencies), latencies);
}

}  // namespace sgs
