// Laying out of encoded scenes.
#include "algorithm/memory/stored_scene.h"

#include <utility>

namespace sgs {

StoredScene store_by_voxels(EncodedCloud scene, float voxel_size, Stored stored) {
  StoredScene out;
  out.grid = build_voxel_grid(scene.decoded, voxel_size, stored);
  out.image = build_memory_image(scene, out.grid);
  out.gaussians = scene.decoded.size();
  out.decoded = std::move(scene.decoded);
  return out;
}

StoredScene store_by_chunks(EncodedCloud scene, std::uint32_t chunk_gaussians, Stored stored) {
  StoredScene out;
  out.tree = build_chunk_tree(scene.decoded, chunk_gaussians, stored);
  out.image = build_memory_image(scene, out.tree);
  out.gaussians = scene.decoded.size();
  out.decoded = std::move(scene.decoded);
  return out;
}

}  // namespace sgs
