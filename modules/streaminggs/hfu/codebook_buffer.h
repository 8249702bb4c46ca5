// Codebook buffer: the on-chip memory that quantised second halves are decoded from.
// Timing: filled once from DRAM; then every HFU reads one line a cycle. Two that want a line of the
// same bank in the same cycle get it one after the other. The one that began its record earlier
// goes first, of those that began in one cycle the lower number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <systemc>
#include <vector>

#include "modules/streaminggs/hfu/bank_reservations.h"
#include "modules/streaminggs/hfu/codebook_config.h"
#include "modules/streaminggs/hfu/codebook_if.h"
#include "modules/streaminggs/unit_context.h"
#include "tlm/data_sheet.h"
#include "tlm/instant_end.h"
#include "tlm/memory_access.h"

namespace sgs {

class CodebookBuffer : public sc_core::sc_module, public CodebookIf, private InstantEnd::Arbiter {
 public:
  MemoryPort memory;

  SC_HAS_PROCESS(CodebookBuffer);
  // The job's second halves are quantised. readers: how many fine filters there are.
  CodebookBuffer(const sc_core::sc_module_name& name, const CodebookConfig& config,
                 const UnitContext& context, InstantEnd& instant_end, std::uint32_t readers);

  void read_entries(std::uint32_t reader, const CodebookIndices& indices,
                    Activity& activity) override;
  const std::byte* bytes() const override { return bytes_.data(); }

  struct Counters : CounterSet {
    Counter bytes_loaded{*this, "bytes_loaded", "bytes", "of codebooks read from DRAM"};
    Counter loaded_at_cycle{*this, "loaded_at_cycle", "cycle", "in which the buffer was full"};
    Counter records_decoded{*this, "records_decoded", "second halves", "whose entries were read"};
    Counter lines_read{*this, "lines_read", "lines", "of the banks"};
    Counter bank_conflict_cycles{*this, "bank_conflict_cycles", "cycles",
                                 "that lines waited for a bank being read"};
    std::uint64_t lines_of[kCodebookCount] = {};  // [codebook] share of lines_read
  };
  const Counters& counters() const { return counters_; }
  // Codebooks of one scene.
  static SramUses sram_uses(const CodebookConfig& config, const SecondHalfFormat& format);
  void publish(DataSheet& sheet);

 private:
  // A record that a reader wants the entries of.
  struct Request {
    const CodebookIndices* indices = nullptr;  // null: none
    std::uint64_t done_cycle = 0;              // once decided: when the last line is there
    sc_core::sc_event decided;
  };

  void start_of_simulation() override;
  void run_load();  // thread: the codebooks into the buffer
  void decide() override;
  void publish_readers(DataSheet& sheet, const SramUses& uses) const;
  std::uint64_t take_record(const CodebookIndices& indices, std::uint64_t cycle);
  std::uint64_t take_lines(std::size_t codebook, const EntryRange& entry, std::uint64_t cycle);

  const CodebookConfig config_;
  const BuiltFor built_for_;
  const StreamingJob& job_;
  InstantEnd& instant_end_;
  Activity load_;
  std::vector<std::byte> bytes_;
  BankReservations banks_;
  std::vector<Request> requests_;  // [reader]
  bool full_ = false;
  sc_core::sc_event filled_;
  Counters counters_;
};

}  // namespace sgs
