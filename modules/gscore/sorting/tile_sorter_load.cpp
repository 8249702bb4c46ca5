// The loading thread of a sorter: follows a list's chain of blocks, and splits what is too long for
// the chip in memory.
#include <algorithm>
#include <array>
#include <cstring>

#include "modules/datapath/work_rates.h"
#include "modules/gscore/sorting/tile_sorter.h"

namespace sgs::gscore {

void TileSorter::run_load() {
  for (std::uint32_t b = 0; b < config_.sorting.list_buffers; ++b) free_lists_.push(b, load_);
  for (TileMark mark = TileMark::kTile; mark != TileMark::kEndOfFrame;) {
    requests->push({}, load_);
    const TileJob job = jobs->pop(load_);
    mark = job.mark;
    Loaded end;
    end.tile = job.tile;
    end.set = set_ = job.set;
    if (mark == TileMark::kTile) {
      load_.takes_up_tile(job.tile);
      ++counters_.tiles;
      next_block_ = 0;
      Chain list;
      list.region = job_.lists_of(job.set);
      list.block = job.first_block;
      list.entries = job.entries;
      load(job.tile, list, 0);
      end.mark = EntryMark::kEndOfTile;
    } else {
      end.mark = mark == TileMark::kEndOfPass ? EntryMark::kEndOfPass : EntryMark::kEndOfFrame;
    }
    load_.work(1);
    loaded_.push(end, load_);
  }
  load_.idles();
}

// A list of one key is in order, however long.
void TileSorter::load(std::uint32_t tile, const Chain& list, std::uint32_t level) {
  if (list.entries == 0) return;
  if (finished_.finished(tile)) {
    counters_.dropped_unread += list.entries;
    return;
  }
  const bool in_order = list.ranged && list.keys.single();
  if (list.entries > config_.sorting.list_entries && !in_order) {
    split_in_memory(tile, list, level);
    return;
  }
  std::vector<TileEntry> held;
  KeyRange keys;
  free_lists_.pop(load_, WaitFor::kRoom);
  bool open = true;
  const auto hand_on = [&] {
    load_on_chip(tile, held, keys);
    held.clear();
    keys = {};
    open = false;
  };
  read_chain(list, [&](std::vector<TileEntry>& entries) {
    for (auto next = entries.begin(); next != entries.end();) {
      if (!open) {
        free_lists_.pop(load_, WaitFor::kRoom);
        open = true;
      }
      const auto end =
          next + std::min<std::ptrdiff_t>(
                     entries.end() - next,
                     config_.sorting.list_entries - static_cast<std::ptrdiff_t>(held.size()));
      load_.work(static_cast<std::uint64_t>(end - next));
      for (; next != end; ++next) {
        held.push_back(*next);
        keys.take(next->key);
      }
      if (held.size() == config_.sorting.list_entries) hand_on();
    }
    counters_.entries_loaded += entries.size();
  });
  if (open) hand_on();
}

void TileSorter::load_on_chip(std::uint32_t tile, const std::vector<TileEntry>& entries,
                              const KeyRange& keys) {
  loaded_.push({EntryMark::kEntry, tile, entries, keys, set_}, load_);
}

TileSorter::Block TileSorter::ask_for(const Chain& list, std::uint32_t block, std::uint32_t entries,
                                      std::size_t stage) {
  Block asked;
  asked.entries = std::min(entries, blocks_.block_entries());
  const std::uint32_t bytes = blocks_.used_bytes(asked.entries);
  const std::uint32_t head = std::min(bytes, blocks_.line_bytes);
  const std::uint64_t at = list.region.base + std::uint64_t{block} * blocks_.block_bytes();
  std::byte* into = stages_.data() + stage * blocks_.block_bytes();
  load_.work(1);
  asked.head = start_read(memory, load_, at, into, head, list.region.region);
  asked.rest = asked.head;
  if (bytes > head) {
    asked.rest =
        start_read(memory, load_, at + head, into + head, bytes - head, list.region.region);
  }
  counters_.stage_words += cycles_for(bytes, kPortBytes);
  return asked;
}

void TileSorter::read_chain(const Chain& list,
                            const std::function<void(std::vector<TileEntry>&)>& take) {
  std::uint32_t unasked = list.entries;
  std::size_t stage = 0;
  Block next = ask_for(list, list.block, unasked, stage);
  unasked -= next.entries;
  std::vector<TileEntry> entries;
  while (next.entries > 0) {
    const Block block = next;
    const std::byte* bytes = stages_.data() + stage * blocks_.block_bytes();
    await(memory, load_, block.head);
    next = {};
    if (unasked > 0) {
      std::uint32_t link;
      std::memcpy(&link, bytes, sizeof link);
      stage = (stage + 1) % kStageBlocks;
      next = ask_for(list, link, unasked, stage);
      unasked -= next.entries;
    }
    await(memory, load_, block.rest);
    entries.clear();
    for (std::uint32_t e = 0; e < block.entries; ++e) {
      entries.push_back(decode_entry(blocks_.entry, bytes + blocks_.offset(e)));
    }
    counters_.entries_read += entries.size();
    counters_.keys_compared += entries.size();
    take(entries);
  }
}

// Into 8 chains on the stack; when all are read its blocks are free again.
void TileSorter::split_in_memory(std::uint32_t tile, const Chain& list, std::uint32_t level) {
  const std::uint32_t mark = next_block_;
  std::array<Chain, kSubsets> subsets;
  std::array<ListEnd, kSubsets> ends{};
  std::vector<LineBuffer> lines(kSubsets, LineBuffer(blocks_.line_bytes));
  Pivots pivots{};
  bool chosen = level > 0 && list.ranged;
  if (chosen) {
    pivots = ranged_pivots(list.keys);
    load_.work(kPivotCycles);
  }
  ++counters_.lists_split;
  read_chain(list, [&](std::vector<TileEntry>& entries) {
    if (!chosen) {
      pivots = sampled_pivots(entries, entries.size());
      load_.work(kPivotCycles);
      counters_.pivots_sampled += kPivots;
    }
    chosen = true;
    load_.work(kSubsetWriteCycles);
    for (const TileEntry& entry : entries) {
      const std::uint32_t s = subset_of(pivots, entry.key);
      subsets[s].keys.take(entry.key);
      load_.work(1);
      put_subset(entry, ends[s], lines[s], subsets[s].block);
    }
    counters_.entries_split += entries.size();
  });
  for (LineBuffer& line : lines) {
    if (line.holds_new()) flush(line);
  }
  await_all(memory, load_);
  for (std::size_t s = 0; s < kSubsets; ++s) {
    subsets[s].region = stack_;
    subsets[s].entries = ends[s].entries;
    subsets[s].ranged = true;
    load(tile, subsets[s], level + 1);
  }
  next_block_ = mark;
}

void TileSorter::put_subset(const TileEntry& entry, ListEnd& end, LineBuffer& line,
                            std::uint32_t& first) {
  if (end.entries % blocks_.block_entries() == 0) {
    end.block = end.entries == 0 ? next_block_++ : end.next;
    if (end.entries == 0) first = end.block;
    end.next = next_block_++;
  }
  const EntryPlace place = place_of(blocks_, end.block, end.entries);
  if (place.begins_line) line.begin(place.line, 0);
  counters_.line_writes += put_entry(blocks_, place, entry, end.next, line);
  ++end.entries;
  if (place.ends_line) flush(line);
}

void TileSorter::flush(LineBuffer& line) {
  const std::uint64_t at = line.address(blocks_.line_bytes);
  counters_.line_reads +=
      line_words(static_cast<std::uint32_t>(at % blocks_.line_bytes), line.new_byte_count());
  start_write(memory, load_, stack_.base + at, line.new_bytes(), line.new_byte_count(),
              stack_.region);
  line.written();
}

}  // namespace sgs::gscore
