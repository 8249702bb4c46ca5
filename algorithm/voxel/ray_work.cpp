// The traversal run with the counting scalar.
#include "algorithm/voxel/ray_work.h"

#include "algorithm/splat/counting.h"
#include "algorithm/voxel/ray_path.h"

namespace sgs {

// Found by RayPath through its argument.
static CountingIndex cell_of(Counting coordinate, Counting voxel_size) {
  return static_cast<CountingIndex>(floor(coordinate / voxel_size));
}

namespace {

// What is computed from a place in the graph on.
struct Flow {
  DataFlow flow;
  std::size_t from = 0;

  OperationCounts counts() const { return flow.counts(from, flow.size()); }
  LongestPath path(const OperationLatencies& latencies) const {
    return flow.longest_path(from, flow.size(), latencies);
  }
  std::vector<LaneStep> steps(const OperationLatencies& latencies) const {
    return lane_steps(flow, from, flow.size(), latencies);
  }
};

constexpr VoxelFrame kTwoLevels = {0.7F, glm::ivec3(0), 2};

// Its cells are values: they lie in the ray's context.
Flow step_flow(const StepCase& step) {
  Flow out;
  DataFlow& flow = out.flow;
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
    out.from = flow.size();
    const RayEventOf event = path.next();
    if (event.what == RayEvent::kStep) return out;
    if (event.what == RayEvent::kLookUp) path.give({step.children});
  }
}

Flow pixel_ray_flow() {
  Flow out;
  DataFlow& flow = out.flow;
  const Counting voxel_size = input(flow, kTwoLevels.voxel_size);
  View<Counting> view{};
  // Looks along the diagonal of the root, which begins at 0.
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
  const Counting x = input(flow, 33), y = input(flow, 22);
  // The eye's cell is found once a frame, and so is the reciprocal of the voxel size.
  for (int axis = 0; axis < 3; ++axis) {
    static_cast<void>(number_of<Counting>(cell_of(view.position[axis], voxel_size) + 0));
  }
  out.from = flow.size();
  RayPath<Counting> path(kTwoLevels, voxel_size);
  path.begin(pixel_ray_of(view, x, y));
  return out;
}

}  // namespace

StepCase longest_step_case() { return {{2.1F, 4.3F, 3.9F}, {0.69F, 0.43F, 0.94F}, 0}; }
StepCase cell_step_case() { return {{0.3F, 0.4F, 0.2F}, {0.61F, 0.53F, 0.59F}, ~std::uint64_t{0}}; }

OperationCounts ray_step_work(const StepCase& step) { return step_flow(step).counts(); }
LongestPath ray_step_path(const StepCase& step, const OperationLatencies& latencies) {
  return step_flow(step).path(latencies);
}
std::vector<LaneStep> ray_step_steps(const StepCase& step, const OperationLatencies& latencies) {
  return step_flow(step).steps(latencies);
}
OperationCounts pixel_ray_work() { return pixel_ray_flow().counts(); }
LongestPath pixel_ray_path(const OperationLatencies& latencies) {
  return pixel_ray_flow().path(latencies);
}
std::vector<LaneStep> pixel_ray_steps(const OperationLatencies& latencies) {
  return pixel_ray_flow().steps(latencies);
}

}  // namespace sgs
