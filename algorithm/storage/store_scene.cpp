// From a configuration to encoded, laid-out scenes.
#include "algorithm/storage/store_scene.h"

#include <fmt/format.h>

#include <utility>

#include "algorithm/input_error.h"
#include "algorithm/storage/build_memory_image.h"
#include "algorithm/vq/image_weights.h"

namespace sgs {
namespace {

EncodedCloud encode(const ActivatedCloud& cloud, const StorageConfig& config,
                    const std::vector<Camera>& weighing, const VqProgress& progress) {
  if (config.encoding == SecondHalfEncoding::kHalf) return encode_half(cloud);
  const QuantisedCloud quantised = quantise(cloud, image_weights(cloud, weighing),
                                            pixel_sizes(cloud, weighing), config.vq, progress);
  return encode_quantised(cloud, quantised, config.encoding);
}

// Of voxels and chunks, before the work.
void check_sizes(const StorageConfig& config) {
  const bool by_chunks = config.order == StorageOrder::kChunks;
  if (by_chunks && config.chunk_gaussians == 0) {
    throw InputError("chunk_gaussians: got 0, expected 1 or more");
  }
  if (!by_chunks && !(static_cast<float>(config.voxel_size) > 0)) {
    throw InputError(fmt::format("voxel_size: got {}, expected more than 0, as a 32-bit float",
                                 config.voxel_size));
  }
}

// Builds the table of out.storage over `encoded`, and the image.
void lay_out(const EncodedCloud& encoded, StoredScene& out) {
  const StorageConfig& config = out.storage;
  const Stored stored = config.store_invisible ? Stored::kAll : Stored::kVisible;
  if (config.order == StorageOrder::kChunks) {
    out.table = build_chunk_tree(encoded.decoded, config.chunk_gaussians, stored);
    out.image = build_memory_image(encoded, out.tree());
  } else {
    out.table = build_voxel_grid(encoded.decoded, static_cast<float>(config.voxel_size), stored);
    out.image = build_memory_image(encoded, out.grid());
  }
}

}  // namespace

StoredScene store_scene(ActivatedCloud cloud, const StorageConfig& config,
                        const std::vector<Camera>& weighing, const VqProgress& progress) {
  check_sizes(config);
  StoredScene out;
  out.storage = config;
  out.gaussians = cloud.size();
  EncodedCloud encoded;
  if (config.encoding == SecondHalfEncoding::kRaw) {
    encoded = encode_raw(std::move(cloud));
  } else {
    encoded = encode(cloud, config, weighing, progress);
    out.original = std::move(cloud);
  }
  lay_out(encoded, out);
  out.decoded = std::move(encoded.decoded);
  return out;
}

}  // namespace sgs
