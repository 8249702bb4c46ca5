// 16 volume rendering units: fetch the records of sorted entries, blend them into a tile, write its
// pixels.
// Timing: 16 pixels begin in each turn of the blending lanes, so a part of 8 x 8 px takes 4. None
// begins before the splat ahead of it on the same pixels has left the loop through their state. A
// splat takes a cycle at least. Function: GroupState.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <systemc>
#include <vector>

#include "algorithm/render/group_state.h"
#include "modules/datapath/rendering_flows.h"
#include "modules/frame_host.h"
#include "modules/gscore/finished_tiles.h"
#include "modules/gscore/gscore_job.h"
#include "modules/gscore/messages.h"
#include "tlm/data_sheet.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs::gscore {

class RenderCore : public sc_core::sc_module {
 public:
  FifoIn<SortedEntry> sorted{"sorted"};
  FifoOut<PassDone> done{"done"};
  FrameHostPort host{"host"};
  MemoryPort record_memory, pixel_memory;

  SC_HAS_PROCESS(RenderCore);
  RenderCore(const sc_core::sc_module_name& name, const UnitContext& context,
             FinishedTiles& finished);

  static SramUses sram_uses(const GscoreConfig& config);
  void publish(DataSheet& sheet);

 private:
  struct Fetched {
    static constexpr std::uint32_t kSramBytes = SortedEntry::kSramBytes;  // at least
    SortedEntry entry;
    std::uint32_t slot = 0;
    std::uint64_t ticket = 0;
  };
  // A finished tile, or a mark of the pass.
  struct Finished {
    EntryMark mark = EntryMark::kEndOfTile;
    std::shared_ptr<GroupState> state;
    std::uint32_t tile = 0;
  };
  static constexpr int kBlocks = kSubtilesPerTile * kSubtilesPerTile;  // blocks of 16 px in a tile

  void run_fetch();  // thread
  void run_blend();  // thread
  void run_drain();  // thread
  void begin_tile(std::uint32_t tile);
  void take(const Fetched& next);
  template <class AnySplat>
  void blend(const SortedEntry& entry, const AnySplat& splat);
  // The cycle from which it is known that all blocks of a part are finished.
  std::uint64_t finished_from(int part) const;
  // Latency from a splat's turn to the pixels behind its first block.
  std::uint64_t depth_cycles() const;
  void write_tile(const GroupState& state, const Picture& picture);

  const GscoreConfig config_;
  const GscoreJob& job_;
  FinishedTiles& finished_;
  const std::optional<Datapath> conic_path_;
  const Datapath corner_path_, blend_path_, drain_path_;
  const PixelWrites pixel_writes_;
  const std::uint32_t record_bytes_;
  Activity fetch_, blend_, drain_;
  std::vector<std::byte> records_;
  TimedFifo<Fetched> fetched_;
  TimedFifo<std::uint32_t> free_records_;
  TimedFifo<Finished> finished_states_;
  TimedFifo<std::uint32_t> free_pixels_;

  std::shared_ptr<GroupState> state_;  // state of the tile that is blended
  bool in_tile_ = false;
  std::vector<std::uint64_t> free_from_;      // [16 px] cycle
  std::vector<std::uint64_t> finished_from_;  // [16 px] cycle
  std::uint64_t finished_pixels_ = 0;
  std::uint32_t tile_ = 0;  // for the waveform too

  struct Counters : CounterSet {
    Counter tiles{*this, "tiles", "tiles", "rendered"};
    Counter tiles_finished{*this, "tiles_finished", "tiles",
                           "of these with every pixel finished early"};
    Counter records{*this, "records", "Gaussians", "fetched, once for each tile"};
    Counter dropped{*this, "dropped", "entries", "of finished tiles, without a record"};
    Counter dropped_fetched{*this, "dropped_fetched", "entries",
                            "of finished tiles, with their record"};
    Counter splats{*this, "splats", "entries", "blended or looked at"};
    Counter parts{*this, "parts", "parts", "of tiles, blended"};
    Counter parts_finished{*this, "parts_finished", "parts",
                           "that were finished or outside the frame"};
    Counter blocks{*this, "blocks", "blocks", "of 16 px, one for each VRU"};
    Counter blocks_finished{*this, "blocks_finished", "blocks",
                            "of blended parts, that were finished or outside the frame"};
    Counter hazard_cycles{*this, "hazard_cycles", "cycles",
                          "waiting for the splat ahead on the same pixels"};
    Counter contributors{*this, "contributors", "pixels", "blended with an alpha above 1/255"};
    Counter pixels{*this, "pixels", "pixels", "written"};
  } counters_;
};

}  // namespace sgs::gscore
