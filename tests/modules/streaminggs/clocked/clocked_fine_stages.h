// The stages of a fine filter register by register: a fetch that gives each candidate a slot, with
// the FIFO of those that are fetched, and the lanes of the FFU with a test in their turn, its
// pipeline, and the FIFO behind it, in which whatever is under test has its place.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "tests/modules/clocked/clocked_fifo.h"
#include "tests/modules/clocked/clocked_group_numbers.h"
#include "tests/modules/clocked/clocked_port.h"

namespace sgs::test {

struct FineHardware {
  std::uint32_t slots = 8;
  std::uint32_t test_cycles = 24;  // that the lanes take for a test
  std::uint32_t depth_cycles = 198;
  std::uint32_t read_cycles = 7;  // of a record, out of its slot
  std::uint32_t output_entries = 20;
  bool reports_rejects = false;  // they go on, as kRejectedItem
  PortHardware port = {};
  std::uint32_t ffus = 1;  // that take tests in turn
  GroupNumbersHardware numbers = {};
};
constexpr std::uint64_t kRejectedItem = 1U << 21U;

struct FineItem {
  std::uint64_t what = 0;
  std::uint32_t group = 0;
  bool is_mark = false;
  bool passes = true;
  ClockedTransfer read = {};              // that fetches it; of a mark nothing
  std::vector<std::uint32_t> banks = {};  // of the codebook buffer, of the lines of its entries
  std::uint32_t numbers = 0;              // that it is tested with
};

class ClockedFetch {
 public:
  // slots_in: cycles until the slots are free, from the first cycle on.
  ClockedFetch(const FineHardware& hardware, std::uint32_t slots_in)
      : hw_(hardware),
        port_(hardware.port),
        numbers_(hardware.numbers),
        freed_(hardware.slots, slots_in) {}

  bool can_take() const { return !fetched_.empty() && fetched_.front().seen_in == 0; }
  const FineItem& front() const { return fetched_.front().item; }
  bool data_is_in() const { return port_.answered(front().read); }
  FineItem take() {
    FineItem item = std::move(fetched_.front().item);
    fetched_.pop_front();
    return item;
  }
  bool numbers_stand(const FineItem& item) const { return numbers_.stand(item.numbers); }
  // An item that was taken needs its numbers no more.
  void leave(std::uint32_t numbers) { --users_[numbers]; }
  void free_slot(std::uint32_t in_cycles) { freed_.push_back(in_cycles); }

  // In every cycle step_slots() comes before those who take and free, step() behind them.
  void step_slots() {
    port_.begin_cycle();
    numbers_.step([&](std::uint32_t group) { return group < 2 || users_[group - 2] == 0; });
    while (!freed_.empty() && freed_.front() == 0) {
      ++free_slots_;
      freed_.pop_front();
    }
  }
  // finished: of a group, whether the news has come.
  template <class Finished>
  void step(ClockedFifo<FineItem>& candidates, const Finished& finished) {
    fetch(candidates, finished);
    for (Fetched& entry : fetched_) entry.seen_in -= entry.seen_in > 0 ? 1 : 0;
    for (std::uint32_t& left : freed_) --left;
  }

 private:
  struct Fetched {
    FineItem item;
    std::uint32_t seen_in = 1;
  };

  template <class Finished>
  void fetch(ClockedFifo<FineItem>& candidates, const Finished& finished) {
    if (asking_) {
      if (!port_.read(asking_->read) || fetched_.size() == hw_.slots + 1) return;
      fetched_.push_back({*asking_});
      asking_.reset();
    }
    if (!fetching_) {
      if (!candidates.can_take()) return;
      fetching_ = candidates.take();
      if (!fetching_->is_mark && finished(fetching_->group)) drop();
      if (!fetching_) return;
      if (!fetching_->is_mark) give_numbers();
    }
    if (!fetching_->is_mark) {
      if (free_slots_ == 0) return;
      --free_slots_;
    }
    asking_ = fetching_;
    fetching_.reset();
  }
  void give_numbers() {
    if (group_ != fetching_->group) of_group_ = numbers_.ask();
    group_ = fetching_->group;
    fetching_->numbers = of_group_;
    ++users_[of_group_];
  }
  // A rejected one keeps its place in the order, as a mark does.
  void drop() {
    if (hw_.reports_rejects) {
      fetching_ = FineItem{kRejectedItem, fetching_->group, true};
    } else {
      fetching_.reset();
    }
  }

  const FineHardware hw_;
  ClockedPort port_;
  ClockedGroupNumbers numbers_;
  std::optional<std::uint32_t> group_;  // of the last item that was fetched
  std::uint32_t of_group_ = 0;
  std::map<std::uint32_t, std::uint32_t> users_;  // [numbers] items that will be tested, or are
  std::optional<FineItem> fetching_, asking_;     // wants a slot; its transactions leave
  std::deque<Fetched> fetched_;
  std::uint32_t free_slots_ = 0;
  std::deque<std::uint32_t> freed_;  // cycles until a slot is free
};

class ClockedFfu {
 public:
  ClockedFifo<std::uint64_t> out;

  explicit ClockedFfu(const FineHardware& hardware)
      : out(hardware.output_entries, 0), hw_(hardware) {}

  // As ClockedCoarseFilter's. leave(numbers): a test is done with them.
  template <class Leave>
  void step_results(const Leave& leave) {
    for (InTest& test : in_test_) --test.left;
    while (!in_test_.empty() && in_test_.front().left == 0) {
      const InTest& test = in_test_.front();
      if (test.passes || hw_.reports_rejects) out.put(test.passes ? test.what : kRejectedItem);
      if (test.numbers) leave(*test.numbers);
      in_test_.pop_front();
    }
  }
  bool has_place() const { return in_test_.size() + out.fill() < hw_.output_entries; }
  bool is_free() const { return lanes_free_in_ == 0; }
  // Of one that could begin: whether its group wants it, which is asked once.
  template <class Finished>
  bool wants(const FineItem& item, const Finished& finished) {
    if (!wants_) wants_ = !finished(item.group);
    return *wants_;
  }
  // As many turns in the cycles of a test as there are FFUs, evenly.
  bool has_turn() const { return now_ * hw_.ffus % hw_.test_cycles < hw_.ffus; }
  // A mark passes beside what the lanes do. read_cycles: that an item is being read.
  void begin(const FineItem& item, std::uint32_t read_cycles) {
    if (!item.is_mark) {
      const std::uint32_t lanes = hw_.ffus > 1 ? 1 : hw_.test_cycles;
      lanes_free_in_ = lanes < read_cycles ? read_cycles : lanes;
    }
    in_test_.push_back({hw_.depth_cycles + 1, item.what, item.passes, {}});
    if (!item.is_mark) in_test_.back().numbers = item.numbers;
    if (!item.is_mark) wants_.reset();
  }
  // A cycle of the lanes' time.
  void drop() {
    lanes_free_in_ = 1;
    if (hw_.reports_rejects) in_test_.push_back({hw_.depth_cycles + 1, 0, false, {}});
    wants_.reset();
  }
  void step() {
    lanes_free_in_ -= lanes_free_in_ > 0 ? 1 : 0;
    ++now_;
  }

 private:
  struct InTest {
    std::uint64_t left, what;
    bool passes;
    std::optional<std::uint32_t> numbers;  // not of what is no test
  };

  const FineHardware hw_;
  std::uint64_t now_ = 0;
  std::uint32_t lanes_free_in_ = 0;
  std::optional<bool> wants_;
  std::deque<InTest> in_test_;
};

}  // namespace sgs::test
