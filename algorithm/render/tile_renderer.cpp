// Projection by blocks of the cloud, lists in its order, then a task a tile.
#include "algorithm/render/tile_renderer.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/order/chunk_descent.h"
#include "algorithm/render/blend_watch.h"
#include "algorithm/splat/coarse_bound.h"

namespace sgs {
namespace {

struct TileSplat {
  std::array<std::byte, kRecordPlaceBytes> record;
  float depth;
  std::uint32_t opacity;  // listed
  std::uint32_t index;    // the Gaussian's
  TileBoxes boxes;
  std::uint32_t key;
};

// [Gaussian] whether it is looked at.
std::vector<char> looked_at(const View<float>& view, std::size_t count, const ChunkTree* boxes) {
  std::vector<char> out(count, boxes == nullptr ? 1 : 0);
  if (boxes == nullptr) return out;
  for_each_touching_chunk(*boxes, view, {0, 0, view.width, view.height},
                          [&](std::uint32_t first, std::uint32_t gaussians) {
                            std::fill_n(&out[first], gaussians, char{1});
                          });
  return out;
}

std::vector<TileSplat> project_block(const View<float>& view, const ActivatedCloud& cloud,
                                     const TileOrderConfig& config, const std::vector<char>& looked,
                                     std::size_t begin, std::size_t end, TileStats& stats) {
  std::vector<TileSplat> out;
  const FrameSides<float> sides = frame_sides(view);
  for (std::size_t i = begin; i != end; ++i) {
    const Gaussian<float>& g = cloud.gaussians[i];
    const float scale_max = std::max({g.scale.x, g.scale.y, g.scale.z});
    if (looked[i] == 0 || !may_touch_frame(view, sides, g.mean, scale_max)) {
      ++stats.culled;
      continue;
    }
    TileSplat made;
    Splat splat;
    if (!make_tile_geometry(view, g, config.rules, splat, made.boxes)) continue;
    add_colour(view, cloud.sh_degree, g.mean, cloud.sh(i), splat);
    encode_projected(config.features, splat, made.record.data());
    made.depth = splat.depth;
    made.opacity = listed_opacity(config.features, splat.opacity);
    made.index = static_cast<std::uint32_t>(i);
    made.key = depth_key(config.keys, splat.depth);
    out.push_back(made);
  }
  return out;
}

struct ListEntry {
  std::uint32_t key, splat, bitmap;
};

class Lists {
 public:
  Lists(const View<float>& view, const TileRules& rules)
      : rules_(rules), columns_((view.width + kTilePx - 1) / kTilePx) {
    lists_.resize(static_cast<std::size_t>(columns_) * ((view.height + kTilePx - 1) / kTilePx));
  }
  void add(const TileSplat& s, std::uint32_t number, TileStats& stats) {
    const auto parts = static_cast<std::uint32_t>(rules_.subtiles_across * rules_.subtiles_across);
    bool listed = false;
    for (int y = s.boxes.tiles.y0; y < s.boxes.tiles.y1; ++y) {
      for (int x = s.boxes.tiles.x0; x < s.boxes.tiles.x1; ++x) {
        ++stats.tile_tests;
        stats.subtile_tests += parts;
        const std::uint32_t bitmap = tile_bitmap(s.boxes, rules_, x, y);
        if (bitmap == 0) continue;
        listed = true;
        ++stats.pairs;
        stats.parts += static_cast<std::uint32_t>(__builtin_popcount(bitmap));
        lists_[static_cast<std::size_t>(y) * columns_ + x].push_back({s.key, number, bitmap});
      }
    }
    stats.projected += listed ? 1 : 0;
  }
  std::vector<ListEntry>& operator[](std::size_t tile) { return lists_[tile]; }
  std::size_t size() const { return lists_.size(); }
  int columns() const { return columns_; }

