// Reading of a scene out of its image.
#include "algorithm/storage/restore_scene.h"

#include <fmt/format.h>
#include <tbb/parallel_sort.h>

#include <cstring>
#include <numeric>
#include <utility>

#include "algorithm/input_error.h"
#include "algorithm/storage/decoded_image.h"
#include "algorithm/storage/stored_tables.h"

namespace sgs {
namespace {

std::vector<std::uint32_t> counted_up(std::uint32_t count) {
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0U);
  return numbers;
}

// Of each slot its place among the stored Gaussians in the order of the scene's file.
std::vector<std::uint32_t> file_ranks(const PackedScene& packed, const std::string& source) {
  const std::uint32_t stored = packed.image.layout.gaussian_count();
  std::vector<std::uint32_t> indices(stored);
  if (indices.empty()) return indices;
  std::memcpy(indices.data(), packed.image.at(packed.image.layout.chunk_table().indices.base),
              indices.size() * sizeof(std::uint32_t));
  std::vector<std::uint32_t> by_index = counted_up(stored);
  tbb::parallel_sort(by_index.begin(), by_index.end(), [&](std::uint32_t a, std::uint32_t b) {
    return indices[a] < indices[b] || (indices[a] == indices[b] && a < b);
  });
  std::vector<std::uint32_t> ranks(indices.size());
  for (std::uint32_t rank = 0; rank < by_index.size(); ++rank) {
    const std::uint32_t slot = by_index[rank], index = indices[slot];
    if (index >= packed.facts.gaussians || (rank > 0 && index == indices[by_index[rank - 1]])) {
      throw InputError(
          fmt::format("{}: index of slot {}: got {}, expected one below {} that no other slot has",
                      source, slot, index, packed.facts.gaussians));
    }
    ranks[slot] = rank;
  }
  return ranks;
}

}  // namespace

StoredScene restore_scene(PackedScene packed, const std::string& source) {
  StoredScene out;
  out.gaussians = packed.facts.gaussians;
  if (packed.storage.order == StorageOrder::kChunks) {
    std::vector<std::uint32_t> ranks = file_ranks(packed, source);
    out.decoded = decode_image(packed.image, ranks, source);
    out.table = read_chunk_table(packed.image, packed.storage.chunk_gaussians, std::move(ranks),
                                 out.decoded, source);
  } else {
    out.decoded =
        decode_image(packed.image, counted_up(packed.image.layout.gaussian_count()), source);
    out.table = read_voxel_table(packed.image, out.decoded, source);
  }
  out.storage = packed.storage;
  out.image = std::move(packed.image);
  return out;
}

}  // namespace sgs
