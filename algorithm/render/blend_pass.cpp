// All splats of a frame in order of depth, and the cells that they fall on.
#include "algorithm/render/blend_pass.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>

#include "algorithm/files/input_error.h"
#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/make_splat.h"

namespace sgs {

namespace {

constexpr int kDigitBits = 11;  // 3 passes for 32 bits; a table of 2,048 counts stays in L1
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
constexpr std::size_t kBlock = 65536;
using Counts = std::array<std::uint32_t, kDigits>;

std::size_t digit(const DepthKey& key, int shift) {
  return (key.depth_bits >> shift) & (kDigits - 1);
}

// Runs body(block, begin, end) for each block of `count` keys.
template <class Body>
void for_blocks(std::size_t count, const Body& body) {
  tbb::parallel_for(std::size_t{0}, (count + kBlock - 1) / kBlock, [&](std::size_t block) {
    body(block, block * kBlock, std::min(count, (block + 1) * kBlock));
  });
}

// One pass: `from` to `to` by the digit at `shift`, stable.
void scatter(const std::vector<DepthKey>& from, std::vector<DepthKey>& to, int shift,
             std::vector<Counts>& counts) {
  for_blocks(from.size(), [&](std::size_t block, std::size_t begin, std::size_t end) {
    counts[block].fill(0);
    for (std::size_t i = begin; i != end; ++i) ++counts[block][digit(from[i], shift)];
  });
  std::uint32_t sum = 0;
  for (std::size_t d = 0; d != kDigits; ++d) {
    for (Counts& block : counts) {
      const std::uint32_t count = block[d];
      block[d] = sum;
      sum += count;
    }
  }
  for_blocks(from.size(), [&](std::size_t block, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i != end; ++i) to[counts[block][digit(from[i], shift)]++] = from[i];
  });
}

// Keys of the Gaussians [begin, end) that may be visible.
std::vector<DepthKey> keys_of_block(const View<float>& view, const ActivatedCloud& cloud,
                                    std::size_t begin, std::size_t end) {
  const PixelRect frame{0, 0, view.width, view.height};
  std::vector<DepthKey> keys;
  keys.reserve(end - begin);
  for (std::size_t i = begin; i != end; ++i) {
    const Gaussian<float>& g = cloud.gaussians[i];
    const float scale_max = std::max({g.scale.x, g.scale.y, g.scale.z});
    const CoarseBound bound = coarse_bound(view, g.mean, scale_max);
    if (!bound.in_front || !touches(bound, frame)) continue;
    keys.push_back({__builtin_bit_cast(std::uint32_t, bound.depth), static_cast<std::uint32_t>(i)});
  }
  return keys;
}

// Each block has a table of one count a cell: few blocks, so that a large frame costs no more than
// a few megabytes.
constexpr std::size_t kBlocks = 8;

template <class Body>
void for_cells(const CellGrid& grid, const SubtileRect& footprint, const Body& body) {
  const CellRect cells = cells_of(grid, footprint);
  for (int y = cells.y0; y < cells.y1; ++y) {
    for (int x = cells.x0; x < cells.x1; ++x) {
      body(static_cast<std::size_t>(y) * grid.columns + x);
    }
  }
}

}  // namespace

// A stable radix sort of the depths; since the keys come ordered by index, stability breaks the
// ties. A million keys take 11 ms on two cores, tbb::parallel_sort 67.

void sort_front_to_back(std::vector<DepthKey>& keys) {
  std::vector<DepthKey> other(keys.size());
  std::vector<Counts> counts((keys.size() + kBlock - 1) / kBlock);
  for (int shift = 0; shift < 32; shift += kDigitBits) {
    scatter(keys, other, shift, counts);
    keys.swap(other);
  }
}

SplatSequence::SplatSequence(const View<float>& view, const ActivatedCloud& cloud)
    : view_(view), cloud_(cloud) {
  constexpr std::size_t kBlock = 8192;
  const std::size_t count = cloud.size();
  if (count > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError("scene: " + std::to_string(count) + " Gaussians, expected fewer than 2^32");
  }
  std::vector<std::vector<DepthKey>> blocks((count + kBlock - 1) / kBlock);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t block) {
    blocks[block] =
        keys_of_block(view_, cloud_, block * kBlock, std::min(count, (block + 1) * kBlock));
  });
  for (const auto& block : blocks) keys_.insert(keys_.end(), block.begin(), block.end());
  sort_front_to_back(keys_);
}