 private:
  const TileRules rules_;
  const int columns_;
  std::vector<std::vector<ListEntry>> lists_;
};

void render_tile(const View<float>& view, const TileOrderConfig& config, int tile_x, int tile_y,
                 const std::vector<TileSplat>& splats, std::vector<ListEntry>& list,
                 Flags& contributing, TileStats& stats, RenderResult& frame) {
  std::stable_sort(list.begin(), list.end(),
                   [](const ListEntry& a, const ListEntry& b) { return a.key < b.key; });
  const PixelRect pixels = intersection(
      PixelRect{tile_x * kTilePx, tile_y * kTilePx, (tile_x + 1) * kTilePx, (tile_y + 1) * kTilePx},
      PixelRect{0, 0, view.width, view.height});
  GroupState state(pixels, view.width, view.height, config.precision, SubtileTest::kBox);
  BlendWatch watch(state.subtile_count());
  WarpWatch warps(pixels);
  for (const ListEntry& entry : list) {
    if (state.saturated()) break;
    ++stats.entries_taken;
    const TileSplat& splat = splats[entry.splat];
    const auto observe = [&](const SubtileBlend& blend) {
      if (watch.see(blend, splat.depth)) contributing.set(splat.index);
      warps.see(blend);
    };
    const auto blend = [&](const auto& part, int) {
      stats.subtile_blends += state.blend(part, observe).blended;
    };
    with_record(config.features, config.precision, splat.record.data(), splat.opacity,
                [&](const auto& record) {
                  for_each_part(config.rules, tile_x, tile_y, entry.bitmap, record, blend);
                });
    warps.end_entry();
  }
  const auto chunks = [&](std::uint64_t entries) {
    return (entries + config.chunk_entries - 1) / config.chunk_entries;
  };
  stats.list_max = list.size();
  stats.chunks = chunks(list.size());
  stats.chunks_taken = chunks(stats.entries_taken);
  stats.chunk_entries_taken =
      std::min<std::uint64_t>(list.size(), stats.chunks_taken * config.chunk_entries);
  stats.tiles_finished = state.saturated() ? 1 : 0;
  stats.contributors = state.contributors();
  stats.warp_entries = warps.entries();
  stats.warp_blends = warps.blended();
  stats.misordered = watch.misordered();
  state.store(config.background, frame);
}

}  // namespace

TileStats& TileStats::operator+=(const TileStats& o) {
  gaussians += o.gaussians;
  culled += o.culled;
  projected += o.projected;
  tile_tests += o.tile_tests;
  subtile_tests += o.subtile_tests;
  pairs += o.pairs;
  parts += o.parts;
  list_max = std::max(list_max, o.list_max);
  entries_taken += o.entries_taken;
  chunks += o.chunks;
  chunks_taken += o.chunks_taken;
  chunk_entries_taken += o.chunk_entries_taken;
  tiles_finished += o.tiles_finished;
  subtile_blends += o.subtile_blends;
  contributors += o.contributors;
  warp_entries += o.warp_entries;
  warp_blends += o.warp_blends;
  contributing += o.contributing;
  misordered += o.misordered;
  return *this;
}

TileResult render_tiles(const View<float>& view, const ActivatedCloud& cloud,
                        const TileOrderConfig& config, const ChunkTree* boxes) {
  constexpr std::size_t kBlock = 8192;
  const std::size_t count = cloud.size(), blocks = (count + kBlock - 1) / kBlock;
  std::vector<std::vector<TileSplat>> of_block(blocks);
  std::vector<TileStats> block_stats(blocks);
  const std::vector<char> looked = looked_at(view, count, boxes);
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
    of_block[b] = project_block(view, cloud, config, looked, b * kBlock,
                                std::min(count, (b + 1) * kBlock), block_stats[b]);
  });
  TileResult out;
  out.stats.gaussians = count;
  std::vector<TileSplat> splats;
  for (std::size_t b = 0; b < blocks; ++b) {
    out.stats += block_stats[b];
    splats.insert(splats.end(), of_block[b].begin(), of_block[b].end());
    of_block[b] = {};
  }
  const std::uint64_t most =
      EntryFormat{config.keys, config.rules.subtiles_across, config.features}.records();
  if (splats.size() >= most) {
    throw InputError(
        fmt::format("scene: {} Gaussians projected, expected fewer than {}", splats.size(), most));
  }
  Lists lists(view, config.rules);
  for (std::uint32_t s = 0; s < splats.size(); ++s) lists.add(splats[s], s, out.stats);

  out.frame = RenderResult(view.width, view.height);
  std::vector<TileStats> tile_stats(lists.size());
  Flags contributing(cloud.size());
  tbb::parallel_for(std::size_t{0}, lists.size(), [&](std::size_t t) {
    const int column = static_cast<int>(t) % lists.columns();
    const int row = static_cast<int>(t) / lists.columns();
    render_tile(view, config, column, row, splats, lists[t], contributing, tile_stats[t],
                out.frame);
  });
  for (const TileStats& stats : tile_stats) out.stats += stats;
  out.stats.contributing = contributing.count();
  return out;
}

}  // namespace sgs
