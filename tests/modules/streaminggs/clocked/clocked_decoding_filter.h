// The fine filter register by register, where second halves are quantised: between its fetch and
// its FFU a stage reads the lines of a record's codebook entries, a line a cycle, into one of two
// decoded Gaussians; and the banks of the codebook buffer, each read by one of the stages a cycle:
// by the one whose record was begun first, of those of one cycle by the lower number.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tests/modules/streaminggs/clocked/clocked_fine_stages.h"

namespace sgs::test {

struct CodebookHardware {
  std::uint32_t banks = 8;
  std::uint32_t latency_cycles = 3;  // from the last line to the decoded Gaussian
  std::uint64_t load_transactions = 0;
  std::uint32_t memory_latency = 20;
};

class ClockedCodebooks {
 public:
  ClockedCodebooks(const CodebookHardware& hardware, std::uint32_t readers)
      : hw_(hardware), readers_(readers), unasked_(hardware.load_transactions) {}

  bool full() const { return hw_.load_transactions == 0 || (unasked_ == 0 && answered_in_ == 0); }
  // From this cycle on, until done().
  void read(std::uint32_t reader, std::vector<std::uint32_t> banks) {
    readers_[reader] = {std::move(banks), 0, now_};
  }
  bool done(std::uint32_t reader) const {
    return readers_[reader].next == readers_[reader].banks.size();
  }

  void step() {
    std::vector<Reader*> by_age;
    for (Reader& reader : readers_) by_age.push_back(&reader);
    std::stable_sort(by_age.begin(), by_age.end(),
                     [](const Reader* a, const Reader* b) { return a->began < b->began; });
    std::vector<bool> taken(hw_.banks, false);
    for (Reader* reader : by_age) {
      if (reader->next == reader->banks.size() || taken[reader->banks[reader->next]]) continue;
      taken[reader->banks[reader->next++]] = true;
    }
    load();
    ++now_;
  }

 private:
  struct Reader {
    std::vector<std::uint32_t> banks;  // of a record's lines
    std::size_t next = 0;
    std::uint64_t began = 0;
  };

  // A transaction a cycle leaves; the last that comes back fills the buffer.
  void load() {
    if (unasked_ > 0) {
      --unasked_;
      answered_in_ = hw_.memory_latency;
    }
    answered_in_ -= answered_in_ > 0 ? 1 : 0;
  }

  const CodebookHardware hw_;
  std::vector<Reader> readers_;
  std::uint64_t unasked_, answered_in_ = 0, now_ = 0;
};

class ClockedDecodingFilter {
 public:
  ClockedDecodingFilter(const FineHardware& hardware, const CodebookHardware& codebooks,
                        std::uint32_t reader)
      : reader_(reader),
        fetch_(hardware),
        ffu_(hardware),
        decoded_(kDecodedEntries, codebooks.latency_cycles + 1) {}

  ClockedFifo<std::uint64_t>& out() { return ffu_.out; }
  void step_results() { ffu_.step_results(); }
  // Before the codebooks' step().
  void begin(ClockedCodebooks& codebooks) {
    fetch_.step_slots();
    begin_test();
    begin_decoding(codebooks);
  }
  // Behind it.
  void step(const ClockedCodebooks& codebooks, ClockedFifo<FineItem>& candidates) {
    if (decoding_ && codebooks.done(reader_)) {
      decoding_ = false;
      fetch_.free_slot(1);
      decoded_.put(fetch_.take());
    }
    fetch_.step(candidates);
    decoded_.step();
    ffu_.step();
  }

 private:
  static constexpr std::size_t kDecodedEntries = 2;

  void begin_test() {
    if (!decoded_.can_take() || !ffu_.has_place()) return;
    if (!decoded_.front().is_mark && !ffu_.has_turn()) return;
    ffu_.begin(decoded_.take(), 1);
  }
  // Lines go into the entry of the decoded Gaussian, which must be free when the first is read.
  void begin_decoding(ClockedCodebooks& codebooks) {
    if (decoding_ || !fetch_.can_take() || !decoded_.has_room()) return;
    if (fetch_.front().is_mark) {
      decoded_.put(fetch_.take());
    } else if (fetch_.data_is_in() && codebooks.full()) {
      codebooks.read(reader_, fetch_.front().banks);
      decoding_ = true;
    }
  }

  const std::uint32_t reader_;
  ClockedFetch fetch_;
  ClockedFfu ffu_;
  ClockedFifo<FineItem> decoded_;
  bool decoding_ = false;
};

}  // namespace sgs::test
