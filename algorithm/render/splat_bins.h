// Which splats fall on which cell of a grid over the frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/splat/constants.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/splat.h"

namespace sgs {

// A grid of equal cells over the frame, row by row from the top left.
struct CellGrid {
  int columns = 0, rows = 0;
  int cell_columns = 0, cell_rows = 0;  // size of a cell, in sub-tiles of 4 px
  std::size_t size() const { return static_cast<std::size_t>(columns) * rows; }
};

// cell: multiples of 4.
CellGrid cell_grid(int width_px, int height_px, const PixelSize& cell);

// Cells [x0, x1) x [y0, y1) that a non-empty footprint overlaps.
struct CellRect {
  int x0, y0, x1, y1;
  std::size_t size() const { return static_cast<std::size_t>(x1 - x0) * (y1 - y0); }
};
CellRect cells_of(const CellGrid& grid, const SubtileRect& footprint);

// How many of splats[begin ..) can be binned at once, at least one: bins of giants would fill the
// memory.
std::size_t binnable(const CellGrid& grid, const std::vector<Splat>& splats, std::size_t begin);

struct SplatBins {
  std::vector<std::size_t> first;      // [cells + 1] where each cell's list begins
  std::vector<std::uint32_t> entries;  // positions in the splats given, ascending in each cell
};

// Bins splats[0 .. count) by their footprints. 4 bytes a (splat, cell) pair.
SplatBins bin_splats(const CellGrid& grid, const Splat* splats, std::size_t count);

}  // namespace sgs
