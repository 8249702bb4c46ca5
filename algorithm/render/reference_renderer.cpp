// The frame in batches of splats, front to back: project a batch, bin it to tiles, blend. Batches
// bound the memory of splats and bins, keep them in the cache and end the frame early when every
// tile is finished.
#include "algorithm/render/reference_renderer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "algorithm/render/group_state.h"
#include "algorithm/render/splat_bins.h"
#include "algorithm/render/splat_sequence.h"

namespace sgs {
namespace {

constexpr std::size_t kBatchSplats = 32768;

void blend_run(const CellGrid& grid, const Splat* splats, std::size_t count,
               std::vector<GroupState>& tiles) {
  const SplatBins bins = bin_splats(grid, splats, count);
  tbb::parallel_for(std::size_t{0}, grid.size(), [&](std::size_t tile) {
    for (std::size_t i = bins.first[tile]; i != bins.first[tile + 1]; ++i) {
      if (tiles[tile].saturated()) return;
      tiles[tile].blend(splats[bins.entries[i]]);
    }
  });
}

}  // namespace

RenderResult render_reference(const View<float>& view, const ActivatedCloud& cloud,
                              const glm::vec3& background) {
  const CellGrid grid = cell_grid(view.width, view.height, kTilePx);
  std::vector<GroupState> tiles;
  tiles.reserve(grid.size());
  for (const PixelRect& pixels : pixel_groups(view.width, view.height, kTilePx)) {
    tiles.emplace_back(pixels, view.width, view.height);
  }

  const auto unfinished = [](const GroupState& tile) { return !tile.saturated(); };
  SplatSequence sequence(view, cloud);
  std::vector<Splat> batch;
  while (!sequence.at_end() && std::any_of(tiles.begin(), tiles.end(), unfinished)) {
    sequence.next(kBatchSplats, batch);
    for (std::size_t begin = 0; begin != batch.size();) {
      const std::size_t count = binnable(grid, batch, begin);
      blend_run(grid, batch.data() + begin, count, tiles);
      begin += count;
    }
  }

  RenderResult result;
  result.image = Image(view.width, view.height);
  result.transmittance.resize(result.image.pixels.size());
  result.contributors.resize(result.image.pixels.size());
  for (const GroupState& tile : tiles) tile.store(background, result);
  return result;
}

}  // namespace sgs
