// The blend pass with nobody looking.
#include "algorithm/render/reference_renderer.h"

#include <algorithm>
#include <cstddef>

#include "algorithm/render/blend_pass.h"
#include "algorithm/render/group_state.h"
#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/make_splat.h"

namespace sgs {

namespace {

CellGrid tile_grid(const View<float>& view) {
  return cell_grid(view.width, view.height, square_of(kTilePx));
}

// How many flags are set in any rectangle of tiles.
class FlagSums {
 public:
  FlagSums(const CellGrid& grid, const std::vector<char>& flags)
      : columns_(static_cast<std::size_t>(grid.columns) + 1),
        sums_(columns_ * (static_cast<std::size_t>(grid.rows) + 1)) {
    for (std::size_t at = 0; at < flags.size(); ++at) {
      const std::size_t x = at % (columns_ - 1), y = at / (columns_ - 1);
      sums_[(y + 1) * columns_ + x + 1] = flags[at] + sums_[y * columns_ + x + 1] +
                                          sums_[(y + 1) * columns_ + x] - sums_[y * columns_ + x];
    }
  }
  bool any(const CellRect& cells) const {
    const auto sum = [&](int x, int y) {
      return sums_[static_cast<std::size_t>(y) * columns_ + static_cast<std::size_t>(x)];
    };
    return cells.x0 < cells.x1 && cells.y0 < cells.y1 &&
           sum(cells.x1, cells.y1) - sum(cells.x0, cells.y1) - sum(cells.x1, cells.y0) +
                   sum(cells.x0, cells.y0) >
               0;
  }

 private:
  std::size_t columns_;
  std::vector<int> sums_;  // [rows + 1, columns + 1]
};

// The tile of a place, and the one behind it, cut to the frame; of no number, all lie between.
int tile_from(float px, int count) {
  return px >= 0 ? static_cast<int>(std::min(px / kTilePx, static_cast<float>(count))) : 0;
}
int tile_behind(float px, int count) {
  if (!(px < static_cast<float>(count * kTilePx))) return count;
  return px < 0 ? 0 : static_cast<int>(px / kTilePx) + 1;
}

// Tiles that a Gaussian may reach, and perhaps more.
CellRect tiles_near(const CellGrid& grid, const CoarseBound& bound) {
  const float reach = std::min(bound.reach_px, bound.square_px) + 1;
  return {tile_from(bound.x - reach, grid.columns), tile_from(bound.y - reach, grid.rows),
          tile_behind(bound.x + reach, grid.columns), tile_behind(bound.y + reach, grid.rows)};
}

// The Gaussians that may reach a flagged tile, in the order of their ranks.
std::vector<std::uint32_t> reaching(const View<float>& view, const ActivatedCloud& cloud,
                                    const std::vector<std::uint32_t>& ranks,
                                    const std::vector<char>& tiles) {
  const CellGrid grid = tile_grid(view);
  const FlagSums flags(grid, tiles);
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const Gaussian<float>& g = cloud.gaussians[i];
    const CoarseBound bound =
        coarse_bound(view, g.mean, std::max({g.scale.x, g.scale.y, g.scale.z}));
    if (bound.in_front && flags.any(tiles_near(grid, bound))) out.push_back(i);
  }
  std::sort(out.begin(), out.end(),
            [&](std::uint32_t a, std::uint32_t b) { return ranks[a] < ranks[b]; });
  return out;
}

}  // namespace

RenderResult render_reference(const View<float>& view, const ActivatedCloud& cloud,
                              const glm::vec3& background) {
  const std::vector<GroupState> tiles =
      blend_scene(view, cloud, [](GroupState& tile, const Splat& splat) { tile.blend(splat); });
  RenderResult result(view.width, view.height);
  for (const GroupState& tile : tiles) tile.store(background, result);
  return result;
}

std::vector<char> tiles_of_ties(const View<float>& view, const ActivatedCloud& cloud,
                                const std::vector<std::uint32_t>& ranks) {
  const SplatSequence sequence(view, cloud);
  const std::vector<DepthKey>& keys = sequence.keys();
  const CellGrid grid = tile_grid(view);
  std::vector<char> tiles(grid.size(), 0);
  std::vector<std::size_t> seen_by(grid.size(), keys.size());  // the last run that fell on a tile
  for (std::size_t first = 0, end = 0; first < keys.size(); first = end) {
    bool swapped = false;
    for (end = first + 1; end < keys.size() && keys[end].depth_bits == keys[first].depth_bits;
         ++end) {
      swapped |= ranks[keys[end - 1].index] > ranks[keys[end].index];
    }
    for (std::size_t k = first; swapped && k < end; ++k) {
      Splat splat;
      if (!make_geometry(view, cloud.gaussians[keys[k].index], splat)) continue;
      const CellRect cells = cells_of(grid, splat.footprint);
      for (int y = cells.y0; y < cells.y1; ++y) {
        for (int x = cells.x0; x < cells.x1; ++x) {
          const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.columns) +
                          static_cast<std::size_t>(x);
          if (seen_by[at] == first) tiles[at] = 1;
          seen_by[at] = first;
        }
      }
    }
  }
  return tiles;
}

Image picture_by_ranks(const View<float>& view, const ActivatedCloud& cloud,
                       const std::vector<std::uint32_t>& ranks, const glm::vec3& background,
                       const std::vector<char>& tiles, const Image& picture) {
  const ActivatedCloud by_ranks = reordered(cloud, reaching(view, cloud, ranks, tiles));
  const Image drawn = render_reference(view, by_ranks, background).image;
  Image out = picture;
  const std::vector<PixelRect> rects = pixel_groups(view.width, view.height, square_of(kTilePx));
  for (std::size_t at = 0; at < rects.size(); ++at) {
    if (tiles[at] == 0) continue;
    for (int y = rects[at].y0; y < rects[at].y1; ++y) {
      const auto row = static_cast<std::ptrdiff_t>(y) * view.width;
      std::copy(drawn.pixels.begin() + row + rects[at].x0,
                drawn.pixels.begin() + row + rects[at].x1, out.pixels.begin() + row + rects[at].x0);
    }
  }
  return out;
}

}  // namespace sgs
