// The contiguous regions of the modelled DRAM; every byte on its bus belongs to one of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace sgs {

enum class Region : std::uint8_t {
  kVoxelTable,    // tree nodes and voxel records (paper order)
  kFirstHalves,   // centre and largest scale, 16 B a Gaussian
  kSecondHalves,  // everything else, in one of the encodings
  kCodebooks,     // what quantised second halves point into
  kChunkTable,    // nodes of the chunk tree (exact order)
  kIndices,       // file index of each slot, looked up only to break ties of depth (exact order)
  kSpill,         // sorted runs that did not fit on chip
  kFrameBuffer,   // finished pixels
};

constexpr std::size_t kRegionCount = 8;
constexpr std::array<const char*, kRegionCount> kRegionNames = {
    "voxel_table", "first_halves", "second_halves", "codebooks",
    "chunk_table", "indices",      "spill",         "frame_buffer"};

constexpr std::uint8_t region_id(Region region) { return static_cast<std::uint8_t>(region); }

}  // namespace sgs
