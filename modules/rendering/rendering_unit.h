// Rendering unit: blends sorted splats into the pixels of the current group and writes finished
// groups to the frame buffer. Timing: one splat covers `clusters` of its unfinished 4x4 sub-tiles a
// cycle; a group drains at drain_pixels_per_cycle. Function: algorithm/render/group_state.h.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <systemc>
#include <vector>

#include "algorithm/render/group_state.h"
#include "modules/frame_job.h"
#include "modules/messages.h"
#include "modules/rendering/rendering_config.h"
#include "modules/saturation_board.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs {

struct RenderingCounters {
  std::uint64_t groups = 0;
  std::uint64_t splats = 0;            // blended into at least one sub-tile
  std::uint64_t splats_saturated = 0;  // arrived when their group was finished
  std::uint64_t subtile_tests = 0;     // of the ellipse
  std::uint64_t subtile_blends = 0;
  std::uint64_t contributors = 0;  // (splat, pixel) blends
  std::uint64_t groups_saturated = 0;
};

// How the splats of one group are spread over the FIFOs that rendering reads: whole visits in turn
// (paper order), or each token in turn (exact order).
enum class Arrival { kByVisit, kByToken };

class RenderingUnit : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(RenderingUnit);
  // sorted: FIFOs that are read in turn. on_done() is called when the last pixel of the last group
  // has been written.
  RenderingUnit(const sc_core::sc_module_name& name, const RenderingConfig& config,
                const ClockDomain& clock, const FrameJob& job, SaturationBoard& board,
                MemoryPort& port, std::vector<TimedFifo<SplatToken>*> sorted, Arrival arrival,
                std::function<void()> on_done);

  const RenderingCounters& counters() const { return counters_; }
  const Activity& blend_activity() const { return blend_activity_; }
  const Activity& drain_activity() const { return drain_activity_; }
  std::array<Activity*, 2> activities() { return {&blend_activity_, &drain_activity_}; }
  void trace(sc_core::sc_trace_file* file) const;

 private:
  void blend();  // thread
  void drain();  // thread
  void blend_splat(const Splat& splat, std::uint32_t group, GroupState& state);
  void write_group(const GroupState& state);

  const RenderingConfig config_;
  const FrameJob& job_;
  SaturationBoard& board_;
  MemoryPort& port_;
  std::vector<TimedFifo<SplatToken>*> sorted_;
  const Arrival arrival_;
  std::function<void()> on_done_;
  Activity blend_activity_, drain_activity_;
  TimedFifo<std::shared_ptr<GroupState>> finished_;
  TimedFifo<std::uint32_t> free_buffers_;
  RenderingCounters counters_;
  std::uint32_t current_group_ = 0;  // for the waveform
};

}  // namespace sgs
