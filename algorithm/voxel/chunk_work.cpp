// The chunk test run with the counting scalar.
#include "algorithm/voxel/chunk_work.h"

#include "algorithm/splat/counting.h"
#include "algorithm/splat/filter_work.h"
#include "algorithm/voxel/chunk_node.h"
#include "algorithm/voxel/chunk_test.h"

namespace sgs {

// Found by extent_value() through their arguments.
static Counting extent_fraction(CountingIndex q) {
  return recorded(extent_fraction(q.value), Operation::kLookUp, q);
}
static Counting scaled_by_exponent(Counting x, CountingIndex exponent) {
  return recorded(scaled_by_exponent(x.value, exponent.value), Operation::kScale, x, exponent);
}

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
  ChunkNode node;
  node.children = 1;
  quantise(&tested.bound, node);
  const CountingIndex least = input_index(flow, least_extent_exponent(node.extent_exponent));
  ChunkBoundOf<Counting> bound;
  for (int k = 0; k < 3; ++k) {
    const Counting origin = input(flow, node.origin[k]);
    const Counting step = input(flow, std::ldexp(1.0F, node.step_exponent[k]));
    bound.low[k] = box_bound(origin, step, input_index(flow, node.low[0][k]));
    bound.high[k] = box_bound(origin, step, input_index(flow, node.high[0][k]));
    bound.extent[k] = extent_value<Counting>(input_index(flow, node.extent[0][k]), least);
  }
  bound.scale_max = extent_value<Counting>(input_index(flow, node.scale[0]), least);
  const ChunkTestOf<Counting> test = GroupFrustumOf<Counting>(view, tested.group).test(bound);
  flow.pass_beside(1);  // which child of which node
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
