// A culling and conversion unit register by register: slices on their way, the lanes that cull and
// their pipeline, the candidates of a slice that are gathered before neighbours' second halves are
// asked for, and the lanes that convert. What is in a pipeline has its place in the FIFO behind it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "algorithm/memory/scene_layout.h"
#include "tests/modules/clocked/clocked_fifo.h"
#include "tests/modules/clocked/clocked_port.h"

namespace sgs::test {

struct CcuHardware {
  std::uint32_t slice_gaussians = 8, input_slots = 4, second_half_slots = 16;
  std::uint32_t cull_interval = 3, cull_depth = 0, cull_entries = 0;
  std::uint32_t convert_interval = 0, convert_depth = 0, convert_entries = 0;
  std::uint32_t read_cycles = 0;  // of a second half, out of its slot
  PortHardware port = {};         // each of two
};

struct CcuItem {
  std::uint64_t what = 0;
  bool passes = false;  // culling
  bool goes_on = false;
  bool last = false;       // of its slice
  std::uint32_t slot = 0;  // where it is stored
};

class ClockedCcu {
 public:
  ClockedFifo<std::uint64_t> out;

  // first, second: halves of the items, in memory.
  ClockedCcu(const CcuHardware& hardware, std::vector<CcuItem> items, const RecordArray& first,
             const RecordArray& second)
      : out(hardware.convert_entries, 0),
        hw_(hardware),
        items_(std::move(items)),
        first_halves_(first),
        second_halves_(second),
        free_input_(hardware.input_slots),
        free_second_(hardware.second_half_slots),
        first_port_(hardware.port),
        second_port_(hardware.port),
        slices_(hardware.input_slots),
        culled_(hardware.cull_entries, 0),
        fetched_(hardware.second_half_slots + 1) {}

  // What leaves the pipelines in this cycle; ahead of the reader of `out`.
  void step_results() {
    leave(converts_, out);
    leave(culls_, culled_);
  }
  // The rest of the cycle. passes: a number for each pass over the scene.
  void step(ClockedFifo<std::uint64_t>& passes) {
    first_port_.begin_cycle();
    second_port_.begin_cycle();
    for (std::uint32_t& left : freed_second_) --left;
    while (!freed_second_.empty() && freed_second_.front() == 0) {
      freed_second_.pop_front();
      ++free_second_;
    }
    convert();
    if (fetch_waits_ > 0) --fetch_waits_;
    while (fetch_waits_ == 0 && fetch()) {
    }
    cull();
    load(passes);
    slices_.step();
    fetched_.step();
    ++now_;
  }

 private:
  struct Slice {
    std::size_t first = 0, end = 0;
    ClockedTransfer read;
  };
  template <class T>
  struct InPipeline {
    std::uint32_t left;
    T what;
    bool passes;
  };
  struct Fetched {
    CcuItem item;
    ClockedTransfer read;
  };
  static ClockedTransfer read_of(const RecordArray& records, std::size_t first, std::size_t count) {
    return {records.address(first), count * records.record_bytes};
  }
  enum class Fetch { kGather, kRun, kSend, kPush };

  template <class T>
  static void leave(std::deque<InPipeline<T>>& pipeline, ClockedFifo<T>& to) {
    for (InPipeline<T>& one : pipeline) --one.left;
    while (!pipeline.empty() && pipeline.front().left == 0) {
      if (pipeline.front().passes) to.put(pipeline.front().what);
      pipeline.pop_front();
    }
  }

  // A slice wants a slot, then asks.
  void load(ClockedFifo<std::uint64_t>& passes) {
    if (asks_) {
      if (!first_port_.read(asks_->read)) return;
      slices_.put(*asks_);
      asks_.reset();
    }
    if (next_ == items_.size()) {
      if (!passes.can_take()) return;
      passes.take();
      next_ = 0;
    }
    if (free_input_ == 0) return;
    --free_input_;
    const std::size_t end = std::min<std::size_t>(next_ + hw_.slice_gaussians, items_.size());
    asks_ = Slice{next_, end, read_of(first_halves_, next_, end - next_)};
    next_ = end;
  }

