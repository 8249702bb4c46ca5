// From configuration to file, and back.
#include "testbench/streaminggs/packed_config.h"

#include <fmt/format.h>

#include "algorithm/input_error.h"

namespace sgs {

PackedFacts packed_facts(const AcceleratorConfig& config, const MemoryImage& image,
                         const std::string& name, std::uint64_t gaussians,
                         std::uint64_t dropped_invalid) {
  PackedFacts facts;
  facts.name = name;
  facts.gaussians = gaussians;
  facts.dropped_invalid = dropped_invalid;
  facts.stored = config.store_invisible ? Stored::kAll : Stored::kVisible;
  if (image.layout.storage_order == StorageOrder::kChunks) {
    facts.chunk_gaussians = config.chunk_gaussians;
  }
  facts.vq = config.vq;
  return facts;
}

void adopt(const PackedScene& packed, const std::string& path, AcceleratorConfig& config,
           std::vector<AutoChoice>& chosen) {
  const MemoryLayout& layout = packed.image.layout;
  const bool by_chunks = layout.storage_order == StorageOrder::kChunks;
  if (by_chunks != (config.ordering == Ordering::kExact)) {
    const char* image_order = by_chunks ? "exact" : "paper";
    throw InputError(fmt::format(
        "{}: stored by {}, for ordering {}; the configuration's ordering is {}: take --config {}, "
        "or pack the scene again with the other configuration",
        path, by_chunks ? "chunks" : "voxels", image_order, by_chunks ? "paper" : "exact",
        image_order));
  }
  config.encoding = layout.second_half.encoding;
  config.store_invisible = packed.facts.stored == Stored::kAll;
  config.vq = packed.facts.vq;
  if (by_chunks) {
    config.chunk_gaussians = packed.facts.chunk_gaussians;
    chosen.push_back(
        {"chunk_gaussians", config.chunk_gaussians, fmt::format("{} was packed with it", path)});
  } else {
    config.voxel_size = layout.voxel_frame.voxel_size;
  }
}

}  // namespace sgs
