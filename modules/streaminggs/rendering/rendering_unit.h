// Rendering unit: blends sorted splats into the pixels of the current group and writes finished
// groups to the frame buffer. Timing: a row of a splat's unfinished 4x4 sub-tiles a cycle at most,
// one of them for each cluster (cluster_schedule.h); a group drains at drain_pixels_per_cycle, row
// by row of pixels, a word of each sub-tile in the row, and is cleared behind that. Function:
// algorithm/render/group_state.h.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <systemc>
#include <vector>

#include "algorithm/render/group_state.h"
#include "modules/frame_host.h"
#include "modules/streaminggs/finished_groups.h"
#include "modules/streaminggs/finished_subtiles.h"
#include "modules/streaminggs/messages.h"
#include "modules/streaminggs/rendering/cluster_schedule.h"
#include "modules/streaminggs/rendering/rendering_config.h"
#include "modules/streaminggs/unit_context.h"
#include "tlm/data_sheet.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs {

// Distribution of the splats of one group over the FIFOs that rendering reads: whole visits in turn
// (paper order), or each token in turn (exact order).
enum class Arrival { kByVisit, kByToken };

class RenderingUnit : public sc_core::sc_module {
 public:
  FifoIns<SplatToken> splats{"splats"};  // read in turn
  FinishGroupOut finish{"finish"};
  FinishSubtileOut finish_subtile{"finish_subtile"};
  FrameHostPort host{"host"};
  MemoryPort memory;  // pixels

  SC_HAS_PROCESS(RenderingUnit);
  // on_drawn() is called when all pixels of a frame are in the memory, frame after frame.
  RenderingUnit(const sc_core::sc_module_name& name, const RenderingConfig& config, Arrival arrival,
                const UnitContext& context, std::function<void(std::uint32_t frame)> on_drawn);

  struct Counters : CounterSet {
    Counter groups{*this, "groups", "groups", "rendered"};
    Counter groups_saturated{*this, "groups_saturated", "groups",
                             "of these with every pixel finished early"};
    Counter splats{*this, "splats", "splats", "blended into at least one sub-tile"};
    Counter splats_taken{*this, "splats_taken", "splats",
                         "sent on to the clusters, whether they reach any or not"};
    Counter splats_saturated{*this, "splats_saturated", "splats",
                             "that came when their group was finished"};
    Counter splats_hidden{*this, "splats_hidden", "splats",
                          "that came when all sub-tiles of their footprint were finished"};
    Counter splats_spanned{*this, "splats_spanned", "splats",
                           "on more sub-tiles than a few: rows got spans"};
    Counter spans{*this, "spans", "rows", "of sub-tiles whose span in the ellipse was computed"};
    Counter contributors{*this, "contributors", "pixels", "blended with an alpha above 1/255"};
    std::uint64_t begun_span_reads = 0;  // for these spans, those that come at once sharing one
  };
  const Counters& counters() const { return counters_; }
  const ClusterSchedule::Counters& schedule_counters() const { return schedule_.counters(); }
  static SramUses sram_uses(const RenderingConfig& config, const BuiltFor& built_for);
  void publish(DataSheet& sheet);

 private:
  void run_blend();  // thread
  void run_drain();  // thread
  void run_tell();   // thread: frames whose pixels have come to the memory
  void blend_splat(const Splat& splat, std::uint32_t group, GroupState& state);
  void tell_finished(std::uint32_t group, std::size_t at, std::uint64_t now);
  void work_until(std::uint64_t cycle);
  void publish_ledger(DataSheet& sheet);
  void publish_dispatcher(DataSheet& sheet);
  void publish_pixels(DataSheet& sheet);
  void write_group(const GroupState& state, const Picture& picture);

  const RenderingConfig config_;
  const BuiltFor built_for_;
  const StreamingJob& job_;
  const Arrival arrival_;
  std::function<void(std::uint32_t frame)> on_drawn_;
  Activity blend_, drain_;
  TimedFifo<std::shared_ptr<GroupState>> finished_;
  TimedFifo<std::uint32_t> free_buffers_;
  ClusterSchedule schedule_;
  std::deque<MemoryPort::Ticket> drained_;  // ends of frames that are not told yet
  sc_core::sc_event drained_one_;
  Counters counters_;
  std::vector<std::uint64_t> cycles_of_groups_;  // from the end of the one before
  std::uint64_t finished_pixels_ = 0;
  std::uint32_t current_group_ = 0;  // for the waveform
};

}  // namespace sgs
