// Construction of a sorter, its sorting thread, and what it publishes.
#include "modules/gscore/sorting/tile_sorter.h"

#include <algorithm>
#include <array>

#include "modules/datapath/selection.h"
#include "modules/gscore/sorting/bitonic_cost.h"

namespace sgs::gscore {
namespace {

constexpr const char *kStages = "list blocks", *kLists = "lists on chip",
                     *kPlaces = "keys of subsets", *kSubsetLines = "lines of subsets",
                     *kSubsetEnds = "subsets in memory", *kSubsetsOnChip = "subsets on chip",
                     *kChunk = "chunk", *kSubsetWrites = "subset writes", *kLoaded = "loaded lists";
constexpr std::uint32_t kPlaceBytes = 2;    // place of an entry in a list
constexpr std::uint32_t kPlaceLists = 2;    // a level of subsets, and the one above
constexpr std::uint32_t kLoadedBytes = 16;  // tile, count, keys

// Each QSU compares with the pivots, the least and the greatest key, and counts.
constexpr std::uint32_t kEntryComparisons = kPivots + 2, kEntryAdditions = 1;
constexpr std::uint32_t kSplitAdditions = kPivotAdders * kPivots + kSubsets;

// Bytes of a subset, at each level of splitting: its keys, and where it begins and how many entries
// it has; in memory its first block, and where it ends.
std::uint32_t subset_bytes(const GscoreConfig& config) {
  return 2 * config.entries().key_bytes() + 2 * kPlaceBytes;
}
std::uint64_t stack_blocks(const GscoreConfig& config) {
  return std::uint64_t{config.pool_blocks()} * most_levels(config.tiles.keys);
}
std::uint32_t subset_in_memory_bytes(const GscoreConfig& config) {
  return 2 * config.entries().key_bytes() + (counter_bits(stack_blocks(config)) + 7) / 8 +
         list_end_bytes(config.blocks(), stack_blocks(config));
}

// One for the place of an entry that does not lie where it comes out, one for the entry.
constexpr std::uint32_t kReadsByPlace = 2;

// Bits that a compare-exchange compares and moves: key and place.
std::uint32_t compared_bits(const GscoreConfig& config) {
  return 8 * (config.entries().key_bytes() + kPlaceBytes);
}
std::uint32_t comparators_of_exchange(const GscoreConfig& config) {
  constexpr std::uint32_t kComparatorBits = 32;
  return (compared_bits(config) + kComparatorBits - 1) / kComparatorBits;
}

}  // namespace

TileSorter::TileSorter(const sc_core::sc_module_name& name, std::uint32_t index,
                       const UnitContext& context, const FinishedTiles& finished)
    : sc_module(name),
      memory("memory", context.config.memory_port, context.clock.period()),
      config_(context.config),
      job_(context.job),
      finished_(finished),
      blocks_(config_.blocks()),
      stack_(job_.subsets.part(job_.subsets.bytes / config_.cores * index,
                               job_.subsets.bytes / config_.cores)),
      load_("load", context.clock),
      sort_("sort", context.clock),
      stages_(std::size_t{kStageBlocks} * blocks_.block_bytes()),
      loaded_("loaded", context.clock, config_.sorting.list_buffers + 2),
      free_lists_("free_lists", context.clock, config_.sorting.list_buffers, 0) {
  for (Activity* a : {&load_, &sort_}) context.phases.drawing.add(*a);
  SC_THREAD(run_load);
  SC_THREAD(run_sort);
}

void TileSorter::run_sort() {
  for (EntryMark mark = EntryMark::kEntry; mark != EntryMark::kEndOfFrame;) {
    Loaded list = loaded_.pop(sort_);
    mark = list.mark;
    sorted_set_ = list.set;
    if (of_tile(mark)) sort_.takes_up_tile(list.tile);
    if (mark == EntryMark::kEntry) {
      sort(list.tile, std::move(list.entries), 0, list.keys);
      free_lists_.push(0, sort_);
      continue;
    }
    sort_.work(1);
    sorted->push({mark, list.tile}, sort_);
  }
  sort_.idles();
}

void TileSorter::sort(std::uint32_t tile, std::vector<TileEntry> entries, std::uint32_t level,
                      const KeyRange& keys) {
  if (finished_.finished(tile)) {
    counters_.dropped_loaded += entries.size();
    return;
  }
  if (keys.single()) {
    counters_.entries_in_order += entries.size();
    if (level > 0) counters_.places_read += entries.size();
    emit(tile, entries, level == 0 ? 1 : kReadsByPlace);
    return;
  }
  if (entries.size() <= config_.sorting.chunk_entries) {
    sort_chunk(tile, entries, level);
    return;
  }
  // The pivots; once through the QSU for the subsets' sizes, then their places, and once more
  // there.
  const Pivots pivots = level == 0 ? sampled_pivots(entries, entries.size()) : ranged_pivots(keys);
  std::array<std::vector<TileEntry>, kSubsets> subsets;
  std::array<KeyRange, kSubsets> ranges;
  for (const TileEntry& entry : entries) {
    const std::uint32_t s = subset_of(pivots, entry.key);
    subsets[s].push_back(entry);
    ranges[s].take(entry.key);
  }
  ++counters_.splits;
  if (level == 0) counters_.list_reads += kPivots;
  counters_.split_entries += entries.size();
  counters_.keys_compared += 2 * entries.size();
  (level == 0 ? counters_.list_reads : counters_.places_read) += 2 * entries.size();
  counters_.places_written += entries.size();
  counters_.subset_accesses += 2 * entries.size() + 2 * kSubsets;
  sort_.work(kPivotCycles + entries.size() + kSubsetRowCycles + kSubsetPlaceCycles +
             entries.size() + kSubsetWriteCycles);
  for (std::size_t s = 0; s < kSubsets; ++s) {
    if (!subsets[s].empty()) sort(tile, std::move(subsets[s]), level + 1, ranges[s]);
  }
}

// The keys of a list lie side by side, and so do those of a subset with their places: 16 come to
// the network at once.
void TileSorter::sort_chunk(std::uint32_t tile, std::vector<TileEntry>& entries,
                            std::uint32_t level) {
  std::stable_sort(entries.begin(), entries.end(),
                   [](const TileEntry& a, const TileEntry& b) { return a.key < b.key; });
  const BitonicCost cost = bitonic_cost(entries.size());
  sort_.work(cost.cycles);
  ++counters_.chunks;
  counters_.chunk_entries += entries.size();
  counters_.compare_exchanges += cost.compare_exchanges;
  counters_.merged += cost.merged;
  (level == 0 ? counters_.list_reads : counters_.places_read) += entries.size();
  emit(tile, entries, kReadsByPlace);
  counters_.places_emitted += entries.size();
}

// An entry comes out behind its reads, the others behind it cycle by cycle.
void TileSorter::emit(std::uint32_t tile, const std::vector<TileEntry>& entries,
                      std::uint32_t reads) {
  sort_.work(reads - 1);
  for (const TileEntry& entry : entries) {
    sort_.work(1);
    sorted->push({EntryMark::kEntry, tile, entry.record, entry.bitmap, entry.opacity, sorted_set_},
                 sort_);
  }
  counters_.entries_sorted += entries.size();
  counters_.list_reads += entries.size();
}

SramUses TileSorter::sram_uses(const GscoreConfig& c) {
  const BlockFormat blocks = c.blocks();
  constexpr auto kPorts = SramPorts::kReadAndWrite;
  const std::uint32_t key_bits = compared_bits(c), levels = most_levels(c.tiles.keys),
                      lists = c.sorting.list_buffers;
  return {
      sram_use(kStages, kBuffer, {{kStageBlocks, "blocks"}, {blocks.block_bytes(), "B"}},
               {8 * kPortBytes}, kOneOfEach),
      // 16 entries go to the network at once. A list is written whole before it is read, so that
      // banks of its own need one port.
      sram_use(kLists, kBuffer,
               {{lists, "lists"}, {c.sorting.list_entries, "entries"}, {blocks.entry.bytes(), "B"}},
               {8 * blocks.entry.bytes(), SramPorts::kOne, lists * kNetworkWidth},
               {kNetworkWidth, lists > 1 ? 1U : 0U}),
      // Splitting reads subsets of one list and writes those of the other.
      sram_use(kPlaces, kBuffer,
               {{kPlaceLists, "lists"}, {c.sorting.list_entries, "keys"}, {key_bits / 8, "B"}},
               {key_bits, SramPorts::kOne, kPlaceLists * kNetworkWidth}, {kNetworkWidth, 1}),
      sram_use(kSubsetLines, kBuffer, {{kSubsets, "subsets"}, {blocks.line_bytes, "B"}},
               {8 * kLineWordBytes, kPorts, kLineBanks}, {kLineBanks, kLineBanks}),
      sram_use(kSubsetEnds, kBuffer,
               {{levels, "levels"}, {kSubsets, "subsets"}, {subset_in_memory_bytes(c), "B"}},
               {8 * subset_in_memory_bytes(c)}, kOneOfEach),
      sram_use(kSubsetsOnChip, kBuffer,
               {{levels, "levels"}, {kSubsets, "subsets"}, {subset_bytes(c), "B"}},
               {8 * subset_bytes(c)}, kOneOfEach),
      // Merging goes from one list to the other: 8 are read and at most 16 written at once.
      sram_use(kChunk, kBuffer,
               {{2, "lists"}, {c.sorting.chunk_entries, "keys"}, {key_bits / 8, "B"}},
               {key_bits, kPorts, kNetworkWidth}, {kMergeWidth, kNetworkWidth}),
      sram_use(kLoaded, kBuffer, {{c.sorting.list_buffers + 2, "lists"}, {kLoadedBytes, "B"}},
               {8 * kLoadedBytes}, kOneOfEach),
      outstanding_table(kBuffer, c.memory_port),
      unanswered_writes(kSubsetWrites, kBuffer, c.memory_port, blocks.line_bytes)};
}

void TileSorter::publish(DataSheet& sheet) {
  const Counters& n = counters_;
  sheet.unit(*this);
  sheet.activity(load_, "list loading", "reads lists of tiles, splits what is too long");
  sheet.activity(sort_, "sorting", "splits lists into chunks and sorts these");
  sheet.counters(counters_);

  const double of_exchange = comparators_of_exchange(config_);
  const double there = kNetworkExchanges, done = static_cast<double>(n.compare_exchanges);
  sheet.part("bsu", "comparator", of_exchange * there, 1);
  sheet.operations("bsu", "comparator", of_exchange * done);
  sheet.part("bsu", "exchange_bit", compared_bits(config_) * there, 1);
  sheet.operations("bsu", "exchange_bit", compared_bits(config_) * done);
  // Multiplexers of two by which 16 entries that begin in any bank come in order, as four rows of
  // them; 8 of the half of the banks that they lie in; 16 to the last four stages; the 8 that are
  // kept back to these; 16 to the half of the banks where they are written.
  constexpr std::uint32_t kRotation = 4, kOfMerge = 4;
  constexpr std::uint32_t kSelected =
      kRotation * kNetworkWidth + kMergeWidth + kNetworkWidth + kMergeWidth + kNetworkWidth;
  sheet.part("bsu", "select_bit", double{kSelected} * compared_bits(config_), 1);
  sheet.operations("bsu", "select_bit",
                   compared_bits(config_) * (kRotation * static_cast<double>(n.chunk_entries) +
                                             kOfMerge * static_cast<double>(n.merged)));
  // Registers for each pair that is merged: the last entries taken of its runs, where both go on
  // and end, and where it is written. The entries that were read are in registers before the first
  // stage.
  const std::uint32_t place_bits = counter_bits(config_.sorting.chunk_entries);
  const double turn_bits = kMergeStages * (2.0 * compared_bits(config_) + 5.0 * place_bits) +
                           double{kNetworkWidth} * compared_bits(config_);
  const double turns = static_cast<double>(n.merged) / kMergeWidth;
  sheet.part("bsu", "comparator", of_exchange, 1);
  sheet.operations("bsu", "comparator", of_exchange * turns);
  sheet.part("bsu", "register_bit", turn_bits, 1);
  sheet.operations("bsu", "register_bit",
                   compared_bits(config_) * static_cast<double>(n.chunk_entries + n.merged) +
                       (compared_bits(config_) + 2.0 * place_bits) * turns);
  // Each QSU: its pivots; the next of a range, and its step; where the stack of blocks and of
  // subsets was before each level.
  constexpr std::uint32_t kQsus = 2;
  const double pivot_bits = 8.0 * config_.entries().key_bytes() * (kPivots + 2);
  const std::uint32_t mark_bits = most_levels(config_.tiles.keys) *
                                  (counter_bits(stack_blocks(config_)) + counter_bits(kSubsets));
  sheet.part("qsu", "comparator", kQsus * kEntryComparisons, 1);
  sheet.operations("qsu", "comparator",
                   double{kEntryComparisons} * static_cast<double>(n.keys_compared));
  sheet.part("qsu", "adder", kQsus * (kEntryAdditions + kPivotAdders), 1);
  sheet.operations("qsu", "adder",
                   double{kEntryAdditions} * static_cast<double>(n.keys_compared) +
                       double{kSplitAdditions} * static_cast<double>(n.splits + n.lists_split));
  sheet.part("qsu", "register_bit", kQsus * (pivot_bits + mark_bits), 1);
  sheet.operations("qsu", "register_bit",
                   (pivot_bits + mark_bits) * static_cast<double>(n.splits + n.lists_split));
  // The row of a subset that was written last, which may be wanted before it can be read.
  const double on_chip_bits = 8.0 * subset_bytes(config_);
  const double in_memory_bits = 8.0 * subset_in_memory_bytes(config_);
  sheet.part("qsu", "register_bit", on_chip_bits + in_memory_bits, 1);
  sheet.operations("qsu", "register_bit",
                   2.0 * on_chip_bits * static_cast<double>(n.split_entries) +
                       in_memory_bits * static_cast<double>(n.entries_split));

  sheet.sram(sram_uses(config_));
  sheet.accesses(kStages, n.stage_words + n.pivots_sampled, n.stage_words);
  sheet.accesses(kLists, n.list_reads, n.entries_loaded);
  sheet.accesses(kPlaces, n.places_read, n.places_written);
  sheet.accesses(kSubsetLines, n.line_reads, n.line_writes);
  const std::uint64_t subsets = kSubsets * n.lists_split;
  sheet.accesses(kSubsetEnds, n.entries_split + subsets, n.entries_split + subsets);
  sheet.accesses(kSubsetsOnChip, n.subset_accesses, n.subset_accesses);
  sheet.accesses(kChunk, n.merged + n.places_emitted, n.chunk_entries + n.merged);
  sheet.accesses(kLoaded, loaded_.popped(), loaded_.pushed());
  sheet.queue(loaded_, kLoaded);
  sheet.port(memory, kSubsetWrites);
  sheet.left_out("entries_of_finished_tiles", "their tile finished before their chunk was sorted",
                 n.dropped_unread + n.dropped_loaded, "sorting, records, blending");
  sheet.left_out("reads_of_finished_tiles", "of these, subsets still in memory", n.dropped_unread,
                 "reading them back");
  sheet.remedy(sort_, "cores");
  sheet.remedy(load_, "cores");
  sheet.remedy(memory, WaitFor::kReads, "lists.block_lines");
  sheet.remedy(memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.remedy(loaded_, WaitFor::kRoom, "sorting.list_buffers");
  sheet.remedy(free_lists_, WaitFor::kRoom, "sorting.list_buffers");
}

}  // namespace sgs::gscore
