#include "testbench/units/exact_vsu_plan.h"

#include <algorithm>
#include <utility>

#include "algorithm/splat/gaussian.h"
#include "modules/datapath/lane_steps.h"
#include "modules/streaminggs/vsu/vsu_datapaths.h"
#include "testbench/units/job_memory.h"

namespace sgs::tb {
namespace {

bool hidden(const ExactVsuPlan& plan, const GroupReach& reach) {
  return reach.x1 < plan.finished_columns;
}

// All below one node that touches: its chunks, and the cost of opening it.
void expect_node(const ExactVsuPlan& plan, const PixelRect& group, const WalkEntry& entry,
                 ExpectedWalk& out) {
  const ExactVsuConfig& c = plan.config;
  const ChunkNode& node = plan.tree.nodes[entry.at];
  std::uint32_t slot = node.first_slot, inner = node.first_node;
  std::uint64_t touching = 0;
  for (int k = 0; k < node.children; ++k) {
    const std::uint16_t count = node.count[k];
    const ChunkTest test = GroupFrustum(plan.job.view, group).test(child_bound(node, k));
    const WalkEntry child{std::max(test.nearest, entry.nearest), count > 0 ? slot : inner, count, 0,
                          test.reach};
    (count > 0 ? slot : inner) += count > 0 ? count : 1;
    if (!test.touches) continue;
    if (hidden(plan, test.reach)) {
      ++(count > 0 ? out.chunks_hidden : out.nodes_hidden);
      continue;
    }
    ++touching;
    if (count > 0) {
      out.groups.back().push_back(child);
    } else {
      expect_node(plan, group, child, out);
    }
  }
  const auto tests = static_cast<std::uint64_t>(node.children);
  const std::uint64_t a_operation = c.cycles_per_queue_operation;
  const bool upper = entry.at < c.upper_nodes;
  // Taken from its queue; where it was not on chip, on to the test when it has come; its children.
  out.cycles += a_operation + (upper ? 0 : 1) + std::max(touching * a_operation, std::uint64_t{1});
  const std::uint64_t of_test = (macs_of_a_test() + c.test_lanes - 1) / c.test_lanes;
  out.testing_cycles += tests * of_test;
  out.turn_cycles += of_test - 1;
  out.queue_operations += 1 + touching;
  out.tests += tests;
  out.upper += upper ? 1 : 0;
  ++out.nodes;
}

}  // namespace

ExactVsuPlan plan_of(const TestScene& scene, std::uint32_t chunk) {
  ExactVsuPlan plan;
  auto [tree, order] = arrange_by_chunks(scene.cloud, chunk);
  plan.tree = std::move(tree);
  const std::uint64_t aside_bytes =
      (plan.tree.chunk_count + plan.tree.nodes.size()) * kWalkEntryBytes;
  plan.job = scene.job;
  plan.config.test_depth_cycles = 60;
  plan.image = build_memory_image(encode_raw(reordered(scene.cloud, order)), plan.tree);
  place(plan.image.layout, aside_bytes, plan.job);
  return plan;
}

std::uint64_t macs_of_a_test() { return folded_macs(chunk_flow(longest_chunk_case()).counts()); }

std::uint64_t comparisons_of_a_test() {
  return chunk_flow(longest_chunk_case()).counts().comparisons;
}

ExpectedWalk expect(const ExactVsuPlan& plan) {
  ExpectedWalk out;
  const std::uint64_t a_operation = plan.config.cycles_per_queue_operation;
  for (const PixelRect& group : plan.job.groups) {
    const std::uint64_t before = out.nodes;
    std::vector<WalkEntry>& chunks = out.groups.emplace_back();
    out.cycles += 1;  // the group's end
    if (plan.tree.nodes.empty()) {
      out.cycles += 1;  // its beginning
    } else {
      out.cycles += a_operation;
      ++out.queue_operations;
      expect_node(plan, group, {}, out);
    }
    std::sort(chunks.begin(), chunks.end(), walks_before);
    out.nodes_of.push_back(out.nodes - before);
    out.cycles += chunks.size() * a_operation + (chunks.empty() ? 0 : 1);  // the last one's release
    out.queue_operations += chunks.size();
    out.visits += chunks.size();
    out.empty += chunks.empty() ? 1 : 0;
  }
  return out;
}

}  // namespace sgs::tb
