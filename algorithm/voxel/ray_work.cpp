// The traversal run with the counting scalar.
#include "algorithm/voxel/ray_work.h"

#include "algorithm/splat/counting.h"
#include "algorithm/voxel/ray_walk.h"

namespace sgs {
namespace {

// A tree whose root has no occupied child: one step crosses it, 16 cells a side.
struct EmptyTree {
  VoxelNode node(std::uint32_t) { return {}; }
};

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

Flow ray_step_flow() {
  Flow out;
  DataFlow& flow = out.flow;
  VoxelFrame frame;
  frame.voxel_size = 0.7F;
  frame.levels = 2;
  const Counting voxel_size = input(flow, frame.voxel_size);
  RayOf<Counting> ray{};
  // Near the root's far corner.
  const glm::vec3 origin{8.6F, 8.8F, 9.1F}, direction{0.61F, 0.53F, 0.59F};
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = input(flow, origin[axis]);
    ray.direction[axis] = input(flow, direction[axis]);
    ray.inverse[axis] = input(flow, 1 / direction[axis]);
    ray.step[axis] = 1;
  }
  static_cast<void>(ray.origin[0] / voxel_size);  // its reciprocal is made once a frame
  out.from = flow.size();
  EmptyTree tree;
  RayWalk<EmptyTree, Counting> walk(frame, tree, voxel_size);
  walk.walk(ray, [](std::uint32_t, std::uint32_t) { return true; });
  return out;
}

Flow pixel_ray_flow() {
  Flow out;
  DataFlow& flow = out.flow;
  VoxelFrame frame;
  frame.voxel_size = 0.7F;
  frame.levels = 2;
  const Counting voxel_size = input(flow, frame.voxel_size);
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
  static_cast<void>(view.position[0] / voxel_size);
  out.from = flow.size();
  RayPath<Counting> path(frame, voxel_size);
  path.begin(pixel_ray_of(view, x, y));
  return out;
}

}  // namespace

OperationCounts ray_step_work() { return ray_step_flow().counts(); }
LongestPath ray_step_path(const OperationLatencies& latencies) {
  return ray_step_flow().path(latencies);
}
std::vector<LaneStep> ray_step_steps(const OperationLatencies& latencies) {
  return ray_step_flow().steps(latencies);
}
OperationCounts pixel_ray_work() { return pixel_ray_flow().counts(); }
LongestPath pixel_ray_path(const OperationLatencies& latencies) {
  return pixel_ray_flow().path(latencies);
}
std::vector<LaneStep> pixel_ray_steps(const OperationLatencies& latencies) {
  return pixel_ray_flow().steps(latencies);
}

}  // namespace sgs