void SplatSequence::next(std::size_t most, std::vector<Splat>& batch) {
  // Depth order jumps through the cloud: without fetching ahead, half of the time is waiting.
  // Written out here because gcc takes a function of nothing but prefetches for one without effect.
  constexpr std::size_t kAhead = 12;  // Gaussians: memory latency over the time of one
  constexpr int kCoeffsPerLine = 5;   // 60 of 64 B: no line is stepped over
  const int sh_count = sh_coeff_count(cloud_.sh_degree);
  batch.resize(std::min(most, keys_.size() - next_));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, batch.size(), 512), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const std::uint32_t index = keys_[next_ + i].index;
      const std::uint32_t ahead = keys_[std::min(next_ + i + kAhead, keys_.size() - 1)].index;
      __builtin_prefetch(&cloud_.gaussians[ahead]);
      __builtin_prefetch(&cloud_.gaussians[ahead].opacity);
      for (int k = 0; k < sh_count; k += kCoeffsPerLine) __builtin_prefetch(cloud_.sh(ahead) + k);

      const Gaussian<float>& g = cloud_.gaussians[index];
      Splat& splat = batch[i];
      if (!make_geometry(view_, g, splat)) {
        splat.footprint = {};
        continue;
      }
      splat.index = index;
      add_colour(view_, cloud_.sh_degree, g.mean, cloud_.sh(index), splat);
    }
  });
  next_ += batch.size();
  batch.erase(std::remove_if(batch.begin(), batch.end(),
                             [](const Splat& splat) { return splat.footprint.empty(); }),
              batch.end());
}

CellGrid cell_grid(int width_px, int height_px, const PixelSize& cell) {
  return {(width_px + cell.width - 1) / cell.width, (height_px + cell.height - 1) / cell.height,
          cell.width / kSubtilePx, cell.height / kSubtilePx};
}

CellRect cells_of(const CellGrid& grid, const SubtileRect& footprint) {
  const int across = grid.cell_columns, down = grid.cell_rows;
  return {footprint.x0 / across, footprint.y0 / down, (footprint.x1 + across - 1) / across,
          (footprint.y1 + down - 1) / down};
}

std::size_t binnable(const CellGrid& grid, const std::vector<Splat>& splats, std::size_t begin) {
  constexpr std::size_t kMostPairs = std::size_t{1} << 23;  // (splat, cell): 32 MB of entries
  std::size_t pairs = 0, end = begin;
  while (end < splats.size() && (end == begin || pairs < kMostPairs)) {
    pairs += cells_of(grid, splats[end++].footprint).size();
  }
  return end - begin;
}

SplatBins bin_splats(const CellGrid& grid, const Splat* splats, std::size_t count) {
  const std::size_t block_size = (count + kBlocks - 1) / kBlocks;
  const auto for_block = [&](std::size_t block, const auto& body) {
    const std::size_t begin = std::min(count, block * block_size);
    const std::size_t end = std::min(count, begin + block_size);
    for (std::size_t i = begin; i != end; ++i) {
      for_cells(grid, splats[i].footprint, [&](std::size_t cell) { body(i, cell); });
    }
  };

  std::vector<std::vector<std::size_t>> place(kBlocks);
  tbb::parallel_for(std::size_t{0}, kBlocks, [&](std::size_t block) {
    place[block].assign(grid.size(), 0);
    for_block(block, [&](std::size_t, std::size_t cell) { ++place[block][cell]; });
  });
  SplatBins bins;
  bins.first.resize(grid.size() + 1);
  std::size_t sum = 0;
  for (std::size_t cell = 0; cell != grid.size(); ++cell) {
    bins.first[cell] = sum;
    for (auto& block : place) {
      const std::size_t in_block = block[cell];
      block[cell] = sum;
      sum += in_block;
    }
  }
  bins.first[grid.size()] = sum;
  bins.entries.resize(sum);
  tbb::parallel_for(std::size_t{0}, kBlocks, [&](std::size_t block) {
    for_block(block, [&](std::size_t i, std::size_t cell) {
      bins.entries[place[block][cell]++] = static_cast<std::uint32_t>(i);
    });
  });
  return bins;
}

}  // namespace sgs
