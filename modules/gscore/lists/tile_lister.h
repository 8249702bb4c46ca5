// Tile lister and control. It tests the tiles of projected Gaussians, in the order of the scene.
// Those that touch any are numbered, written, and entered in the lists of their tiles. When a pass
// is projected it hands its tiles out to the cores.
// Timing: neighbours of a row of tiles are tested in a turn of their lanes. Each that is touched is
// then tested in a turn of the parts' lanes, and listed in a cycle. Entries of a tile are combined
// in a line, which is written when it is full or another tile takes its place. Tiles are handed out
// one a cycle, as they are asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <systemc>
#include <vector>

#include "modules/frame_host.h"
#include "modules/gscore/gscore_job.h"
#include "modules/gscore/line_buffer.h"
#include "modules/gscore/messages.h"
#include "tlm/data_sheet.h"
#include "tlm/fifo_selector.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs::gscore {

class TileLister : public sc_core::sc_module {
 public:
  FifoOuts<Pass> passes{"passes"};            // one a CCU
  FifoIns<Converted> converted{"converted"};  // one a CCU
  FifoIns<TileRequest> requests{"requests"};  // one a core
  FifoOuts<TileJob> jobs{"jobs"};             // one a core
  FifoIns<PassDone> done{"done"};             // one a core
  FrameHostPort host{"host"};
  MemoryPort memory;

  SC_HAS_PROCESS(TileLister);
  TileLister(const sc_core::sc_module_name& name, const UnitContext& context,
             std::function<void(std::uint32_t frame)> on_drawn);

  static SramUses sram_uses(const GscoreConfig& config);
  void publish(DataSheet& sheet);
  // Gaussians taken that both eyes see.
  std::uint64_t second_eyes_taken() const { return counters_.second_eyes; }

 private:
  struct Line {
    LineBuffer buffer;
    std::uint32_t tile = 0;  // tile of the pass, from 1 on; 0: none
  };

  // Kept from a Gaussian's first test on until the last of its tiles is listed.
  struct TestedGaussian {
    Splat splat{};
    std::uint32_t key = 0;
  };
  // A tile that a Gaussian is listed in; at its first one the record is written. Or the end of a
  // pass.
  struct ListedTile {
    static constexpr std::uint32_t kSramBytes = 6;  // the Gaussian's number, tile, bitmap, marks
    std::uint32_t gaussian = 0;  // number of the Gaussian among those that are kept
    std::uint32_t tile = 0, bitmap = 0;
    bool first = false, end = false;
  };

  // A pass whose lists are in memory.
  struct ProjectedPass {
    static constexpr std::uint32_t kSramBytes = Pass::kSramBytes + 1;
    Pass pass;
    std::uint32_t set = 0;
  };

  void run_test();  // thread
  void run_list();  // thread
  void run_draw();  // thread: passes that are projected, where that is not the list's part
  void test_tiles(const ConvertedForEye& gaussian, std::uint32_t eye, const Pass& pass);
  // True if all lists of the pass are in memory; if not, the pool was too small.
  bool project(const Pass& pass);
  void take(const ListedTile& tile, const Pass& pass);
  void put_record(const Splat& splat);
  void flush_records();
  void put_entry(std::uint32_t tile, const TileEntry& entry);
  std::uint32_t flush_line(Line& line);  // the words that are read
  void flush_between(Line& line);        // two entries
  bool overlaps() const { return config_.lists.sets > 1; }
  void draw(const ProjectedPass& pass, Activity& by);

  const GscoreConfig config_;
  const GscoreJob& job_;
  Phases& phases_;
  const BlockFormat blocks_;
  const std::function<void(std::uint32_t frame)> on_drawn_;
  const Datapath tile_path_;
  const std::optional<Datapath> part_path_;  // where tiles have parts
  Activity test_, list_, draw_;
  TimedFifo<Pass> test_passes_;
  std::vector<TestedGaussian> tested_;
  std::uint32_t next_tested_ = 0;
  TimedFifo<ListedTile> listed_;
  std::unique_ptr<FifoSelector<TileRequest>> asked_;  // made by the thread
  std::vector<std::vector<ListEnd>> ends_;            // [set][tile of the pass]
  TimedFifo<ProjectedPass> projected_;                // with two sets
  TimedFifo<std::uint32_t> free_sets_;
  std::uint32_t set_ = 0;                    // that is written
  std::optional<std::uint32_t> projecting_;  // first tile of the pass
  std::vector<Line> lines_;
  std::vector<std::byte> records_;  // records that wait until there are enough for a transaction
  std::uint32_t waiting_records_ = 0;
  std::uint32_t next_block_ = 0;  // free pointer
  bool overflowed_ = false;
  std::uint32_t record_number_ = 0;  // number of the next record

  struct Counters : CounterSet {
    Counter passes{*this, "passes", "passes", "over the scene"};
    Counter passes_overflowed{*this, "passes_overflowed", "passes",
                              "of these made again: the pool was too small"};
    Counter ends_alone{*this, "ends_alone", "slices", "whose last Gaussian is on no tile"};
    Counter tile_tests{*this, "tile_tests", "tiles", "tested, once for each Gaussian"};
    Counter tile_steps{*this, "tile_steps", "steps", "of neighbours in a row, tested together"};
    Counter part_tests{*this, "part_tests", "tiles", "touched, whose parts are tested"};
    Counter gaussians{*this, "gaussians", "Gaussians", "taken, once for each pass"};
    Counter gaussians_off_pass{*this, "gaussians_off_pass", "Gaussians",
                               "of these with tiles in other passes only"};
    Counter pairs{*this, "pairs", "entries", "a Gaussian in a tile each"};
    Counter records{*this, "records", "Gaussians", "projected, written"};
    Counter blocks{*this, "blocks", "blocks", "of lists begun"};
    Counter lines_full{*this, "lines_full", "lines", "written when they were full"};
    Counter lines_displaced{*this, "lines_displaced", "lines",
                            "written when another tile took their place"};
    Counter line_cycles{*this, "line_cycles", "cycles",
                        "in which entries waited while such a line was read"};
    Counter list_entries_max{*this, "list_entries_max", "entries", "of the longest list"};
    Counter tiles{*this, "tiles", "tiles", "handed out"};
    Counter tiles_empty{*this, "tiles_empty", "tiles", "of these without a Gaussian"};
    std::uint64_t second_eyes = 0;                  // of Gaussians that both see
    std::uint64_t line_reads = 0, line_writes = 0;  // words
    std::uint64_t table_reads = 0, table_writes = 0;
    std::uint64_t line_looks = 0, line_changes = 0;
  } counters_;
};

}  // namespace sgs::gscore
