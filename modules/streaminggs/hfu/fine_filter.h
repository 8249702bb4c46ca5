// The fine half of an HFU, or of all HFUs that share a fetch: fetches the second half of each
// candidate, decodes it and puts it through the FFU: projection, exact test against the group,
// colour. With a shared fetch a second half is read once and taken by the HFU of each part of the
// group that the candidate may touch; its slot is free when all have it. Eyes are parts, too.
// Timing: one candidate every ffu_interval_cycles in each FFU, whose turns are spread evenly; marks
// pass beside the lanes. Each begins only with a place in the FIFO behind its pipeline.
// The group's pixels are found while its first second half is fetched, once no test takes those of
// the group before the last. second_half_slots fetches run ahead. Quantised second halves pass a
// stage before the FFU that reads the codebook buffer, each once there is a place for the decoded
// record. Function: algorithm/splat/make_splat.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <systemc>
#include <vector>

#include "algorithm/memory/record_split.h"
#include "modules/datapath/group_numbers.h"
#include "modules/datapath/places_under_test.h"
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

// Treatment of a candidate without a splat: dropped, or reported by a token where the order of the
// tokens tells which filter the next splat comes from.
enum class Rejects { kDropped, kReported };

// Place of a fine filter in its machine, and its treatment of rejects.
struct FineFilterPlace {
  std::uint32_t reader = 0;  // number of its first HFU at the codebook buffer
  Rejects rejects = Rejects::kDropped;
};

// Entries for candidates whose second halves are on their way or waiting, and one for a mark.
inline std::uint32_t fetched_entries(const HfuConfig& config) {
  return config.second_half_slots + 1;
}

class FineFilter : public sc_core::sc_module {
 public:
  FifoIn<FineCandidate> candidates{"candidates"};
  // As many FIFOs for each part, part by part; within a part, visit v goes to v modulo their
  // number.
  FifoOuts<SplatToken> splats{"splats"};
  CodebookIn codebooks{"codebooks"};       // open where second halves are not quantised
  FinishedGroupsIns finished{"finished"};  // one a part
  MemoryPort memory;                       // second halves

  SC_HAS_PROCESS(FineFilter);
  FineFilter(const sc_core::sc_module_name& name, const HfuConfig& config,
             const CodebookConfig& codebook, const FineFilterPlace& place,
             const UnitContext& context);

  struct Counters : CounterSet {
    Counter second_halves{*this, "second_halves", "Gaussians", "fetched"};
    Counter second_halves_taken{*this, "second_halves_taken", "Gaussians",
                                "of these, once for each part of the group that wanted them"};
    Counter fine_tests{*this, "fine_tests", "Gaussians", "tested, once for each part of the group"};
    Counter splats{*this, "splats", "splats", "that touch their part, passed on"};
    Counter dropped_saturated{*this, "dropped_saturated", "Gaussians",
                              "dropped: their part was finished"};
    Counter dropped_fetched{*this, "dropped_fetched", "Gaussians",
                            "of these with their second half already fetched"};
  };
  const Counters& counters() const { return counters_; }
  // Cycles to read a second half out of its slot: a word a cycle.
  static std::uint32_t read_cycles(std::uint32_t record_bytes);
  static SramUses sram_uses(const HfuConfig& config, const BuiltFor& built_for,
                            std::uint32_t parts);
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
    DecodeStage(const std::string& number, const ClockDomain& clock, const CodebookConfig& config)
        : decode(("decode" + number).c_str(), clock),
          decoded(("decoded" + number).c_str(), clock, kDecodedEntries, config.latency_cycles) {}
  };
  // Parts of each HFU behind the fetch. number: suffix of the names, where there are several.
  struct Part {
    const std::uint32_t index;
    Activity filter;
    TimedFifo<FineCandidate> fetched;
    std::unique_ptr<DecodeStage> stage;   // null where second halves are not quantised
    std::vector<PlacesUnderTest> places;  // in each FIFO of its splats
    TestedGroupNumbers numbers;
    sc_core::sc_event arrived;  // something that its FFU takes
    // Activity that takes second halves out of their slots.
    Activity& taker() { return stage ? stage->decode : filter; }
    Part(std::uint32_t at, const std::string& number, const ClockDomain& clock,
         std::uint32_t fetched_entries, const GroupNumbers& of_groups)
        : index(at),
          filter(("filter" + number).c_str(), clock),
          fetched(("fetched" + number).c_str(), clock, fetched_entries),
          numbers(of_groups) {}
  };

  void make_part(std::uint32_t index, const ClockDomain& clock, const CodebookConfig& codebook);
  void run_fetch();             // thread: second halves of the candidates
  void run_decode(Part& part);  // thread: codebook entries of quantised ones
  void run_filter(Part& part);  // thread: FFU
  void fetch(FineCandidate candidate);
  DecodedGaussian read_slot(const Part& part, const FineCandidate& candidate) const;
  void free_slot(std::uint32_t slot, Activity& activity);
  void name_holder_of_slots();
  void filter_next(Part& part);
  void filter_fetched(Part& part);
  void filter_decoded(Part& part);
  bool is_wanted(const Part& part, const FineCandidate& candidate) const;
  void drop(Part& part, const FineCandidate& candidate);
  void pass_mark(Part& part, const FineCandidate& candidate);
  bool mark_is_next(Part& part);
  void work_lanes(Part& part, std::uint64_t end);
  void wait_for_numbers(Part& part, std::uint32_t group) const;
  void wait_for_turn_of_one(Part& part) const;
  void wait_for_place(Part& part, std::uint32_t visit);
  void test(Part& part, const Decoded& decoded);
  void hand_on(Part& part, const Decoded& decoded, std::uint64_t began);
  void reject(Part& part, const FineCandidate& candidate);
  void take_up(const FineCandidate& candidate, Activity& activity) const;
  void drop_saturated(const FineCandidate& candidate);
  FifoWriteIf<SplatToken>& to_sorting(const Part& part, std::uint32_t visit);

  const HfuConfig config_;
  const BuiltFor built_for_;
  const FineFilterPlace place_;
  const StreamingJob& job_;
  Activity fetch_;
  const Datapath tests_;
  const std::uint32_t record_bytes_;
  // Cycles from a test to the next, at least: until its record is read where no stage reads it
  // ahead, and of a single FFU as long as its lanes take.
  const std::uint64_t test_cycles_;
  std::vector<std::byte> second_halves_;  // [second_half_slots] records
  std::vector<std::uint32_t> wanted_;     // [second_half_slots] parts that have not yet taken it
  std::vector<std::unique_ptr<Part>> parts_;
  TimedFifo<std::uint32_t> free_slots_;
  Counters counters_;
};

}  // namespace sgs
