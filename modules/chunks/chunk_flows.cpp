// The chunk test runs with the counting scalar.
#include "modules/chunks/chunk_flows.h"

#include <memory>

#include "algorithm/splat/counting.h"
#include "algorithm/voxel/chunk_test.h"
#include "modules/datapath/filter_flows.h"

namespace sgs {

// Found by extent_value() through their arguments.
static Counting extent_fraction(CountingIndex q) {
  return recorded(extent_fraction(q.value), Operation::kLookUp, q);
}
static Counting scaled_by_exponent(Counting x, CountingIndex exponent) {
  return recorded(scaled_by_exponent(x.value, exponent.value), Operation::kScale, x, exponent);
}

namespace {

// A child's bound, out of the bytes of its node.
ChunkBoundOf<Counting> decoded_bound(DataFlow& flow, const ChunkBound& of) {
  ChunkNode node;
  node.children = 1;
  quantise(&of, node);
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
  return bound;
}

constexpr std::size_t kBesideTest = 1;  // word that goes along: which child of which node

}  // namespace

ChunkCase longest_chunk_case(std::uint32_t eyes) {
  const FilterCase gaussian = longest_case(eyes);
  ChunkCase out;
  out.camera = gaussian.camera;
  out.group = gaussian.group;
  out.bound.low = gaussian.gaussian.mean - glm::vec3(0.31F, 0.22F, 0.27F);
  out.bound.high = gaussian.gaussian.mean + glm::vec3(0.29F, 0.33F, 0.25F);
  out.bound.extent = {0.7F, 0.9F, 0.8F};
  out.bound.scale_max = 0.35F;
  return out;
}

FlowPart chunk_flow(const ChunkCase& tested) {
  const auto recorded = std::make_shared<DataFlow>();
  DataFlow& flow = *recorded;
  const auto view = make_view<Counting>(tested.camera);
  const ChunkBoundOf<Counting> bound = decoded_bound(flow, tested.bound);
  const ChunkTestOf<Counting> test = GroupFrustumOf<Counting>(view, tested.group).test(bound);
  flow.pass_beside(kBesideTest);
  // A child is no nearer than its parent.
  if (test.touches) static_cast<void>(max_of(test.nearest, input(flow, 0.0F)));
  return whole(recorded);
}

FlowPart chunk_culling_flow(const ChunkCase& tested) {
  const auto recorded = std::make_shared<DataFlow>();
  DataFlow& flow = *recorded;
  const auto view = make_view<Counting>(tested.camera);
  const ChunkBoundOf<Counting> bound = decoded_bound(flow, tested.bound);
  static_cast<void>(GroupFrustumOf<Counting>(view, tested.group).touches(bound));
  flow.pass_beside(kBesideTest);
  return whole(recorded);
}

}  // namespace sgs
