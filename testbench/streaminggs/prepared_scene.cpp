// Encoding and layout of a scene, and its golden images.
#include "testbench/streaminggs/prepared_scene.h"

#include <fmt/format.h>

#include "algorithm/input_error.h"
#include "algorithm/memory/restore_scene.h"
#include "algorithm/render/exact_renderer.h"
#include "algorithm/render/group_state.h"
#include "algorithm/render/paper_renderer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/vq/image_weights.h"
#include "modules/accelerator.h"
#include "modules/dram/address_mapping.h"
#include "testbench/streaminggs/progress.h"

namespace sgs {

namespace {

bool is_lossy(SecondHalfEncoding encoding) { return encoding != SecondHalfEncoding::kRaw; }

EncodedCloud encode(const ActivatedCloud& cloud, const AcceleratorConfig& config,
                    const std::vector<Camera>& weighing) {
  if (config.encoding == SecondHalfEncoding::kHalf) return encode_half(cloud);
  const ProgressLine progress;
  const QuantisedCloud quantised =
      quantise(cloud, image_weights(cloud, weighing), pixel_sizes(cloud, weighing), config.vq,
               progress.of_quantisation());
  return encode_quantised(cloud, quantised, config.encoding);
}

StoredScene store(EncodedCloud encoded, const AcceleratorConfig& config) {
  const Stored stored = config.store_invisible ? Stored::kAll : Stored::kVisible;
  if (config.ordering == Ordering::kExact) {
    return store_by_chunks(std::move(encoded), config.chunk_gaussians, stored);
  }
  const float voxel_size = config.voxel_size > 0 ? static_cast<float>(config.voxel_size)
                                                 : paper_voxel_size(encoded.decoded);
  return store_by_voxels(std::move(encoded), voxel_size, stored);
}

std::uint64_t spill_bytes(const AcceleratorConfig& config, const StoredScene& scene) {
  return config.ordering == Ordering::kExact ? spill_region_bytes(scene.tree)
                                             : spill_region_bytes(config, scene.grid);
}

}  // namespace

PreparedScene::PreparedScene(Scene scene, const AcceleratorConfig& config,
                             const std::vector<Camera>& weighing)
    : config_(config), name_(std::move(scene.name)), dropped_invalid_(scene.dropped_invalid) {
  ActivatedCloud cloud = activate(scene.cloud);
  if (is_lossy(config.encoding)) {
    stored_ = store(encode(cloud, config, weighing), config);
    original_ = std::move(cloud);
  } else {
    stored_ = store(encode_raw(std::move(cloud)), config);
  }
  check_codebooks(config, stored_.image.layout.second_half);
}

PreparedScene::PreparedScene(PackedScene packed, const std::string& path,
                             const AcceleratorConfig& config)
    : config_(config), name_(packed.facts.name), dropped_invalid_(packed.facts.dropped_invalid) {
  check_codebooks(config, packed.image.layout.second_half);
  stored_ = restore_scene(std::move(packed), path);
}

FrameJob PreparedScene::job(const Camera& camera) const {
  FrameJob job;
  job.view = make_view<float>(camera);
  job.frame_format = config_.framebuffer;
  job.group_px = static_cast<int>(config_.group_px);
  job.groups = pixel_groups(camera.width, camera.height, job.group_px);
  job.layout = with_working_regions(
      stored_.image.layout, spill_bytes(config_, stored_),
      std::uint64_t{pixel_bytes(config_.framebuffer)} * camera.width * camera.height);
  const DramConfig& dram = config_.dram;
  const std::uint64_t capacity = AddressMapping(dram, load_memspec(dram.memspec)).capacity_bytes();
  if (job.layout.total_bytes() > capacity) {
    throw InputError(
        fmt::format("dram: the scene and its frame take {} bytes, {} channels x {} ranks hold {}",
                    job.layout.total_bytes(), dram.channels, dram.ranks, capacity));
  }
  return job;
}

StreamingResult PreparedScene::golden(const FrameJob& job) const {
  if (config_.ordering == Ordering::kExact) {
    ExactOrderConfig order;
    order.group_px = job.group_px;
    order.merge_entries = config_.merge.entries;
    order.on_overflow = config_.merge.on_overflow;
    order.walk_queue_entries = config_.vsu.queue_entries;
    order.background = job.background;
    return render_exact_order(job.view, stored_.decoded, stored_.tree, order);
  }
  PaperOrderConfig order;
  order.group_px = job.group_px;
  order.sample_step_voxels = static_cast<float>(config_.vsu.sample_step_voxels);
  order.background = job.background;
  return render_paper_order(job.view, stored_.decoded, stored_.grid, order);
}

}  // namespace sgs
