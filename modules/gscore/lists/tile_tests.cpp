// The testing thread of the tile lister: which tiles of the pass a Gaussian touches, which parts.
#include <algorithm>

#include "modules/datapath/work_rates.h"
#include "modules/gscore/lists/tile_lister.h"

namespace sgs::gscore {

void TileLister::run_test() {
  const bool empty = job_.layout.gaussian_count() == 0;
  for (Pass pass = test_passes_.pop(test_); !pass.over; pass = test_passes_.pop(test_)) {
    bool end_of_pass = empty;
    for (std::uint64_t s = 0; !end_of_pass; ++s) {
      FifoReadIf<Converted>& ccu = in_turn(converted, s);
      for (bool last = false; !last;) {
        const Converted next = ccu.pop(test_);
        last = next.last;
        end_of_pass = next.end_of_pass;
        if (next.there) test_tiles(next, 0, pass);
        if (next.right.there) test_tiles(next.right, 1, pass);
        counters_.second_eyes += next.there && next.right.there ? 1 : 0;
        if (!next.any_there()) {
          test_.work(1);
          ++counters_.ends_alone;
        }
      }
    }
    ListedTile end;
    end.end = true;
    test_.work(1);
    listed_.push(end, test_);
  }
  test_.idles();
}

// Tiles of rows that the pass has: neighbours in a turn of their lanes, then the parts of each that
// is touched, one after the other. The place of a Gaussian without a listed tile is the next one's.
void TileLister::test_tiles(const ConvertedForEye& gaussian, std::uint32_t eye, const Pass& pass) {
  ++counters_.gaussians;
  const auto columns = static_cast<int>(job_.columns);
  const PixelRect& tiles = gaussian.boxes.tiles;
  const std::uint32_t of_frame = job_.first_tile(job_.frame_of(pass.first));
  const int first_row = static_cast<int>(pass.first - of_frame) / columns;
  const int end_row = static_cast<int>(cycles_for(pass.end - of_frame, job_.columns));
  if (tiles.y0 >= end_row || tiles.y1 <= first_row) {
    test_.work(1);
    ++counters_.gaussians_off_pass;
    return;
  }
  const auto at_once = static_cast<int>(config_.lists.tiles_at_once);
  const std::uint64_t part_interval = part_path_ ? part_path_->interval_cycles() : 1;
  tested_[next_tested_] = {gaussian.splat, depth_key(config_.tiles.keys, gaussian.splat.depth)};
  ListedTile out;
  out.gaussian = next_tested_;
  out.first = true;
  for (int y = std::max(tiles.y0, first_row); y < std::min(tiles.y1, end_row); ++y) {
    for (int x = tiles.x0; x < tiles.x1; x += at_once) {
      wait_for_turn(test_, tile_path_.interval_cycles());
      const std::uint64_t begun = test_.clock().now_cycles();
      test_.works_until(begun + tile_path_.interval_cycles());
      ++counters_.tile_steps;
      for (int k = x; k < std::min(x + at_once, tiles.x1); ++k) {
        ++counters_.tile_tests;
        out.tile =
            of_frame + static_cast<std::uint32_t>(y * columns + k) + eye * job_.columns_of_eye();
        if (out.tile < pass.first || out.tile >= pass.end) continue;
        if (!touches_tile(gaussian.boxes, k, y)) continue;
        wait_for_turn(test_, part_interval);
        test_.work(part_interval);
        ++counters_.part_tests;
        out.bitmap = part_bitmap(gaussian.boxes, config_.tiles.rules(), k, y);
        if (out.bitmap == 0) continue;
        listed_.push(out, test_);
        out.first = false;
      }
      const std::uint64_t taken = test_.clock().now_cycles() - begun;
      if (taken < tile_path_.interval_cycles()) test_.work(tile_path_.interval_cycles() - taken);
    }
  }
  if (!out.first) next_tested_ = (next_tested_ + 1) % static_cast<std::uint32_t>(tested_.size());
}

}  // namespace sgs::gscore
