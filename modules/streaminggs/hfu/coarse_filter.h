// The coarse half of an HFU, or of all HFUs that share a fetch: streams shares of visits through
// the CFUs, which know only what stands in a first half. With a shared fetch the CFUs of all HFUs
// divide the Gaussians among themselves; a CFU bounds one once and compares the bound with every
// part of the group. Of two eyes each test bounds a Gaussian for both. Timing: a Gaussian in each
// CFU at a time; the next slices are fetched while this one is filtered, and the numbers of the
// next group are made. Function: algorithm/memory/record_split.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <systemc>
#include <vector>

#include "algorithm/memory/record_split.h"
#include "modules/datapath/group_numbers.h"
#include "modules/datapath/places_under_test.h"
#include "modules/streaminggs/finished_groups.h"
#include "modules/streaminggs/hfu/hfu_config.h"
#include "modules/streaminggs/messages.h"
#include "modules/streaminggs/unit_context.h"
#include "tlm/data_sheet.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs {

class CoarseFilter : public sc_core::sc_module {
 public:
  FifoIn<VisitShare> shares{"shares"};
  FifoOuts<FineCandidate> survivors{"survivors"};  // visit v goes to v modulo their number
  FinishedGroupsIns finished{"finished"};          // one a part
  MemoryPort memory;                               // first halves

  SC_HAS_PROCESS(CoarseFilter);
  CoarseFilter(const sc_core::sc_module_name& name, const HfuConfig& config,
               const UnitContext& context);

  struct Counters : CounterSet {
    Counter shares{*this, "shares", "shares", "of visits, empty ones and ends of groups included"};
    Counter first_halves{*this, "first_halves", "Gaussians", "fetched"};
    Counter coarse_tests{*this, "coarse_tests", "Gaussians", "tested"};
    Counter coarse_tests_of_parts{*this, "coarse_tests_of_parts", "Gaussians",
                                  "tested, once for each part of the group"};
    Counter coarse_passed{*this, "coarse_passed", "Gaussians",
                          "of these, that may touch their part"};
    Counter coarse_candidates{*this, "coarse_candidates", "Gaussians",
                              "that may touch a part of the group"};
    Counter dropped_saturated{*this, "dropped_saturated", "Gaussians",
                              "dropped: their group was finished"};
    std::uint64_t read = 0;  // first halves, from the input buffer
  };
  const Counters& counters() const { return counters_; }
  static SramUses sram_uses(const HfuConfig& config, const BuiltFor& built_for);
  void publish(DataSheet& sheet);

 private:
  // One part of the input buffer, full of a visit's first halves.
  struct Slice {
    static constexpr std::uint32_t kSramBytes = VisitShare::kSramBytes;  // slots are used in turn
    VisitShare share;  // mark: only with the last slice of a share
    std::uint64_t ticket = 0;
    std::uint32_t slot = 0;   // slot of the input buffer
    std::uint64_t known = 0;  // cycle from which on its group is known here
  };

  void run_load();    // thread: first halves into the input buffer
  void run_filter();  // thread: CFUs
  void wait_for_numbers(const Slice& slice);
  void filter_slice(const Slice& slice);
  PlacesUnderTest& places_of(std::uint32_t visit) { return places_[visit % places_.size()]; }
  // A Gaussian as each eye sees it.
  using Bounds = std::array<FirstHalfBound, 2>;
  std::uint32_t test(const Bounds& bounds, std::uint32_t group, std::uint32_t open);
  GroupReach reach(const Bounds& bounds, std::uint32_t group, std::uint32_t parts) const;
  std::uint32_t part_count() const { return static_cast<std::uint32_t>(job_.parts.size()); }

  std::byte* first_half(std::uint32_t slot, std::uint32_t at);  // in the input buffer

  const HfuConfig config_;
  const BuiltFor built_for_;
  const Datapath tests_;
  const bool has_cfus_;
  TestedGroupNumbers numbers_;
  const StreamingJob& job_;
  const std::uint32_t record_bytes_;
  Activity load_, filter_;
  std::vector<std::byte> input_;  // [input_slots, slice_gaussians] first halves
  TimedFifo<Slice> slices_;       // filled slots
  TimedFifo<std::uint32_t> free_slots_;
  std::vector<PlacesUnderTest> places_;  // in each FIFO of survivors
  Counters counters_;
  std::uint32_t current_group_ = 0, current_visit_ = 0;  // for the waveform
};

}  // namespace sgs
