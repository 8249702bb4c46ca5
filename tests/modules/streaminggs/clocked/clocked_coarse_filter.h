// The coarse filter register by register: a loader that fills the slots of the input buffer, a
// dispatcher that hands a first half a cycle to the CFU whose turn it is, the pipelines of the
// CFUs, and the FIFO behind them, in which whatever is under test has its place already: that it
// will not pass nobody knows before. The numbers of a group are made when its first share is there,
// and no Gaussian of the group before the last is loaded or under test.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "tests/modules/clocked/clocked_fifo.h"
#include "tests/modules/clocked/clocked_group_numbers.h"
#include "tests/modules/clocked/clocked_port.h"

namespace sgs::test {

struct CoarseHardware {
  std::uint32_t cfus = 4;
  std::uint32_t test_cycles = 39;  // that the lanes of a CFU take for a test
  std::uint32_t depth_cycles = 131;
  std::uint32_t slice_gaussians = 8, input_slots = 5;
  std::uint32_t output_entries = 18;
  GroupNumbersHardware numbers = {};
  PortHardware port = {};
};

// Of a visit; behind it comes its mark.
struct CoarseShare {
  std::uint64_t mark = 0;  // what the mark is told by
  std::uint32_t group = 0;
  std::uint64_t address = 0, record_bytes = 0;  // of its first halves
  std::vector<std::uint64_t> what;              // [Gaussian]
  std::vector<bool> passes;                     // [Gaussian]
};

class ClockedCoarseFilter {
 public:
  ClockedFifo<std::uint64_t> out;

  explicit ClockedCoarseFilter(const CoarseHardware& hardware)
      : out(hardware.output_entries, 0),
        hw_(hardware),
        port_(hardware.port),
        numbers_(hardware.numbers),
        free_slots_(hardware.input_slots) {}

  // What leaves the pipelines in this cycle; ahead of the reader of `out`.
  void step_results() {
    for (InTest& test : in_test_) --test.left;
    while (!in_test_.empty() && in_test_.front().left == 0) {
      if (in_test_.front().passes) out.put(in_test_.front().what);
      in_test_.pop_front();
    }
  }
  // The rest of the cycle, behind that reader and ahead of the writer of `shares`. finished: of a
  // group, whether the news has come.
  template <class Finished>
  void step(ClockedFifo<CoarseShare>& shares, const Finished& finished) {
    port_.begin_cycle();
    numbers_.step([&](std::uint32_t group) { return group < 2 || !is_used(group - 2); });
    dispatch(finished);
    load(shares, finished);
    for (Slice& slice : slices_) slice.seen_in -= slice.seen_in > 0 ? 1 : 0;
    ++now_;
  }

 private:
  struct Slice {
    std::size_t first = 0, end = 0;  // in its share
    bool last = false;
    std::uint32_t numbers = 0;  // that its Gaussians are tested with
    ClockedTransfer read;
    std::uint32_t seen_in = 1;  // cycles
  };
  struct InTest {
    std::uint64_t left, what;
    bool passes;
    std::optional<std::uint32_t> numbers;  // not of a mark
  };

  bool has_place() const { return in_test_.size() + out.fill() < hw_.output_entries; }
  // Into a pipeline in this cycle; behind its depth stands a register ahead of the FIFO.
  void begin(std::uint64_t what, bool passes, std::optional<std::uint32_t> numbers = {}) {
    in_test_.push_back({hw_.depth_cycles + 1, what, passes, numbers});
  }
  bool is_used(std::uint32_t numbers) const {
    const auto of_slice = [&](const Slice& slice) {
      const bool begun = dispatching_ && &slice == &slices_.front();
      return slice.numbers == numbers && (begun ? at_ : slice.first) < slice.end;
    };
    return std::any_of(slices_.begin(), slices_.end(), of_slice) ||
           (asking_ && of_slice(*asking_)) ||
           std::any_of(in_test_.begin(), in_test_.end(),
                       [&](const InTest& test) { return test.numbers == numbers; });
  }

  template <class Finished>
  void dispatch(const Finished& finished) {
    free_slots_ += freed_;
    freed_ = 0;
    if (slices_.empty() || slices_.front().seen_in > 0) return;
    Slice& slice = slices_.front();
    if (!dispatching_) {
      dispatching_ = true;
      at_ = slice.first;
      if (at_ == slice.end) ++free_slots_;  // it was never filled
    }
    const CoarseShare& share = shares_.front();
    if (at_ < slice.end && !port_.answered(slice.read)) return;
    if (at_ < slice.end && !numbers_.stand(slice.numbers)) return;
    if (at_ < slice.end && finished(share.group)) {
      // What is left of a slice that has begun goes at once, another one in a cycle of its own.
      const bool at_once = at_ > slice.first || slice.last;
      (at_once ? free_slots_ : freed_) += 1;
      at_ = slice.end;
      if (!slice.last) {
        end_slice();
        if (at_once) dispatch(finished);
        return;
      }
    }
    if (at_ < slice.end) {
      const bool turn = now_ % hw_.test_cycles < hw_.cfus;
      if (!turn || !has_place()) return;
      begin(share.what[at_], share.passes[at_], slice.numbers);
      if (++at_ < slice.end) return;
      freed_ = 1;  // when this word has been read
      if (!slice.last) end_slice();
      return;
    }
    if (!has_place()) return;
    begin(share.mark, true);
    shares_.pop_front();
    end_slice();
  }
  void end_slice() {
    dispatching_ = false;
    slices_.pop_front();
  }

  template <class Finished>
  void load(ClockedFifo<CoarseShare>& shares, const Finished& finished) {
    if (asking_) {
      if (!port_.read(asking_->read)) return;
      slices_.push_back(*asking_);
      asking_.reset();
    }
    if (!loading_) {
      if (!shares.can_take()) return;
      shares_.push_back(shares.take());
      if (finished(shares_.back().group)) shares_.back().what.clear();
      loading_ = Slice{};
      if (const CoarseShare& share = shares_.back(); !share.what.empty()) {
        if (group_ != share.group) of_group_ = numbers_.ask();
        group_ = share.group;
        loading_->numbers = of_group_;
      }
    }
    if (free_slots_ == 0) return;
    --free_slots_;
    const CoarseShare& share = shares_.back();
    Slice slice = *loading_;
    slice.end = std::min<std::size_t>(slice.first + hw_.slice_gaussians, share.what.size());
    slice.last = slice.end == share.what.size();
    slice.read = {share.address + slice.first * share.record_bytes,
                  (slice.end - slice.first) * share.record_bytes};
    asking_ = slice;
    loading_->first = slice.end;
    if (slice.last) loading_.reset();
  }

  const CoarseHardware hw_;
  ClockedPort port_;
  ClockedGroupNumbers numbers_;
  std::optional<std::uint32_t> group_;  // whose share with Gaussians came last
  std::uint32_t of_group_ = 0;
  std::uint64_t now_ = 0;
  std::deque<CoarseShare> shares_;         // that are loaded or dispatched
  std::optional<Slice> loading_, asking_;  // the share that is cut; the slice that is asked for
  std::deque<Slice> slices_;               // asked for; the first goes to the CFUs
  bool dispatching_ = false;
  std::size_t at_ = 0;  // in the share, of what goes next
  std::uint32_t free_slots_, freed_ = 0;
  std::deque<InTest> in_test_;
};

}  // namespace sgs::test
