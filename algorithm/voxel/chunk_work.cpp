// The chunk test run with the counting scalar.
#include "algorithm/voxel/chunk_work.h"

#include "algorithm/splat/counting.h"
#include "algorithm/splat/filter_work.h"
#include "algorithm/voxel/chunk_test.h"

namespace sgs {

ChunkCase longest_chunk_case() {
  const FilterCase gaussian = longest_case();
  ChunkCase out;
  out.camera = gaussian.camera;
  out.group = gaussian.group;
  out.bound.low = gaussian.gaussian.mean - glm::vec3(0.31F, 0.22F, 0.27F);
  out.bound.high = gaussian.gaussian.mean + glm::vec3(0.29F, 0.33F, 0.25F);
  out.bound.extent = {0.7F, 0.9F, 0.8F};
  out.bound.scale_max = 0.35F;
  return out;
}

namespace {

DataFlow chunk_flow(const ChunkCase& tested) {
  DataFlow flow;
  const auto view = make_view<Counting>(tested.camera);
  const auto vec = [&](const glm::vec3& v) {
    return glm::vec<3, Counting>{input(flow, v.x), input(flow, v.y), input(flow, v.z)};
  };
  // A bound of the box is q 2^e behind the node's origin, a multiply-add each.
  const glm::vec<3, Counting> origin = vec(tested.bound.low);
  const Counting step = input(flow, 0x1p-8F);
  const auto decoded = [&](const glm::vec3& v) {
    glm::vec<3, Counting> out;
    for (int k = 0; k < 3; ++k) {
      out[k] = origin[k] + step * input(flow, (v[k] - tested.bound.low[k]) * 0x1p8F);
    }
    return out;
  };
  ChunkBoundOf<Counting> bound;
  bound.low = decoded(tested.bound.low);
  bound.high = decoded(tested.bound.high);
  bound.extent = vec(tested.bound.extent);
  bound.scale_max = input(flow, tested.bound.scale_max);
  const ChunkTestOf<Counting> test = GroupFrustumOf<Counting>(view, tested.group).test(bound);
  // A child is no nearer than its parent.
  if (test.touches) static_cast<void>(max_of(test.nearest, input(flow, 0.0F)));
  return flow;
}

}  // namespace

OperationCounts chunk_work(const ChunkCase& tested) {
  const DataFlow flow = chunk_flow(tested);
  return flow.counts(0, flow.size());
}

LongestPath chunk_path(const ChunkCase& tested, const OperationLatencies& latencies) {
  const DataFlow flow = chunk_flow(tested);
  return flow.longest_path(0, flow.size(), latencies);
}

std::vector<LaneStep> chunk_steps(const ChunkCase& tested, const OperationLatencies& latencies) {
  const DataFlow flow = chunk_flow(tested);
  return lane_steps(flow, 0, flow.size(), latencies);
}

}  // namespace sgs
