// The traversal runs with the counting scalar; schedules of both VSUs.
#include "modules/streaminggs/vsu/vsu_datapaths.h"

#include <memory>

#include "algorithm/splat/counting.h"
#include "algorithm/voxel/cell_samples.h"
#include "algorithm/voxel/ray_path.h"
#include "modules/datapath/counted_datapath.h"

namespace sgs {

// Found by RayPath through its argument.
static CountingIndex cell_of(Counting coordinate, Counting voxel_size) {
  return static_cast<CountingIndex>(floor(coordinate / voxel_size));
}

namespace {

constexpr VoxelFrame kTwoLevels = {0.7F, glm::ivec3(0), 2};

// A frame's view that looks along the diagonal of a box, with values of the datapath.
View<Counting> diagonal_view(DataFlow& flow) {
  View<Counting> view{};
  const glm::vec3 rows[3] = {{0.71F, -0.71F, 0}, {0.41F, 0.41F, -0.82F}, {0.58F, 0.57F, 0.59F}};
  const glm::vec3 eye{-3.1F, -2.9F, -3.3F};
  for (int axis = 0; axis < 3; ++axis) {
    view.position[axis] = input(flow, eye[axis]);
    for (int row = 0; row < 3; ++row) {
      view.cam_from_world[row][axis] = input(flow, rows[row][axis]);
    }
  }
  view.focal_x = view.focal_y = Counting(300.0F);
  view.centre_x = input(flow, 31.5F);
  view.centre_y = input(flow, 23.5F);
  return view;
}

// Numbers of the frame are values, but for the distance of samples. The eye lies beyond the box.
SampleSpaceOf<Counting> diagonal_space(DataFlow& flow) {
  SampleSpaceOf<Counting> space;
  for (int axis = 0; axis < 3; ++axis) {
    space.eye[axis] = input(flow, -4.3F + 0.2F * static_cast<float>(axis));
    space.box[axis] = input(flow, 16);
  }
  space.step = input(flow, 0.5F);
  space.far = input(flow, 100);
  return space;
}

// One coordinate of a ray's pixel as a number, and that of the next ray beside: next_ray()
// (algorithm/order/group_visits.h) with a step and the group's last pixel.
Counting pixel_of_ray(CountingIndex at) {
  constexpr int kStep = 2, kLast = 47;
  static_cast<void>(at < kLast);
  keep(*at.flow, {min_of<CountingIndex>(at + kStep, kLast)});
  return number_of<Counting>(at);
}

Datapath pipeline(const char* name, const FlowPart& flow, std::uint32_t lanes,
                  const OperationLatencies& latencies) {
  Datapath path = counted_datapath(name, "vsu", flow.counts());
  path.lanes = lanes;
  schedule(path, flow.steps(latencies), latencies);
  return path;
}

}  // namespace

StepCase longest_step_case() { return {{2.1F, 4.3F, 3.9F}, {0.69F, 0.43F, 0.94F}, 0}; }
StepCase cell_step_case() { return {{0.3F, 0.4F, 0.2F}, {0.61F, 0.53F, 0.59F}, ~std::uint64_t{0}}; }

// Its cells are values: they lie in the ray's context.
FlowPart ray_step_flow(const StepCase& step) {
  const auto recorded = std::make_shared<DataFlow>();
  DataFlow& flow = *recorded;
  const Counting voxel_size = input(flow, kTwoLevels.voxel_size);
  RayOf<Counting> ray{};
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = input(flow, step.origin[axis]);
    ray.direction[axis] = input(flow, step.direction[axis]);
    ray.inverse[axis] = input(flow, 1 / step.direction[axis]);
    ray.step[axis] = step.direction[axis] > 0 ? 1 : -1;
  }
  RayPath<Counting> path(kTwoLevels, voxel_size);
  path.begin(ray);
  while (true) {
    const std::size_t from = flow.size();
    const RayEventOf event = path.next();
    if (event.what == RayEvent::kStep) return {recorded, from, flow.size(), {}};
    if (event.what == RayEvent::kLookUp) path.give({step.children});
  }
}

FlowPart pixel_ray_flow() {
  const auto recorded = std::make_shared<DataFlow>();
  DataFlow& flow = *recorded;
  const Counting voxel_size = input(flow, kTwoLevels.voxel_size);
  // Looks along the diagonal of the root, which begins at 0.
  const View<Counting> view = diagonal_view(flow);
  const CountingIndex x = input_index(flow, 33), y = input_index(flow, 22);
  // The eye's cell is found once a frame, and so is the reciprocal of the voxel size.
  for (int axis = 0; axis < 3; ++axis) {
    static_cast<void>(number_of<Counting>(cell_of(view.position[axis], voxel_size) + 0));
  }
  const std::size_t from = flow.size();
  RayPath<Counting> path(kTwoLevels, voxel_size);
  path.begin(pixel_ray_of(view, pixel_of_ray(x), pixel_of_ray(y)));
  return {recorded, from, flow.size(), {}};
}

FlowPart sampled_ray_flow() {
  const auto recorded = std::make_shared<DataFlow>();
  DataFlow& flow = *recorded;
  const View<Counting> view = diagonal_view(flow);
  const CountingIndex x = input_index(flow, 33), y = input_index(flow, 22);
  CellSamples<Counting> samples(diagonal_space(flow));
  const std::size_t from = flow.size();
  samples.begin(pixel_direction(view, pixel_of_ray(x), pixel_of_ray(y)));
  return {recorded, from, flow.size(), {}};
}

FlowPart ray_sample_flow() {
  const auto recorded = std::make_shared<DataFlow>();
  DataFlow& flow = *recorded;
  CellSamples<Counting> samples(diagonal_space(flow));
  samples.begin({input(flow, 0.61F), input(flow, 0.53F), input(flow, 0.59F)});
  const std::size_t from = flow.size();
  samples.next();
  static_cast<void>(samples.done());
  glm::vec<3, CountingIndex> cell;
  static_cast<void>(samples.find_cell(cell));
  return {recorded, from, flow.size(), {}};
}

Datapath chunk_test_pipeline(const ExactVsuConfig& config, std::uint32_t eyes,
                             const OperationLatencies& latencies) {
  const FlowPart flow = chunk_flow(longest_chunk_case(eyes));
  Datapath path = pipeline("chunk_test", flow, config.test_lanes, latencies);
  set_by_group(path, flow.steps(latencies));
  return path;
}

Datapath pixel_ray_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies) {
  return pipeline("pixel_ray", pixel_ray_flow(), config.ray_lanes, latencies);
}

Datapath ray_step_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies) {
  return pipeline("ray_step", ray_step_flow(longest_step_case()), config.step_lanes, latencies);
}

Datapath cell_step_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies) {
  Datapath block = ray_step_pipeline(config, latencies);
  if (block.interval_cycles() > 1) return block;
  return pipeline("ray_step", ray_step_flow(cell_step_case()), config.step_lanes, latencies);
}

Datapath sampled_ray_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies) {
  return pipeline("sampled_ray", sampled_ray_flow(), config.ray_lanes, latencies);
}

Datapath ray_sample_pipeline(const PaperVsuConfig& config, const OperationLatencies& latencies) {
  const FlowPart flow = ray_sample_flow();
  Datapath path = pipeline("ray_sample", flow, folded_macs(flow.counts()), latencies);
  path.copies = config.samples_per_cycle;
  return path;
}

}  // namespace sgs
