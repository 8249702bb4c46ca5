// The tests of a tile lister register by register: lanes that test neighbours of a row of tiles,
// and lanes for the parts of each that is touched. The two are in step: the next neighbours begin
// when each touched tile has had its turn. Their stages are the FIFO's behind them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "tests/modules/clocked/clocked_fifo.h"

namespace sgs::test {

struct TileTestHardware {
  std::uint32_t tile_interval = 1, part_interval = 1;
  std::uint32_t depth = 0;           // of both
  std::uint32_t listed_entries = 0;  // with those in the stages
};

// A tile whose parts are tested, or the end of a pass.
struct ClockedTile {
  std::uint32_t tile = 0;
  bool listed = false;  // a part of it is touched
  bool first = false;   // listed one of its Gaussian
  bool ends_pass = false;
};
using TileStep = std::vector<ClockedTile>;  // touched neighbours
struct ClockedGaussian {
  std::vector<TileStep> steps;  // none: it, or what stands for it, takes a cycle
  bool last = false;            // of its slice
};

class ClockedTileTests {
 public:
  ClockedFifo<ClockedTile> out;

  // slices: of a pass.
  ClockedTileTests(const TileTestHardware& hardware, std::uint64_t slices)
      : out(hardware.listed_entries, hardware.depth), hw_(hardware), slices_(slices) {}

  // Behind the reader of `out`. in: from each CCU, slices in turn.
  void step(std::vector<ClockedFifo<ClockedGaussian>>& in) {
    while (advance(in)) {
    }
    out.step();
    ++now_;
  }

 private:
  // Whether there may be more to do in this cycle.
  bool advance(std::vector<ClockedFifo<ClockedGaussian>>& in) {
    if (now_ < free_) return false;
    if (tested_) {
      if (!out.has_room()) return false;
      out.put(*tested_);
      tested_.reset();
    }
    if (at_ < touched_.size()) {
      test_part();
    } else if (now_ < tiles_free_) {
      return false;
    } else if (step_ < gaussian_.steps.size()) {
      test_tiles();
    } else {
      return take_gaussian(in);
    }
    return true;
  }

  void test_part() {
    if (!turn(hw_.part_interval)) return;
    free_ = now_ + hw_.part_interval;
    if (touched_[at_].listed) tested_ = touched_[at_];
    ++at_;
  }
  void test_tiles() {
    if (!turn(hw_.tile_interval)) return;
    tiles_free_ = now_ + hw_.tile_interval;
    touched_ = gaussian_.steps[step_++];
    at_ = 0;
  }
  // If not, it is waited for.
  bool turn(std::uint32_t interval) {
    if (now_ % interval != 0) free_ = now_ + 1;
    return now_ % interval == 0;
  }

  // Behind the last slice comes the end of the pass.
  bool take_gaussian(std::vector<ClockedFifo<ClockedGaussian>>& in) {
    step_ = 0;
    if (turn_ == slices_) {
      turn_ = 0;
      gaussian_ = {};
      tested_ = ClockedTile{0, false, false, true};
    } else {
      ClockedFifo<ClockedGaussian>& from = in[turn_ % in.size()];
      gaussian_ = {};
      if (!from.can_take()) return false;
      gaussian_ = from.take();
      turn_ += gaussian_.last ? 1 : 0;
    }
    if (gaussian_.steps.empty()) free_ = now_ + 1;
    return true;
  }

  const TileTestHardware hw_;
  const std::uint64_t slices_;
  std::uint64_t now_ = 0, turn_ = 0;
  std::uint64_t free_ = 0, tiles_free_ = 0;  // from this cycle on: all, lanes for tiles
  ClockedGaussian gaussian_;
  std::size_t step_ = 0;  // next of it
  TileStep touched_;
  std::size_t at_ = 0;                 // next of these
  std::optional<ClockedTile> tested_;  // waits for room
};

}  // namespace sgs::test
