// Codebook buffer: the on-chip memory that quantised second halves are decoded from.
// Timing: filled once from DRAM; then every HFU reads one line a cycle, and two that want a line of
// the same bank in the same cycle get it one after the other, whoever asked first before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <systemc>
#include <vector>

#include "algorithm/memory/second_half.h"
#include "modules/frame_job.h"
#include "modules/hfu/codebook_config.h"
#include "tlm/memory_access.h"

namespace sgs {

struct CodebookCounters {
  std::uint64_t bytes_loaded = 0;
  std::uint64_t loaded_at_cycle = 0;  // the buffer was full
  std::uint64_t records = 0;          // decoded
  std::uint64_t lines = 0;            // read
  std::uint64_t conflict_cycles = 0;  // a line waited because its bank was being read
};

class CodebookBuffer : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(CodebookBuffer);
  // The job's second halves are quantised.
  CodebookBuffer(const sc_core::sc_module_name& name, const CodebookConfig& config,
                 const ClockDomain& clock, const FrameJob& job, MemoryPort& port);

  // What an earlier frame left: codebook_bytes() bytes. Before the simulation starts.
  void preload(const std::byte* bytes);

  // Reads the entries of one record for one HFU: lets the time pass until the last line is there,
  // before all else until the buffer is full.
  void read_entries(const CodebookIndices& indices, Activity& reader);

  // The contents; valid once read_entries() has returned.
  const std::byte* bytes() const { return bytes_.data(); }

  std::uint32_t latency_cycles() const { return config_.latency_cycles; }
  const CodebookCounters& counters() const { return counters_; }
  Activity& load_activity() { return load_activity_; }
  void trace(sc_core::sc_trace_file* file) const;

 private:
  // Cycles to come in which each bank is taken.
  class Reservations {
   public:
    // Takes the bank in `cycle` or in the first later one in which it is free; returns which.
    std::uint64_t take(std::uint32_t bank, std::uint64_t cycle);

   private:
    struct Slot {
      std::uint64_t cycle = 0;  // that `taken` speaks of, plus 1
      std::uint64_t taken = 0;  // a bit for each bank
    };
    static constexpr std::size_t kWindowCycles = 1U << 14;  // no reader looks so far ahead
    std::vector<Slot> slots_ = std::vector<Slot>(kWindowCycles);
  };

  void load();  // thread: the codebooks into the buffer
  std::uint64_t take_lines(const EntryRange& entry, std::uint64_t cycle);

  const CodebookConfig config_;
  const FrameJob& job_;
  MemoryPort& port_;
  Activity load_activity_;
  std::vector<std::byte> bytes_;
  Reservations reservations_;
  bool full_ = false;
  sc_core::sc_event filled_;
  CodebookCounters counters_;
};

}  // namespace sgs
