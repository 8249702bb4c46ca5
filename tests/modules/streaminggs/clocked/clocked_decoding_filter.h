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
  ClockedTransfer load;
  PortHardware port = {};
};

class ClockedCodebooks {
 public:
  ClockedCodebooks(const CodebookHardware& hardware, std::uint32_t readers)
      : hw_(hardware), port_(hardware.port), readers_(readers), load_(hardware.load) {}

  bool full() const { return port_.answered(load_); }
  // From this cycle on, until done().
  void read(std::uint32_t reader, std::vector<std::uint32_t> banks) {
    readers_[reader] = {std::move(banks), 0, now_};
  }
  bool done(std::uint32_t reader) const {
    return readers_[reader].next == readers_[reader].banks.size();
  }

  void begin_cycle() { port_.begin_cycle(); }
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
    port_.read(load_);
    ++now_;
  }

 private:
  struct Reader {
    std::vector<std::uint32_t> banks;  // of a record's lines
    std::size_t next = 0;
    std::uint64_t began = 0;
  };

  const CodebookHardware hw_;
  ClockedPort port_;
  std::vector<Reader> readers_;
  ClockedTransfer load_;
  std::uint64_t now_ = 0;
};

class ClockedDecodingFilter {
 public:
  ClockedDecodingFilter(const FineHardware& hardware, const CodebookHardware& codebooks,
                        std::uint32_t reader)
      : reader_(reader),
        fetch_(hardware, 0),
        ffu_(hardware),
        decoded_(kDecodedEntries, codebooks.latency_cycles) {}

  ClockedFifo<std::uint64_t>& out() { return ffu_.out; }
  void step_results() {
    ffu_.step_results([&](std::uint32_t numbers) { fetch_.leave(numbers); });
  }
  // Before the codebooks' step(). finished: of a group, whether the news has come.
  template <class Finished>
  void begin(ClockedCodebooks& codebooks, const Finished& finished) {
    if (decoding_ && codebooks.done(reader_)) end_decoding();
    fetch_.step_slots();
    begin_test(finished);
    begin_decoding(codebooks, finished);
  }
  // Behind it.
  template <class Finished>
  void step(ClockedFifo<FineItem>& candidates, const Finished& finished) {
    fetch_.step(candidates, finished);
    decoded_.step();
    ffu_.step();
  }

 private:
  static constexpr std::size_t kDecodedEntries = 2;

  template <class Finished>
  void begin_test(const Finished& finished) {
    if (!decoded_.can_take() || !ffu_.has_place()) return;
    if (!decoded_.front().is_mark) {
      if (!ffu_.is_free() || !fetch_.numbers_stand(decoded_.front())) return;
      if (!ffu_.wants(decoded_.front(), finished)) {
        fetch_.leave(decoded_.take().numbers);
        ffu_.drop();
        return;
      }
      if (!ffu_.has_turn()) return;
    }
    ffu_.begin(decoded_.take(), 1);
  }
  // Lines go into the entry of the decoded Gaussian, which must be free when the first is read.
  template <class Finished>
  void begin_decoding(ClockedCodebooks& codebooks, const Finished& finished) {
    if (decoding_ || !fetch_.can_take() || !decoded_.has_room()) return;
    const FineItem& item = fetch_.front();
    if (!item.is_mark && !fetch_.data_is_in()) return;
    const bool reads = !item.is_mark && !finished(item.group);
    if (reads && !codebooks.full()) return;
    codebooks.read(reader_, reads ? item.banks : std::vector<std::uint32_t>());
    decoding_ = true;
  }
  void end_decoding() {
    decoding_ = false;
    if (!fetch_.front().is_mark) fetch_.free_slot(0);
    decoded_.put(fetch_.take());
  }

  const std::uint32_t reader_;
  ClockedFetch fetch_;
  ClockedFfu ffu_;
  ClockedFifo<FineItem> decoded_;
  bool decoding_ = false;
};

}  // namespace sgs::test
