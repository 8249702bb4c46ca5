// Small scenes in every encoding and storage order, as pack would write them.
#pragma once

#include <string>
#include <vector>

#include "algorithm/storage/image_file.h"
#include "algorithm/storage/stored_scene.h"

namespace sgs::test {

// "builtin:object" cut to a SH degree, with Gaussians that nobody can see and with some that share
// a centre, so that depths tie.
ActivatedCloud cut_object(std::uint32_t count, int sh_degree);

// Voxels of 0.4 or chunks of 16; codebooks of few entries, no power of two, so that indices beyond
// them are possible.
StorageConfig small_storage(SecondHalfEncoding encoding, StorageOrder order);

// What is stored, and what a file of it would hold.
struct Packing {
  StoredScene stored;
  PackedFacts facts;

  PackedScene packed() const { return {facts, stored.storage, stored.image, 0}; }
};

Packing make_packing(const ActivatedCloud& cloud, SecondHalfEncoding encoding, StorageOrder order);

constexpr SecondHalfEncoding kEncodings[] = {SecondHalfEncoding::kRaw, SecondHalfEncoding::kHalf,
                                             SecondHalfEncoding::kVq,
                                             SecondHalfEncoding::kVqPacked};
constexpr StorageOrder kStorageOrders[] = {StorageOrder::kVoxels, StorageOrder::kChunks,
                                           StorageOrder::kFile};

}  // namespace sgs::test
