// Binning by counting: blocks of splats count their cells, a prefix sum gives each block its place
// in each cell's list, the blocks write.
#include "algorithm/render/splat_bins.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace sgs {
namespace {

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
