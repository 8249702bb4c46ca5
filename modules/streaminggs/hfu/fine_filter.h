// The fine half of an HFU: fetches the second half of each candidate, decodes it and puts it
// through the FFU: projection, exact test against the group, colour. Timing: one candidate every
// ffu_interval_cycles, second_half_slots fetches ahead; quantised second halves pass a stage before
// the FFU that reads the codebook buffer. Function: algorithm/splat/make_splat.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <systemc>
#include <vector>

#include "algorithm/memory/record_split.h"
#include "modules/streaminggs/finished_groups.h"
#include "modules/streaminggs/hfu/codebook_config.h"
#include "modules/streaminggs/hfu/codebook_if.h"
#include "modules/streaminggs/hfu/hfu_config.h"
#include "modules/streaminggs/messages.h"
#include "modules/streaminggs/unit_context.h"
#include "tlm/data_sheet.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs {

// What becomes of a candidate without a splat: nothing, or a token that says so, where the order of
// the tokens tells which filter the next splat comes from.
enum class Rejects { kDropped, kReported };

// Which of the fine filters this is, and how the machine around it wants to be told.
struct FineFilterPlace {
  std::uint32_t reader = 0;  // number at the codebook buffer
  Rejects rejects = Rejects::kDropped;
};

class FineFilter : public sc_core::sc_module {
 public:
  FifoIn<FineCandidate> candidates{"candidates"};
  FifoOuts<SplatToken> splats{"splats"};  // visit v goes to v modulo their number
  CodebookIn codebooks{"codebooks"};      // open where second halves are not quantised
  FinishedGroupsIn finished{"finished"};
  MemoryPort memory;  // second halves

  SC_HAS_PROCESS(FineFilter);
  FineFilter(const sc_core::sc_module_name& name, const HfuConfig& config,
             const CodebookConfig& codebook, const FineFilterPlace& place,
             const UnitContext& context);

  struct Counters {
    std::uint64_t second_halves = 0;  // fetched
    std::uint64_t tests = 0;
    std::uint64_t splats = 0;             // passed on
    std::uint64_t dropped_saturated = 0;  // candidates: the group was finished
    std::uint64_t dropped_fetched = 0;    // of these, with their second half
  };
  const Counters& counters() const { return counters_; }
  static SramUses sram_uses(const HfuConfig& config, const BuiltFor& built_for);
  void publish(DataSheet& sheet);

 private:
  // A candidate whose second half has been read; with a mark there is none.
  struct Decoded {
    static constexpr std::uint32_t kSramBytes = kDecodedBytes;
    FineCandidate candidate;
    DecodedGaussian second;
  };
  // The stage that quantised second halves pass.
  struct DecodeStage {
    Activity decode;
    TimedFifo<Decoded> decoded;
    DecodeStage(const ClockDomain& clock, const CodebookConfig& config)
        : decode("decode", clock),
          decoded("decoded", clock, kDecodedEntries, config.latency_cycles) {}
  };

  void run_fetch();   // thread: second halves of the candidates
  void run_decode();  // thread: codebook entries of quantised ones
  void run_filter();  // thread: FFU
  Decoded take_fetched(Activity& activity);
  void test(const Decoded& decoded);
  void reject(const FineCandidate& candidate);
  void drop_saturated(const FineCandidate& candidate);

  const HfuConfig config_;
  const BuiltFor built_for_;
  const FineFilterPlace place_;
  const StreamingJob& job_;
  Activity fetch_, filter_;
  const Datapath tests_;
  const std::uint32_t record_bytes_;
  std::vector<std::byte> second_halves_;  // [second_half_slots] records
  TimedFifo<FineCandidate> fetched_;
  std::unique_ptr<DecodeStage> stage_;  // null where second halves are not quantised
  TimedFifo<std::uint32_t> free_slots_;
  Counters counters_;
};

}  // namespace sgs