  void cull() {
    free_input_ += freed_input_;
    freed_input_ = 0;
    if (!slices_.can_take() || !first_port_.answered(slices_.front().read)) return;
    const Slice& slice = slices_.front();
    const bool place = culls_.size() + culled_.fill() < hw_.cull_entries;
    if (now_ % hw_.cull_interval != 0 || !place) return;
    const CcuItem& item = items_[slice.first + at_];
    culls_.push_back({hw_.cull_depth + 1, item, item.passes || item.last});
    if (slice.first + ++at_ < slice.end) return;
    at_ = 0;
    slices_.take();
    freed_input_ = 1;  // when this word has been read
  }

  bool fetch_waits() {
    fetch_waits_ = 1;
    return false;
  }
  // One step of the control; true: the next follows in the same cycle.
  bool fetch() {
    switch (fetch_) {
      case Fetch::kGather:
        if (!culled_.can_take()) return false;
        gathered_.push_back(culled_.take());
        if (gathered_.back().last) fetch_ = Fetch::kRun;
        return fetch_waits();
      case Fetch::kRun:
        return begin_run();
      case Fetch::kSend:
        if (!second_port_.read(read_)) return false;
        fetch_ = Fetch::kPush;
        return true;
      case Fetch::kPush:
        if (!fetched_.has_room()) return false;
        fetched_.put({gathered_.front(), read_});
        gathered_.pop_front();
        if (--run_ == 0) fetch_ = Fetch::kRun;
        return fetch_waits();
    }
    return false;
  }
  // Neighbours go together where their slots are neighbours too.
  bool begin_run() {
    if (gathered_.empty()) {
      fetch_ = Fetch::kGather;
      return true;
    }
    run_ = 1;
    if (!gathered_.front().passes) {
      fetch_ = Fetch::kPush;
      return true;
    }
    while (run_ < gathered_.size() && gathered_[run_].passes &&
           gathered_[run_].slot == gathered_[0].slot + run_ &&
           next_second_ + run_ < hw_.second_half_slots) {
      ++run_;
    }
    if (free_second_ < run_) return false;
    free_second_ -= run_;
    next_second_ = (next_second_ + run_) % hw_.second_half_slots;
    read_ = read_of(second_halves_, gathered_[0].slot, run_);
    fetch_ = Fetch::kSend;
    return true;
  }

  // The end of a slice that has no Gaussian passes beside the lanes.
  void convert() {
    if (!fetched_.can_take()) return;
    const CcuItem item = fetched_.front().item;
    if (converts_.size() + out.fill() == hw_.convert_entries) return;
    if (item.passes) {
      const bool turn = now_ % hw_.convert_interval == 0 && now_ >= convert_free_;
      if (!turn || !second_port_.answered(fetched_.front().read)) return;
      convert_free_ = now_ + std::max(hw_.convert_interval, hw_.read_cycles);
      freed_second_.push_back(hw_.read_cycles);
    }
    converts_.push_back({hw_.convert_depth + 1, item.what, item.goes_on || item.last});
    fetched_.take();
  }

  const CcuHardware hw_;
  const std::vector<CcuItem> items_;
  const RecordArray first_halves_, second_halves_;
  std::uint64_t now_ = 0, convert_free_ = 0;
  std::size_t next_ = items_.size();  // of the pass
  std::uint32_t free_input_, freed_input_ = 0, free_second_;
  ClockedPort first_port_, second_port_;
  std::optional<Slice> asks_;
  ClockedFifo<Slice> slices_;
  std::size_t at_ = 0;  // in the slice
  std::deque<InPipeline<CcuItem>> culls_;
  ClockedFifo<CcuItem> culled_;

  Fetch fetch_ = Fetch::kGather;
  std::uint32_t fetch_waits_ = 0, run_ = 0, next_second_ = 0;
  ClockedTransfer read_;
  std::deque<CcuItem> gathered_;
  ClockedFifo<Fetched> fetched_;
  std::deque<std::uint32_t> freed_second_;  // cycles until a slot is free
  std::deque<InPipeline<std::uint64_t>> converts_;
};

}  // namespace sgs::test
