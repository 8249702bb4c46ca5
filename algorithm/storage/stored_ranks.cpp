// Reading of the indices beside a chunk table.
#include <fmt/format.h>
#include <tbb/parallel_sort.h>

#include <cstring>
#include <numeric>

#include "algorithm/input_error.h"
#include "algorithm/storage/stored_tables.h"

namespace sgs {

std::vector<std::uint32_t> read_file_ranks(const MemoryImage& image, std::uint64_t gaussians,
                                           const std::string& source) {
  const std::uint32_t stored = image.layout.gaussian_count();
  std::vector<std::uint32_t> indices(stored);
  if (indices.empty()) return indices;
  std::memcpy(indices.data(), image.at(image.layout.chunk_table().indices.base),
              indices.size() * sizeof(std::uint32_t));
  std::vector<std::uint32_t> by_index(stored);
  std::iota(by_index.begin(), by_index.end(), 0U);
  tbb::parallel_sort(by_index.begin(), by_index.end(), [&](std::uint32_t a, std::uint32_t b) {
    return indices[a] < indices[b] || (indices[a] == indices[b] && a < b);
  });
  std::vector<std::uint32_t> ranks(indices.size());
  for (std::uint32_t rank = 0; rank < by_index.size(); ++rank) {
    const std::uint32_t slot = by_index[rank], index = indices[slot];
    if (index >= gaussians || (rank > 0 && index == indices[by_index[rank - 1]])) {
      throw InputError(
          fmt::format("{}: index of slot {}: got {}, expected one below {} that no other slot has",
                      source, slot, index, gaussians));
    }
    ranks[slot] = rank;
  }
  return ranks;
}

}  // namespace sgs
