// The fine filter register by register, where second halves are not quantised: tests begin with
// records as they lie in their slots.
#pragma once

#include "tests/modules/streaminggs/clocked/clocked_fine_stages.h"

namespace sgs::test {

class ClockedFineFilter {
 public:
  explicit ClockedFineFilter(const FineHardware& hardware)
      : hw_(hardware), fetch_(hardware, hardware.read_cycles), ffu_(hardware) {}

  ClockedFifo<std::uint64_t>& out() { return ffu_.out; }
  void step_results() {
    ffu_.step_results([&](std::uint32_t numbers) { fetch_.leave(numbers); });
  }
  template <class Finished>
  void step(ClockedFifo<FineItem>& candidates, const Finished& finished) {
    fetch_.step_slots();
    begin_test(finished);
    fetch_.step(candidates, finished);
    ffu_.step();
  }

 private:
  // The oldest of those that are fetched.
  template <class Finished>
  void begin_test(const Finished& finished) {
    if (!fetch_.can_take() || !ffu_.has_place()) return;
    if (fetch_.front().is_mark) {
      ffu_.begin(fetch_.take(), hw_.read_cycles);
      return;
    }
    if (!fetch_.data_is_in() || !ffu_.is_free() || !fetch_.numbers_stand(fetch_.front())) return;
    const bool wanted = ffu_.wants(fetch_.front(), finished);
    if (wanted && !ffu_.has_turn()) return;
    fetch_.free_slot(hw_.read_cycles);
    const FineItem item = fetch_.take();
    if (wanted) {
      ffu_.begin(item, hw_.read_cycles);
    } else {
      ffu_.drop();
      fetch_.leave(item.numbers);
    }
  }

  const FineHardware hw_;
  ClockedFetch fetch_;
  ClockedFfu ffu_;
};

}  // namespace sgs::test
