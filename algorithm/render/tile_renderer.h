// Tile-centric renderer, as GSCore (Lee et al., ASPLOS 2024) and the original draw: every Gaussian
// is projected and listed in the tiles that its boxes touch; each tile's list is sorted by depth
// and blended. With boxes that reach what is visible, in single precision, the picture is the
// reference's, bit for bit; each approximation is a choice of its own.
#pragma once

#include <cstdint>

#include "algorithm/memory/tile_records.h"
#include "algorithm/render/group_state.h"
#include "algorithm/render/render_result.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/tile_boxes.h"
#include "algorithm/splat/view.h"
#include "algorithm/voxel/chunk_tree.h"

namespace sgs {

struct TileOrderConfig {
  TileRules rules;
  NumberFormat features = NumberFormat::kHalf;  // format of projected Gaussians
  NumberFormat keys = NumberFormat::kHalf;      // equal ones stay in the order of the cloud
  BlendPrecision precision = BlendPrecision::kHalf;
  std::uint32_t chunk_entries = 256;  // sorted at once; counts whole chunks of sorted lists
  glm::vec3 background{0.0F};

  // The choices that lose nothing.
  static TileOrderConfig lossless() {
    TileOrderConfig config;
    config.rules.reach = TileReach::kVisible;
    config.features = config.keys = NumberFormat::kSingle;
    config.precision = BlendPrecision::kSingle;
    return config;
  }
};

struct TileStats {
  std::uint64_t gaussians = 0;
  std::uint64_t culled = 0;         // by FrameSides or boxes: they cannot touch the frame
  std::uint64_t projected = 0;      // Gaussians listed in a tile
  std::uint64_t tile_tests = 0;     // (Gaussian, tile) candidates
  std::uint64_t subtile_tests = 0;  // parts of tiles tested
  std::uint64_t pairs = 0;          // (Gaussian, tile) entries of lists
  std::uint64_t parts = 0;          // bits set in these entries
  std::uint64_t list_max = 0;       // longest list
  std::uint64_t entries_taken = 0;  // list entries read until their tile was finished
  std::uint64_t chunks = 0;         // chunks of sorted lists
  std::uint64_t chunks_taken = 0;   // chunks among these begun before their tile was finished
  // Entries of the chunks that were taken; the last one of a list may hold fewer.
  std::uint64_t chunk_entries_taken = 0;
  std::uint64_t tiles_finished = 0;
  std::uint64_t subtile_blends = 0;  // (entry, 4x4 sub-tile): 16 fragments each
  std::uint64_t contributors = 0;    // (splat, pixel) blends
  std::uint64_t warp_entries = 0;    // (entry, 16 x 2 px) with an unfinished pixel (blend_watch.h)
  std::uint64_t warp_blends = 0;     // pairs among these that blend into a pixel
  std::uint64_t contributing = 0;    // Gaussians blended into at least one pixel of the frame
  std::uint64_t misordered = 0;      // blends behind a splat that is farther, at the same pixel

  TileStats& operator+=(const TileStats& other);
};

struct TileResult {
  RenderResult frame;
  TileStats stats;
};

// Deterministic whatever the number of threads. boxes: the tree of the cloud's chunks, where those
// that cannot touch the frame are left out as wholes; null: every Gaussian is looked at. Throws
// InputError when more Gaussians are projected than an entry can tell apart.
TileResult render_tiles(const View<float>& view, const ActivatedCloud& cloud,
                        const TileOrderConfig& config, const ChunkTree* boxes = nullptr);

// One entry of a tile's list blended into the tile: the parts of the tile whose bits are set.

// Calls visit(splat) with what record and entry hold, as blending in that precision takes it: a
// Splat or a SquareSplat.
template <class Visit>
void with_record(NumberFormat format, BlendPrecision precision, const std::byte* record,
                 std::uint32_t listed_opacity, const Visit& visit) {
  if (in_16_bits(precision)) {
    visit(decode_square(format, record, listed_opacity));
  } else {
    visit(decode_projected(format, record, listed_opacity));
  }
}

// Calls blend(splat, part) with a footprint for each part of the tile (in tiles of the frame) whose
// bit is set.
template <class AnySplat, class Blend>
void for_each_part(const TileRules& rules, int tile_x, int tile_y, std::uint32_t bitmap,
                   AnySplat splat, const Blend& blend) {
  const int across = rules.subtiles_across, side = kSubtilesPerTile / across;
  const auto of_frame = [](int at) { return static_cast<std::uint16_t>(at); };
  for (int part = 0; part < across * across; ++part) {
    if ((bitmap >> part & 1U) == 0) continue;
    const int x = tile_x * kSubtilesPerTile + part % across * side;
    const int y = tile_y * kSubtilesPerTile + part / across * side;
    splat.footprint = {of_frame(x), of_frame(y), of_frame(x + side), of_frame(y + side)};
    blend(static_cast<const AnySplat&>(splat), part);
  }
}

}  // namespace sgs
