// What the culler is given: a scene stored by chunks, and a frame of it.
#pragma once

#include <cstdint>
#include <random>

#include "algorithm/storage/encoded_cloud.h"
#include "algorithm/voxel/chunk_tree.h"
#include "testbench/units/gscore_bench.h"
#include "testbench/units/random_scene.h"

namespace sgs::tb {

struct CullerPlan {
  GscoreConfig config;
  ChunkTree tree;
  MemoryImage image;
  FrameJob frame;
  std::uint32_t passes = 1;
};

// Chunks of at most so many Gaussians.
inline CullerPlan culler_plan(std::mt19937_64& random, const SceneShape& shape,
                              std::uint32_t chunk) {
  const TestScene scene = random_scene(random, shape);
  CullerPlan plan;
  auto [tree, order] = arrange_by_chunks(scene.cloud, chunk);
  plan.tree = std::move(tree);
  plan.image = build_memory_image(encode_raw(reordered(scene.cloud, order)), plan.tree);
  plan.frame = scene.job;
  plan.frame.layout = plan.image.layout;
  plan.config.culling.by = CullingBy::kChunkBoxes;
  plan.config.lists.pool_bytes = 1 << 20;
  return plan;
}

}  // namespace sgs::tb
