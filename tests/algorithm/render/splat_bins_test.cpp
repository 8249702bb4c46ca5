// The bins of blend_pass.h.
#include <catch2/catch.hpp>
#include <random>

#include "algorithm/render/blend_pass.h"

using namespace sgs;

TEST_CASE("every splat is in exactly the cells of its footprint, in order") {
  std::mt19937 random(2);
  const auto number = [&](int high) {
    return static_cast<std::uint16_t>(std::uniform_int_distribution<int>(0, high)(random));
  };
  for (const std::size_t count : {0U, 1U, 5U, 3000U}) {
    for (const PixelSize cell : {PixelSize{16, 16}, {64, 64}, {4, 4}, {40, 12}, {4, 64}}) {
      std::vector<Splat> splats(count);
      for (Splat& splat : splats) {
        splat.footprint = {number(17), number(12), 0, 0};
        splat.footprint.x1 = static_cast<std::uint16_t>(splat.footprint.x0 + number(9) / 3);
        splat.footprint.y1 = static_cast<std::uint16_t>(splat.footprint.y0 + number(9) / 3);
        splat.footprint = intersection(splat.footprint, SubtileRect{0, 0, 18, 13});
        if (splat.footprint.empty()) splat.footprint = {};
      }
      const CellGrid grid = cell_grid(70, 50, cell);
      const SplatBins bins = bin_splats(grid, splats.data(), count);
      REQUIRE(bins.first.size() == grid.size() + 1);
      for (int y = 0; y < grid.rows; ++y) {
        for (int x = 0; x < grid.columns; ++x) {
          std::vector<std::uint32_t> expected;
          const int across = cell.width / 4, down = cell.height / 4;
          for (std::uint32_t i = 0; i < count; ++i) {
            const SubtileRect& f = splats[i].footprint;
            if (f.x0 < (x + 1) * across && f.x1 > x * across && f.y0 < (y + 1) * down &&
                f.y1 > y * down) {
              expected.push_back(i);
            }
          }
          const auto at = static_cast<std::size_t>(y) * grid.columns + x;
          const std::vector<std::uint32_t> found(
              bins.entries.begin() + static_cast<std::ptrdiff_t>(bins.first[at]),
              bins.entries.begin() + static_cast<std::ptrdiff_t>(bins.first[at + 1]));
          REQUIRE(found == expected);
        }
      }
    }
  }
}

TEST_CASE("splats are binned in runs that bound the memory") {
  // 1024x1024 px in cells of 16 px: a giant takes 4096 pairs of at most 2^23 and one splat more.
  const CellGrid grid = cell_grid(1024, 1024, square_of(16));
  std::vector<Splat> splats(5000);
  CHECK(binnable(grid, splats, 0) == 5000);  // nothing of them is in the frame
  for (Splat& splat : splats) splat.footprint = {0, 0, 256, 256};
  CHECK(binnable(grid, splats, 0) == 2048);
  CHECK(binnable(grid, splats, 4000) == 1000);
  CHECK(binnable(grid, splats, 4999) == 1);
  const CellGrid huge = cell_grid(65536, 65536, square_of(16));
  splats[0].footprint = {0, 0, 16384, 16384};
  CHECK(binnable(huge, splats, 0) == 1);  // at least one, however large
}
