// The rendering core register by register: an entry that wants a place for its record and one that
// asks for it, the lanes with the splat that they blend block by block, the pipeline behind them in
// which a block finishes when it is through, and the row of pixels on its way out.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "tests/modules/clocked/clocked_fifo.h"
#include "tests/modules/clocked/clocked_port.h"
#include "tests/modules/gscore/clocked/clocked_drain.h"

namespace sgs::test {

struct CoreHardware {
  std::uint32_t parts_across = 2, record_slots = 48, pixel_buffers = 2;
  std::uint32_t blend_interval = 1;  // of 16 pixels
  std::uint32_t conic_interval = 1;  // of a splat that is blended
  std::uint32_t depth = 0, state_loop = 0, drain_depth = 0;
  bool skip_finished = true;
  std::uint32_t feedback = 2;
  PortHardware port = {};  // each of two
};

enum class CoreMark { kEntry, kEndOfTile, kEndOfFrame };
struct CoreItem {
  CoreMark mark = CoreMark::kEntry;
  std::uint32_t tile = 0;
  std::uint32_t parts = 0;     // a bit each
  std::uint32_t finishes = 0;  // blocks of 16 px, a bit each
  ClockedTransfer record = {};
};
class ClockedRenderCore {
 public:
  ClockedRenderCore(const CoreHardware& hardware, std::vector<CoreTile> tiles)
      : hw_(hardware),
        tiles_(std::move(tiles)),
        seen_finished_(tiles_.size(), false),
        free_records_(hardware.record_slots),
        free_pixels_(hardware.pixel_buffers),
        fetched_(hardware.record_slots + 1),
        records_(hardware.port),
        drain_(hardware.port) {}

  bool done() const { return drain_.done(); }  // the end of the frame can be taken

  // Whether a transaction of pixels has left.
  bool step(ClockedFifo<CoreItem>& sorted) {
    records_.begin_cycle();
    leave_pipeline();
    const bool wrote = drain_.step(now_, tiles_);
    free_pixels_ += drain_.frees_pixels() ? 1 : 0;
    blend();
    fetch(sorted);
    fetched_.step();
    ++now_;
    return wrote;
  }

 private:
  static constexpr std::uint32_t kAcross = 4, kAllBlocks = 0xffff;
  struct InPipeline {
    std::uint64_t leaves;
    std::uint32_t tile, block;
    bool finishes;
  };
  struct News {
    std::uint64_t seen;
    std::uint32_t tile;
  };

  bool has(std::uint32_t bits, std::uint32_t at) const { return (bits >> at & 1U) != 0; }
  bool in_turn() const { return now_ % hw_.blend_interval == 0; }

  void leave_pipeline() {
    while (!blocks_.empty() && blocks_.front().leaves == now_) {
      const InPipeline& block = blocks_.front();
      if (block.finishes && in_tile_ && block.tile == tile_) finish(block.block);
      blocks_.pop_front();
    }
    while (!news_.empty() && news_.front().seen == now_) {
      seen_finished_[news_.front().tile] = true;
      news_.pop_front();
    }
  }
  void finish(std::uint32_t block) {
    finished_ |= 1U << block;
    if (finished_ == kAllBlocks) news_.push_back({now_ + hw_.feedback, tile_});
  }

  void fetch(ClockedFifo<CoreItem>& sorted) {
    if (asks_) {
      if (!records_.read(asks_->record) || !fetched_.has_room()) return;
      fetched_.put(*asks_);
      asks_.reset();
    }
    if (!wants_) {
      if (!sorted.can_take()) return;
      const CoreItem item = sorted.take();
      if (item.mark == CoreMark::kEntry && seen_finished_[item.tile]) return;
      wants_ = item;
    }
    if (wants_->mark == CoreMark::kEntry) {
      if (free_records_ == 0) return;
      --free_records_;
    }
    asks_ = wants_;
    wants_.reset();
  }

  void blend() {
    if (!to_blend_.empty()) {
      issue();
      return;
    }
    if (now_ < lanes_free_ || now_ < conic_free_) return;
    free_records_ += holds_record_ ? 1 : 0;
    holds_record_ = false;
    if (fetched_.can_take()) take(fetched_.front());
  }
  void take(const CoreItem item) {
    if (item.mark != CoreMark::kEndOfFrame && !in_tile_) {
      if (free_pixels_ == 0) return;
      --free_pixels_;
      in_tile_ = true;
      tile_ = item.tile;
      finished_ = tiles_[tile_].outside;
      loop_until_.assign(kAcross * kAcross, 0);
    }
    if (item.mark != CoreMark::kEntry) {
      const bool of_tile = item.mark == CoreMark::kEndOfTile;
      drain_.mark({now_ + hw_.depth + hw_.drain_depth, of_tile, item.tile});
      in_tile_ = false;
    } else {
      if (!records_.answered(item.record)) return;
      const bool drops = seen_finished_[tile_];
      if (!drops && !in_turn()) return;
      holds_record_ = true;
      splat_ = item;
      if (!drops) list_blocks();
    }
    fetched_.take();
    lanes_free_ = now_ + 1;
    if (to_blend_.empty()) return;
    conic_free_ = now_ + hw_.conic_interval;
    issue();
  }
  // Those that are not finished now, of the parts that have a bit.
  void list_blocks() {
    const std::uint32_t side = kAcross / hw_.parts_across;
    for (std::uint32_t part = 0; part < hw_.parts_across * hw_.parts_across; ++part) {
      if (!has(splat_.parts, part)) continue;
      const std::uint32_t first =
          part / hw_.parts_across * side * kAcross + part % hw_.parts_across * side;
      const std::uint32_t left_out = hw_.skip_finished ? finished_ : tiles_[tile_].outside;
      for (std::uint32_t b = 0; b < side * side; ++b) {
        const std::uint32_t block = first + b / side * kAcross + b % side;
        if (!has(left_out, block)) to_blend_.push_back(block);
      }
    }
  }
  void issue() {
    const std::uint32_t block = to_blend_.front();
    if (!in_turn() || now_ < loop_until_[block]) return;
    to_blend_.pop_front();
    loop_until_[block] = now_ + hw_.state_loop;
    lanes_free_ = now_ + hw_.blend_interval;
    blocks_.push_back({now_ + hw_.depth, tile_, block, has(splat_.finishes, block)});
  }

  const CoreHardware hw_;
  const std::vector<CoreTile> tiles_;
  std::uint64_t now_ = 0;
  std::vector<bool> seen_finished_;  // [tile]
  std::deque<News> news_;            // of finished tiles, on their way
  std::uint32_t free_records_, free_pixels_;

  std::optional<CoreItem> wants_, asks_;  // a place for its record; for that
  ClockedFifo<CoreItem> fetched_;
  ClockedPort records_;

  bool in_tile_ = false, holds_record_ = false;
  std::uint32_t tile_ = 0, finished_ = 0;  // blocks, a bit each
  std::vector<std::uint64_t> loop_until_;  // [block]
  CoreItem splat_;
  std::deque<std::uint32_t> to_blend_;  // blocks of the splat
  std::uint64_t lanes_free_ = 0, conic_free_ = 0;
  std::deque<InPipeline> blocks_;
  ClockedDrain drain_;
};

}  // namespace sgs::test
