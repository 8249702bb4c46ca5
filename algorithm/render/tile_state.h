// The pixels of one 16x16 tile while the reference renderer blends them.
#pragma once

#include <cstdint>

#include "algorithm/render/render_result.h"
#include "algorithm/splat/blend.h"

namespace sgs {

class TileState {
 public:
  // tile_x, tile_y: in tiles from the frame's corner.
  TileState(int tile_x, int tile_y, int width_px, int height_px);

  // Blends the splats at `entries`, in this order, into the sub-tiles of their footprints.
  void blend(const Splat* splats, const std::uint32_t* begin, const std::uint32_t* end);

  // Whether every pixel is finished: nothing can change any more.
  bool finished() const { return open_ == 0; }

  // Writes the tile's pixels into the frame.
  void store(const glm::vec3& background, RenderResult& frame) const;

 private:
  void close_finished();

  int subtile_x0_, subtile_y0_;
  std::uint32_t open_ = 0;  // bit of each sub-tile with unfinished pixels
  SubtileState subtiles_[kSubtilesPerTile * kSubtilesPerTile];
};

}  // namespace sgs
