// The drain of a rendering core register by register: marks behind the blocks of their tile, and
// the row of pixels that stands in its register. While its words leave, the next row takes their
// places, if it is no faster than they.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "tests/modules/clocked/clocked_port.h"

namespace sgs::test {

struct CoreTile {
  std::uint32_t outside = 0;     // blocks beside the frame, a bit each
  std::uint32_t row_cycles = 0;  // of a row of pixels
  std::vector<ClockedTransfer> rows;
};

class ClockedDrain {
 public:
  explicit ClockedDrain(const PortHardware& port) : port_(port) {}

  struct Mark {
    std::uint64_t leaves;  // the pipeline, in this cycle
    bool of_tile;          // or of the frame
    std::uint32_t tile;
  };
  void mark(const Mark& mark) { marks_.push_back(mark); }

  // Whether a transaction of pixels has left.
  bool step(std::uint64_t now, const std::vector<CoreTile>& tiles) {
    port_.begin_cycle();
    frees_pixels_ = false;
    if (frame_ends_) {
      ended_ = true;
      frame_ends_ = false;
      return false;
    }
    const bool sends = drains_ && now >= row_full_ && send(now, tiles[*drains_]);
    if (!drains_) take_mark(now, tiles);
    return sends;
  }
  bool frees_pixels() const { return frees_pixels_; }  // of a tile, in this cycle
  bool done() const { return ended_; }                 // the end of the frame has been put out

 private:
  bool send(std::uint64_t now, const CoreTile& tile) {
    const std::uint64_t bytes_before = row_left_.bytes;
    if (port_.write(row_left_)) {
      end_row(now, tile);
      return true;
    }
    const std::uint64_t left = bytes_before - row_left_.bytes;
    if (left > 0 && tile.row_cycles >= port_.words(tile.rows[row_].bytes)) {
      made_ += static_cast<std::uint32_t>(port_.words(left));
    }
    return left > 0;
  }
  void end_row(std::uint64_t now, const CoreTile& tile) {
    row_full_ = now + tile.row_cycles - std::min(made_, tile.row_cycles);
    made_ = 0;
    if (++row_ < tile.rows.size()) {
      row_left_ = tile.rows[row_];
      return;
    }
    drains_.reset();
    frees_pixels_ = true;
  }
  void take_mark(std::uint64_t now, const std::vector<CoreTile>& tiles) {
    if (marks_.empty() || now < marks_.front().leaves) return;
    if (marks_.front().of_tile) {
      drains_ = marks_.front().tile;
      row_ = 0;
      row_left_ = tiles[*drains_].rows[0];
      row_full_ = now + tiles[*drains_].row_cycles;
    } else {
      if (!port_.idle()) return;
      frame_ends_ = true;
    }
    marks_.pop_front();
  }

  ClockedPort port_;
  std::deque<Mark> marks_;
  std::optional<std::uint32_t> drains_;  // tile
  std::size_t row_ = 0;
  ClockedTransfer row_left_;
  std::uint64_t row_full_ = 0;  // from this cycle on
  std::uint32_t made_ = 0;      // cycles of the next row, while one leaves
  bool frees_pixels_ = false, frame_ends_ = false, ended_ = false;
};

}  // namespace sgs::test
