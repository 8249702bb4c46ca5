// The tests of a tile lister register by register: the lanes that test neighbours of a row of
// tiles; their pipeline, whose stages close up while the last holds a step until each of its
// touched tiles has had its turn in the lanes of the parts, for there is no queue between; and the
// pipeline of those, in which a tile has its place in the FIFO behind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "tests/modules/clocked/clocked_fifo.h"

namespace sgs::test {

struct TileTestHardware {
  std::uint32_t tile_interval = 1, tile_depth = 0;
  std::uint32_t part_interval = 1, part_depth = 0;
  std::uint32_t steps = 0;  // that the stages of the first pipeline hold
  std::uint32_t listed_entries = 0;
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
      : out(hardware.listed_entries, 0), hw_(hardware), slices_(slices) {}

  // What leaves the pipelines in this cycle; ahead of the reader of `out`.
  void step_results() {
    for (UnderWay<ClockedTile>& tile : parts_) --tile.left;
    while (!parts_.empty() && parts_.front().left == 0) {
      if (parts_.front().what.listed || parts_.front().what.ends_pass) {
        out.put(parts_.front().what);
      }
      parts_.pop_front();
    }
    for (UnderWay<TileStep>& step : steps_) --step.left;
    while (!steps_.empty() && steps_.front().left == 0) {
      touched_.push_back(steps_.front().what);
      steps_.pop_front();
    }
  }
  // in: from each CCU, slices in turn.
  void step(std::vector<ClockedFifo<ClockedGaussian>>& in) {
    test_parts();
    test_tiles(in);
    ++now_;
  }

 private:
  template <class T>
  struct UnderWay {
    std::uint32_t left;
    T what;
  };

  void test_parts() {
    if (touched_.empty()) return;
    if (touched_.front().empty()) {
      touched_.pop_front();
      return;
    }
    if (parts_.size() + out.fill() == hw_.listed_entries) return;
    const ClockedTile& tile = touched_.front()[of_step_];
    if (!tile.ends_pass && now_ % hw_.part_interval != 0) return;
    parts_.push_back({hw_.part_depth + 1, tile});
    if (++of_step_ < touched_.front().size()) return;
    touched_.pop_front();
    of_step_ = 0;
  }

  void test_tiles(std::vector<ClockedFifo<ClockedGaussian>>& in) {
    if (now_ < lanes_free_) return;
    if (!gaussian_) {
      if (!next_gaussian(in[turn_ % in.size()])) return;
      at_ = 0;
    }
    if (at_ == gaussian_->steps.size()) {
      lanes_free_ = now_ + 1;
      gaussian_.reset();
      return;
    }
    const bool turn = ends_pass_ || now_ % hw_.tile_interval == 0;
    if (!turn || steps_.size() + touched_.size() == hw_.steps) return;
    lanes_free_ = now_ + (ends_pass_ ? 1 : hw_.tile_interval);
    steps_.push_back({hw_.tile_depth, gaussian_->steps[at_]});
    if (++at_ == gaussian_->steps.size()) gaussian_.reset();
  }

  // Behind the last slice comes the end of the pass.
  bool next_gaussian(ClockedFifo<ClockedGaussian>& from) {
    ends_pass_ = turn_ == slices_;
    if (ends_pass_) {
      gaussian_ = ClockedGaussian{{{ClockedTile{0, false, false, true}}}};
      turn_ = 0;
      return true;
    }
    if (!from.can_take()) return false;
    gaussian_ = from.take();
    turn_ += gaussian_->last ? 1 : 0;
    return true;
  }

  const TileTestHardware hw_;
  const std::uint64_t slices_;
  std::uint64_t now_ = 0, turn_ = 0, lanes_free_ = 0;
  std::optional<ClockedGaussian> gaussian_;
  bool ends_pass_ = false;  // it stands for that
  std::size_t at_ = 0;      // in its steps
  std::deque<UnderWay<TileStep>> steps_;
  std::deque<TileStep> touched_;
  std::size_t of_step_ = 0;  // in the first of them
  std::deque<UnderWay<ClockedTile>> parts_;
};

}  // namespace sgs::test
