// Placing of a scene's regions.
#include "algorithm/memory/scene_layout.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "algorithm/memory/records.h"
#include "algorithm/voxel/chunk_tree.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

namespace {

void place_records(const SecondHalfFormat& format, const RecordSplit& split,
                   std::uint32_t gaussians, SceneLayout& layout) {
  layout.second_half = format;
  layout.split = split;
  layout.first_halves = layout.regions.add_records("first_halves", split.first_bytes(), gaussians);
  layout.second_halves = layout.regions.add_records("second_halves", split.second_bytes, gaussians);
  layout.codebooks = layout.regions.add("codebooks", format.codebook_bytes());
}

}  // namespace

RegionSpan Regions::add(const std::string& name, std::uint64_t bytes) {
  if (std::any_of(begin(), end(), [&](const Region& region) { return region.name == name; })) {
    throw std::invalid_argument("two regions of the memory are called " + name);
  }
  if (size() > std::numeric_limits<RegionId>::max()) {
    throw std::length_error("no number is left for the memory's region " + name);
  }
  const auto id = static_cast<RegionId>(size());
  regions_.push_back({name, next_base(), bytes});
  return {id, regions_.back().base, bytes};
}

RecordArray Regions::add_records(const std::string& name, std::uint32_t record_bytes,
                                 std::uint64_t count) {
  return add(name, record_bytes * count).records(0, record_bytes, count);
}

std::uint64_t Regions::next_base() const {
  return (total_bytes() + kRegionAlignment - 1) / kRegionAlignment * kRegionAlignment;
}

RecordSplit split_of(StorageOrder order, const SecondHalfFormat& format) {
  const RecordSplit bursts = burst_split(format);
  const bool every_first_half = order == StorageOrder::kFile;
  const bool published = order == StorageOrder::kVoxels ||
                         (every_first_half && bursts.first_bytes() > kFirstHalfBytes);
  return published ? published_split(format) : bursts;
}

SceneLayout lay_out_voxels(const SecondHalfFormat& format, std::uint32_t gaussians,
                           const VoxelFrame& frame, std::uint32_t nodes, std::uint32_t voxels) {
  SceneLayout layout;
  const std::uint64_t node_bytes = std::uint64_t{nodes} * sizeof(VoxelNode);
  const std::uint64_t voxel_bytes = std::uint64_t{voxels} * sizeof(VoxelRecord);
  const std::uint32_t cuts = cut_count(gaussians);
  const RegionSpan region =
      layout.regions.add("voxel_table", node_bytes + voxel_bytes + cuts * sizeof(float));
  VoxelTableLayout table;
  table.frame = frame;
  table.nodes = region.records(0, sizeof(VoxelNode), nodes);
  table.voxels = region.records(node_bytes, sizeof(VoxelRecord), voxels);
  table.cuts = region.records(node_bytes + voxel_bytes, sizeof(float), cuts);
  layout.table = table;
  place_records(format, split_of(StorageOrder::kVoxels, format), gaussians, layout);
  layout.stored_bytes = layout.regions.next_base();
  return layout;
}

SceneLayout lay_out_chunks(const SecondHalfFormat& format, std::uint32_t gaussians,
                           std::uint32_t nodes, std::uint32_t chunks) {
  SceneLayout layout;
  place_records(format, split_of(StorageOrder::kChunks, format), gaussians, layout);
  ChunkTableLayout table;
  table.nodes = layout.regions.add_records("chunk_table", sizeof(ChunkNode), nodes);
  table.chunk_count = chunks;
  layout.table = table;
  layout.stored_bytes = layout.regions.next_base();
  return layout;
}

SceneLayout lay_out_file(const SecondHalfFormat& format, std::uint32_t gaussians) {
  SceneLayout layout;
  place_records(format, split_of(StorageOrder::kFile, format), gaussians, layout);
  layout.table = NoTableLayout{};
  layout.stored_bytes = layout.regions.next_base();
  return layout;
}

}  // namespace sgs
