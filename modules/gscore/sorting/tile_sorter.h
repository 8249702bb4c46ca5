// Sorter of one core: reads a tile's list, splits it into ordered subsets until these are chunks,
// and sorts chunk by chunk, nearest first. The rest of a finished tile is dropped.
// Timing: an entry a cycle through each QSU. One is where lists come in, and also splits lists that
// are too long for the chip; the other is at the lists on chip. Each also takes a cycle for each
// pivot, before the entries; on chip one for each subset's place; and the cycles in which its
// pipeline runs empty (pivots.h). A chunk takes bitonic_cost() in the network; an entry leaves a
// cycle, the first of a chunk behind its place. Blocks of a list are asked for one ahead.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <systemc>
#include <vector>

#include "modules/gscore/finished_tiles.h"
#include "modules/gscore/gscore_job.h"
#include "modules/gscore/line_buffer.h"
#include "modules/gscore/messages.h"
#include "modules/gscore/sorting/pivots.h"
#include "tlm/data_sheet.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs::gscore {

class TileSorter : public sc_core::sc_module {
 public:
  FifoOut<TileRequest> requests{"requests"};
  FifoIn<TileJob> jobs{"jobs"};
  FifoOut<SortedEntry> sorted{"sorted"};
  MemoryPort memory;

  SC_HAS_PROCESS(TileSorter);
  // index: of the core; finished: told by the rendering of the same core.
  TileSorter(const sc_core::sc_module_name& name, std::uint32_t index, const UnitContext& context,
             const FinishedTiles& finished);

  static SramUses sram_uses(const GscoreConfig& config);
  void publish(DataSheet& sheet);

 private:
  // A list in memory: of a tile, or a subset of one.
  struct Chain {
    RegionSpan region;
    std::uint32_t block = 0;  // the first
    std::uint32_t entries = 0;
    KeyRange keys;
    bool ranged = false;  // keys are known
  };
  // A list on chip, or a mark; its bytes lie in the buffer.
  struct Loaded {
    EntryMark mark = EntryMark::kEntry;
    std::uint32_t tile = 0;
    std::vector<TileEntry> entries;
    KeyRange keys;
    std::uint32_t set = 0;  // of records
  };
  // A block on its way.
  struct Block {
    std::uint64_t head = 0, rest = 0;  // tickets
    std::uint32_t entries = 0;
  };

  static constexpr std::uint32_t kStageBlocks = 2;  // under way or read

  void run_load();  // thread
  void run_sort();  // thread

  void load(std::uint32_t tile, const Chain& list, std::uint32_t level);
  void load_on_chip(std::uint32_t tile, const std::vector<TileEntry>& entries,
                    const KeyRange& keys);
  void split_in_memory(std::uint32_t tile, const Chain& list, std::uint32_t level);
  // Hands entries on as they come, block by block.
  void read_chain(const Chain& list, const std::function<void(std::vector<TileEntry>&)>& take);
  Block ask_for(const Chain& list, std::uint32_t block, std::uint32_t entries, std::size_t stage);
  void put_subset(const TileEntry& entry, ListEnd& end, LineBuffer& line, std::uint32_t& first);
  void flush(LineBuffer& line);

  void sort(std::uint32_t tile, std::vector<TileEntry> entries, std::uint32_t level,
            const KeyRange& keys);
  void sort_chunk(std::uint32_t tile, std::vector<TileEntry>& entries, std::uint32_t level);
  // reads: from one another, until an entry is there.
  void emit(std::uint32_t tile, const std::vector<TileEntry>& entries, std::uint32_t reads);

  const GscoreConfig config_;
  const GscoreJob& job_;
  const FinishedTiles& finished_;
  const BlockFormat blocks_;
  const RegionSpan stack_;  // blocks for subsets
  Activity load_, sort_;
  std::vector<std::byte> stages_;           // [2] blocks
  std::uint32_t next_block_ = 0;            // next free block of the stack
  std::uint32_t set_ = 0, sorted_set_ = 0;  // of records, of the tile that is loaded, and sorted
  TimedFifo<Loaded> loaded_;
  TimedFifo<std::uint32_t> free_lists_;

  struct Counters : CounterSet {
    Counter tiles{*this, "tiles", "tiles", "taken"};
    Counter entries_read{*this, "entries_read", "entries", "of lists and of subsets in memory"};
    Counter entries_loaded{*this, "entries_loaded", "entries", "that came to lists on chip"};
    Counter lists_split{*this, "lists_split", "lists", "too long for the chip, split in memory"};
    Counter entries_split{*this, "entries_split", "entries", "of these, written to subsets"};
    Counter splits{*this, "splits", "lists", "split on chip"};
    Counter split_entries{*this, "split_entries", "entries", "of these"};
    Counter chunks{*this, "chunks", "chunks", "sorted by the network"};
    Counter chunk_entries{*this, "chunk_entries", "entries", "of these"};
    Counter entries_in_order{*this, "entries_in_order", "entries", "of lists with one key"};
    Counter entries_sorted{*this, "entries_sorted", "entries", "handed on"};
    Counter dropped_unread{*this, "dropped_unread", "entries",
                           "of finished tiles, still in memory"};
    Counter dropped_loaded{*this, "dropped_loaded", "entries", "of finished tiles, on chip"};
    Counter compare_exchanges{*this, "compare_exchanges", "operations", "of the network"};
    Counter merged{*this, "merged", "entries", "once for each level of merging"};
    std::uint64_t places_emitted = 0;
    std::uint64_t pivots_sampled = 0;   // from blocks
    std::uint64_t subset_accesses = 0;  // on chip: reads, and writes
    std::uint64_t stage_words = 0, line_reads = 0, line_writes = 0;
    std::uint64_t places_read = 0, places_written = 0, list_reads = 0;
    std::uint64_t keys_compared = 0;  // by the QSUs
  } counters_;
};

}  // namespace sgs::gscore
