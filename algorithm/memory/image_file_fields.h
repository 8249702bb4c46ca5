// What writer and reader of memory image files share: where the header's fields lie, and one list
// of them. Eight bytes for std::uint64_t, four for everything else (floats as their bits, signed
// numbers as two's complement).
#pragma once

#include <array>
#include <limits>
#include <type_traits>

#include "algorithm/memory/image_file.h"

namespace sgs {

constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'S', 'G', 'S', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t kVersionAt = 8, kHeaderBytesAt = 12, kLengthAt = 16, kFieldsAt = 24;
constexpr std::size_t kChecksumBytes = 4;

template <class T>
constexpr std::size_t field_bytes() {
  return std::is_same_v<T, std::uint64_t> ? 8 : 4;
}

// Regions that lie in the file: all before the first that a frame writes.
constexpr std::size_t kFileRegions = region_id(Region::kSpill);

// Calls fields(name, value, lowest, highest) for each field in the order of the file; Facts and
// Layout may be const.
template <class Fields, class Facts, class Layout>
void visit_fields(Fields& fields, Facts& facts, Layout& layout) {
  constexpr double kWord = std::numeric_limits<std::uint32_t>::max();
  constexpr double kAny = static_cast<double>(std::numeric_limits<std::uint64_t>::max());
  constexpr double kMostSize = std::numeric_limits<float>::max();
  constexpr double kMostCells = 1 << 30;
  constexpr double kMostDegree = 3, kMostLevels = 10, kMostChunk = 65535, kMostIterations = 1000;
  fields("storage order", layout.storage_order, 0, 1);    // voxels, chunks
  fields("encoding", layout.second_half.encoding, 0, 3);  // as SecondHalfEncoding
  fields("SH degree", layout.second_half.sh_degree, 0, kMostDegree);
  fields("Gaussians in the scene", facts.gaussians, 0, kWord);  // indices have 32 bits
  fields("Gaussians dropped as invalid", facts.dropped_invalid, 0, kAny);
  fields("stored", facts.stored, 0, 1);  // all, visible
  fields("stored Gaussians", layout.gaussian_count, 0, kWord);
  fields("most Gaussians in a chunk", facts.chunk_gaussians, 0, kMostChunk);
  fields("chunk nodes", layout.chunk_node_count, 0, kWord);
  fields("chunks", layout.chunk_count, 0, kWord);
  fields("voxel nodes", layout.node_count, 0, kWord);
  fields("voxels", layout.voxel_count, 0, kWord);
  fields("voxel size", layout.voxel_frame.voxel_size, 0, kMostSize);
  fields("voxel levels", layout.voxel_frame.levels, 1, kMostLevels);
  fields("first cell, x", layout.voxel_frame.origin_cell.x, -kMostCells, kMostCells);
  fields("first cell, y", layout.voxel_frame.origin_cell.y, -kMostCells, kMostCells);
  fields("first cell, z", layout.voxel_frame.origin_cell.z, -kMostCells, kMostCells);
  for (auto& entries : layout.second_half.entries) {
    fields("codebook entries", entries, 0, kMaxCodebookEntries);
  }
  fields("vq.scale_entries", facts.vq.scale_entries, 1, kMaxCodebookEntries);
  fields("vq.rotation_entries", facts.vq.rotation_entries, 1, kMaxCodebookEntries);
  fields("vq.dc_entries", facts.vq.dc_entries, 1, kMaxCodebookEntries);
  fields("vq.sh_entries", facts.vq.sh_entries, 1, kMaxCodebookEntries);
  fields("vq.iterations", facts.vq.iterations, 0, kMostIterations);
  fields("vq.seed", facts.vq.seed, 0, kAny);
  for (std::size_t region = 0; region < kFileRegions; ++region) {
    fields(kRegionNames[region], layout.regions[region].base, 0, kAny);
    fields(kRegionNames[region], layout.regions[region].bytes, 0, kAny);
  }
}

// Of a header with an empty name.
std::size_t least_header_bytes();

// CRC-32 of bytes behind those whose checksum is `before`; 0 to begin with.
std::uint32_t checksum_of(std::uint32_t before, const void* bytes, std::size_t size);

}  // namespace sgs
