// A scene in one of the encodings: the bytes of its second halves, and what they decode to.
#pragma once

#include <cstddef>
#include <cstring>
#include <vector>

#include "algorithm/memory/scene_layout.h"
#include "algorithm/memory/second_half.h"
#include "algorithm/storage/stored_scene.h"
#include "algorithm/voxel/chunk_tree.h"
#include "algorithm/voxel/voxel_grid.h"
#include "algorithm/vq/quantise.h"

namespace sgs {

// Every golden image of an encoded scene is of `decoded`: the Gaussians that the units get out of
// the bytes, to the bit.
struct EncodedCloud {
  SecondHalfFormat format;
  ActivatedCloud decoded;
  std::vector<std::byte> records;    // [N] second halves; empty with raw, where `decoded` says all
  std::vector<std::byte> codebooks;  // [format.codebook_bytes()]

  // Writes the second half of Gaussian `index`, format.bytes() bytes.
  void write_second_half(std::size_t index, std::byte* out) const;
};

// order: as in ../splat/gaussian.h.
EncodedCloud reordered(EncodedCloud encoded, const std::vector<std::uint32_t>& order);

EncodedCloud encode_raw(ActivatedCloud cloud);
EncodedCloud encode_half(const ActivatedCloud& cloud);
// encoding: kVq or kVqPacked. quantised: of this cloud.
EncodedCloud encode_quantised(const ActivatedCloud& cloud, const QuantisedCloud& quantised,
                              SecondHalfEncoding encoding);

// The bytes of an encoded scene that is in storage order.

// The table is of scene.decoded: slots are its indices.
MemoryImage build_memory_image(const EncodedCloud& scene, const VoxelGrid& grid);
MemoryImage build_memory_image(const EncodedCloud& scene, const ChunkTree& tree);
MemoryImage build_memory_image(const EncodedCloud& scene, NoTable);

// The parts of an image: records and codebooks and, one by one, the order's own records.
MemoryImage store_gaussians(const EncodedCloud& scene, SceneLayout layout);

template <class Record>
void store_table(const std::vector<Record>& records, std::uint64_t address, MemoryImage& image) {
  if (records.empty()) return;
  std::memcpy(image.bytes.data() + address, records.data(), records.size() * sizeof(Record));
}

template <class Record>
std::uint32_t count_of(const std::vector<Record>& records) {
  return static_cast<std::uint32_t>(records.size());
}

}  // namespace sgs
