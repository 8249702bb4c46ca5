// Layout of a scene, and its golden images.
#include "testbench/streaminggs/prepared_scene.h"

#include <fmt/format.h>

#include "algorithm/input_error.h"
#include "algorithm/render/exact_renderer.h"
#include "algorithm/render/group_state.h"
#include "algorithm/render/paper_renderer.h"
#include "algorithm/splat/activate.h"
#include "modules/accelerator.h"
#include "modules/dram/address_mapping.h"

namespace sgs {

PreparedScene::PreparedScene(Scene scene, const AcceleratorConfig& config)
    : config_(config), scene_(std::move(scene)), cloud_(activate(scene_.cloud)) {
  const Stored stored = config.store_invisible ? Stored::kAll : Stored::kVisible;
  if (config.ordering == Ordering::kExact) {
    tree_ = build_chunk_tree(cloud_, config.chunk_gaussians, stored);
    return;
  }
  const float voxel_size =
      config.voxel_size > 0 ? static_cast<float>(config.voxel_size) : paper_voxel_size(cloud_);
  grid_ = build_voxel_grid(cloud_, voxel_size, stored);
}

MemoryImage PreparedScene::memory_image(std::uint64_t frame_bytes) const {
  MemoryImage image =
      config_.ordering == Ordering::kExact
          ? build_memory_image(cloud_, tree_, spill_region_bytes(tree_), frame_bytes)
          : build_memory_image(cloud_, grid_, spill_region_bytes(config_, grid_), frame_bytes);
  const DramConfig& dram = config_.dram;
  const std::uint64_t capacity = AddressMapping(dram, load_memspec(dram.memspec)).capacity_bytes();
  if (image.layout.total_bytes() > capacity) {
    throw InputError(
        fmt::format("dram: the scene and its frame take {} bytes, {} channels x {} ranks hold {}",
                    image.layout.total_bytes(), dram.channels, dram.ranks, capacity));
  }
  return image;
}

StreamingResult PreparedScene::golden(const FrameJob& job) const {
  if (config_.ordering == Ordering::kExact) {
    ExactOrderConfig order;
    order.group_px = job.group_px;
    order.merge_entries = config_.merge.entries;
    order.on_overflow = config_.merge.on_overflow;
    order.walk_queue_entries = config_.vsu.queue_entries;
    order.background = job.background;
    return render_exact_order(job.view, cloud_, tree_, order);
  }
  PaperOrderConfig order;
  order.group_px = job.group_px;
  order.sample_step_voxels = static_cast<float>(config_.vsu.sample_step_voxels);
  order.background = job.background;
  return render_paper_order(job.view, cloud_, grid_, order);
}

FrameJob make_job(const Camera& camera, const AcceleratorConfig& config) {
  FrameJob job;
  job.view = make_view<float>(camera);
  job.frame_format = config.framebuffer;
  job.group_px = static_cast<int>(config.group_px);
  job.groups = pixel_groups(camera.width, camera.height, job.group_px);
  return job;
}

}  // namespace sgs
