// Culling and conversion unit. It fetches the first halves of its share of the scene, or of the
// slices that the culler hands it, and drops Gaussians that cannot touch the frame. It fetches the
// second halves of the others, projects and colours them, and finds the boxes that say which tiles
// they may touch. Timing: both datapaths begin an item in their turns, where it has a place behind
// their pipelines; ends of slices pass beside the lanes; slices in turn over the CCUs. Function:
// may_touch_frame(), make_tile_geometry().
#pragma once

#include <cstddef>
#include <cstdint>
#include <systemc>
#include <vector>

#include "algorithm/splat/coarse_bound.h"
#include "modules/datapath/places_under_test.h"
#include "modules/gscore/gscore_job.h"
#include "modules/gscore/messages.h"
#include "tlm/data_sheet.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs::gscore {

class Ccu : public sc_core::sc_module {
 public:
  // The one or the other, by config.culling.
  sc_core::sc_port<FifoReadIf<Pass>, 1, sc_core::SC_ZERO_OR_MORE_BOUND> passes{"passes"};
  sc_core::sc_port<FifoReadIf<VisibleSlice>, 1, sc_core::SC_ZERO_OR_MORE_BOUND> visible{"visible"};
  FifoOut<Converted> converted{"converted"};
  MemoryPort first_memory, second_memory;  // first halves, second halves

  SC_HAS_PROCESS(Ccu);
  // index: of all CCUs: slice s of the scene belongs to CCU s mod config.ccus.
  Ccu(const sc_core::sc_module_name& name, std::uint32_t index, const UnitContext& context);

  struct Counters : CounterSet {
    Counter first_halves{*this, "first_halves", "Gaussians", "fetched"};
    Counter culled{*this, "culled", "Gaussians", "of these, that cannot touch the frame"};
    Counter second_halves{*this, "second_halves", "Gaussians", "fetched"};
    Counter runs{*this, "runs", "reads", "of these, of neighbours in memory at once"};
    Counter converted{*this, "converted", "Gaussians", "projected and coloured, for all eyes"};
    Counter unseen{*this, "unseen", "Gaussians", "of these on no tile"};
    std::uint64_t gathered = 0;  // candidates and ends of slices
  };

  static SramUses sram_uses(const GscoreConfig& config);
  void publish(DataSheet& sheet);

 private:
  struct Slice {
    static constexpr std::uint32_t kSramBytes = 8;  // first, count, marks
    std::uint32_t first = 0, count = 0, slot = 0, frame = 0;
    bool end_of_pass = false, over = false;
    std::uint64_t ticket = 0;
  };

  void run_load();     // thread
  void run_cull();     // thread
  void run_fetch();    // thread
  void run_convert();  // thread

  void load_passes();
  void load_visible();
  void load(Slice slice);
  void cull(const Slice& slice);
  void pass_on_empty(const Slice& slice);
  // Asks for the second halves of neighbours at once, from the candidate `first` of a slice on;
  // returns where the next ones begin.
  std::size_t fetch_run(std::vector<Candidate>& slice, std::size_t first);
  void convert();
  void pass_end();
  void keep_lanes(std::uint64_t until);
  bool comes_before(std::uint64_t cycle);
  std::byte* input(std::uint32_t slot, std::uint32_t at);

  const std::uint32_t index_;
  const GscoreConfig config_;
  const GscoreJob& job_;
  std::vector<FrameSides<float>> sides_;  // [frame]
  const Datapath cull_path_, convert_path_;
  const std::uint32_t first_bytes_, second_bytes_;
  Activity load_, cull_, fetch_, convert_;
  std::vector<std::byte> input_, second_halves_;
  TimedFifo<Slice> slices_;
  TimedFifo<std::uint32_t> free_input_;
  TimedFifo<Candidate> culled_;
  PlacesUnderTest culled_places_;
  TimedFifo<Candidate> fetched_;
  sc_core::sc_event candidate_came_;
  TimedFifo<std::uint32_t> free_second_;
  PlacesUnderTest converted_places_;
  Counters counters_;
};

}  // namespace sgs::gscore
