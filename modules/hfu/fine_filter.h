// The fine half of an HFU: fetches the second half of each candidate, decodes it and puts it
// through the FFU: projection, exact test against the group, colour. Timing: one candidate every
// ffu_interval_cycles, second_half_slots fetches ahead; quantised second halves pass a stage before
// the FFU that reads the codebook buffer. Function: algorithm/splat/make_splat.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <systemc>
#include <vector>

#include "algorithm/memory/records.h"
#include "modules/frame_job.h"
#include "modules/hfu/codebook_buffer.h"
#include "modules/hfu/hfu_config.h"
#include "modules/messages.h"
#include "modules/saturation_board.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs {

struct FineCounters {
  std::uint64_t second_halves = 0;  // fetched
  std::uint64_t tests = 0;
  std::uint64_t splats = 0;             // passed on
  std::uint64_t dropped_saturated = 0;  // candidates: the group was finished
};

// What becomes of a candidate without a splat: nothing, or a token that says so, where the order of
// the tokens tells which filter the next splat comes from.
enum class Rejects { kDropped, kReported };

class FineFilter : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(FineFilter);
  // unit: prefix of the activities' names. codebooks: null where second halves are not quantised.
  // splats: visit v goes to v modulo their number.
  FineFilter(const sc_core::sc_module_name& name, const std::string& unit, const HfuConfig& config,
             const ClockDomain& clock, const FrameJob& job, const SaturationBoard& board,
             MemoryPort& port, CodebookBuffer* codebooks, TimedFifo<FineCandidate>& candidates,
             std::vector<TimedFifo<SplatToken>*> splats, Rejects rejects);

  const FineCounters& counters() const { return counters_; }
  // Fetch, decoding (where there is something to decode), fine filter.
  std::vector<Activity*> activities();
  const Activity* decode_activity() const { return codebooks_ ? &decode_activity_ : nullptr; }
  const Activity& fine_activity() const { return fine_activity_; }
  void trace(sc_core::sc_trace_file* file) const;

 private:
  // A candidate whose second half has been read; with a mark there is none.
  struct Decoded {
    FineCandidate candidate;
    DecodedGaussian second;
  };

  void fetch();   // thread: second halves of the candidates
  void decode();  // thread: codebook entries of quantised ones
  void fine();    // thread: FFU
  Decoded take_fetched(Activity& activity);
  void filter(const Decoded& decoded);
  void reject(const FineCandidate& candidate);
  void drop_saturated(const FineCandidate& candidate);

  const HfuConfig config_;
  const FrameJob& job_;
  const SaturationBoard& board_;
  MemoryPort& port_;
  CodebookBuffer* const codebooks_;
  TimedFifo<FineCandidate>& candidates_;
  std::vector<TimedFifo<SplatToken>*> splats_;
  const Rejects rejects_;
  Activity fetch_activity_, decode_activity_, fine_activity_;
  const std::uint32_t record_bytes_;
  std::vector<std::byte> second_halves_;  // [second_half_slots] records
  TimedFifo<FineCandidate> fetched_;
  std::unique_ptr<TimedFifo<Decoded>> decoded_;  // null without codebooks
  TimedFifo<std::uint32_t> free_slots_;
  FineCounters counters_;
};

}  // namespace sgs
