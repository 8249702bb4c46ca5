// The thread of a sorting unit in paper order.
#include "modules/streaminggs/sorting/paper_sorter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <queue>

#include "modules/streaminggs/sorting/sorting_cost.h"

namespace sgs {
namespace {

constexpr const char* kSortBuffers = "sort buffers";

}  // namespace

// Entries of splats in a format.
struct PaperSorter::Codec {
  using Entry = PaperSorter::Entry;
  NumberFormat format;

  std::uint32_t bytes() const { return splat_entry_bytes(format); }
  void encode(const Entry& entry, std::byte* out) const {
    std::memcpy(out, entry.bytes.data(), bytes());
  }
  Entry decode(const std::byte* from) const {
    const Splat splat = decode_splat(format, from, {});
    Entry entry{splat.depth, splat.index, {}};
    std::memcpy(entry.bytes.data(), from, bytes());
    return entry;
  }
};

PaperSorter::PaperSorter(const sc_core::sc_module_name& name, const PaperSorterConfig& config,
                         const PaperSorterPlace& place, const UnitContext& context)
    : sc_module(name),
      memory("memory", context.built_for.memory_port, context.clock.period()),
      config_(config),
      built_for_(context.built_for),
      place_(place),
      job_(context.job),
      sort_("sort", context.clock) {
  buffer_.reserve(config.buffer_entries);
  SC_THREAD(run);
}

void PaperSorter::run() {
  FifoSelector<SplatToken> inputs(splats);
  for (visit_ = place_.first_visit;; visit_ += place_.visit_step) {
    SplatToken end = collect(inputs);
    if (!finished->finished(group_)) {
      sort_buffer();
      if (runs_.empty()) {
        for (const Entry& entry : buffer_) emit(entry);
      } else {
        spill_buffer();
        merge_runs();
      }
    }
    counters_.splats_saturated += received_ - emitted_;
    buffer_.clear();
    runs_.clear();
    spill_used_ = 0;
    sort_.work(1);
    sorted->push(end, sort_);
  }
}

// Takes the visit's splats from all HFUs; returns the mark with which the visit ends.
SplatToken PaperSorter::collect(FifoSelector<SplatToken>& inputs) {
  const int count = splats.size();
  std::vector<bool> ended(static_cast<std::size_t>(count), false);
  received_ = 0;
  emitted_ = 0;
  SplatToken end;
  for (int open = count; open > 0;) {
    const int from =
        inputs.select(sort_, [&](int i) { return !ended[static_cast<std::size_t>(i)]; });
    const SplatToken token = splats[from]->pop(sort_);
    group_ = token.group;
    take_up_group(sort_, memory, group_, visit_);
    if (token.visit != visit_) {
      SC_REPORT_ERROR("/sgs/sorting", fmt::format("{}: a splat of visit {} while sorting visit {}",
                                                  name(), token.visit, visit_)
                                          .c_str());
    }
    if (token.mark != Mark::kNone) {
      sort_.work(1);
      ended[static_cast<std::size_t>(from)] = true;
      end = token;
      --open;
    } else {
      accept(token);
      ++received_;
    }
  }
  ++counters_.visits;
  counters_.visits_trivial += received_ == 1 ? 1 : 0;
  counters_.splats += received_;
  counters_.list_max.raise_to(received_);
  return end;
}

void PaperSorter::accept(const SplatToken& token) {
  sort_.work(1);
  if (buffer_.size() == config_.buffer_entries) {
    if (finished->finished(group_)) return;
    sort_buffer();
    spill_buffer();
  }
  Entry entry{token.splat.depth, token.splat.index, {}};
  encode_splat(built_for_.splats, token.splat, group_subtiles(), entry.bytes.data());
  buffer_.push_back(entry);
}

void PaperSorter::sort_buffer() {
  std::sort(buffer_.begin(), buffer_.end(), in_front);
  const SortingCost cost = sort_cost(config_, buffer_.size(), place_.lists_of_network);
  sort_.work(cost.cycles);
  counters_.compare_exchanges += cost.compare_exchanges;
  counters_.moves += cost.moves;
}

void PaperSorter::spill_buffer() {
  if (buffer_.empty()) return;
  SpillWriter<Codec> writer(spill_port(), place_.spill.base + spill_used_,
                            Codec{built_for_.splats});
  for (const Entry& entry : buffer_) {
    sort_.work(1);
    writer.append(entry);
  }
  runs_.push_back(writer.finish());
  spill_used_ += runs_.back().entries * entry_bytes();
  ++counters_.runs_spilled;
  counters_.entries_spilled += buffer_.size();
  buffer_.clear();
}

// While there are more runs than block buffers, the oldest are merged into one longer run, in turns
// between the two halves of the spill area; the last merge goes to rendering.
void PaperSorter::merge_runs() {
  const std::size_t fan_in =
      std::max(2U, config_.buffer_entries / (2 * config_.spill_block_entries));
  std::deque<SpillRun> open(runs_.begin(), runs_.end());
  const std::uint64_t half = place_.spill.bytes / 2;
  for (std::uint32_t pass = 1; open.size() > fan_in; ++pass) {
    std::deque<SpillRun> longer;
    std::uint64_t used = 0;
    for (std::size_t at = 0; at < open.size(); at += fan_in) {
      const std::vector<SpillRun> group(
          open.begin() + static_cast<std::ptrdiff_t>(at),
          open.begin() + static_cast<std::ptrdiff_t>(std::min(at + fan_in, open.size())));
      SpillWriter<Codec> writer(spill_port(), place_.spill.base + pass % 2 * half + used,
                                Codec{built_for_.splats});
      merge(group.data(), group.size(), [&](const Entry& entry) { writer.append(entry); });
      longer.push_back(writer.finish());
      used += longer.back().entries * entry_bytes();
      counters_.entries_spilled += longer.back().entries;
    }
    open = std::move(longer);
  }
  const std::vector<SpillRun> last(open.begin(), open.end());
  merge(last.data(), last.size(), [&](const Entry& entry) { emit(entry); });
}

// Merges runs through the network: each entry passes the levels of a binary tree, kMergeWidth
// entries at a time.
template <class Sink>
void PaperSorter::merge(const SpillRun* runs, std::size_t count, Sink&& sink) {
  await_all(memory, sort_);  // the runs have been written
  std::deque<SpillReader<Codec>> readers;
  for (std::size_t i = 0; i < count; ++i) {
    readers.emplace_back(spill_port(), runs[i], Codec{built_for_.splats});
  }
  const auto behind = [&](std::size_t a, std::size_t b) {
    return in_front(readers[b].front(), readers[a].front());
  };
  std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(behind)> heads(behind);
  for (std::size_t i = 0; i < count; ++i) heads.push(i);
  const std::uint32_t levels = merge_levels(count);
  const std::uint64_t cycles = merge_tree_cycles(config_, count, place_.lists_of_network);
  std::uint64_t owed = 0;  // merge cycles, in units of 1/kMergeWidth
  while (!heads.empty() && !finished->finished(group_)) {
    const std::size_t nearest = heads.top();
    heads.pop();
    owed += cycles;
    sort_.work(owed / kMergeWidth);
    owed %= kMergeWidth;
    counters_.compare_exchanges += std::uint64_t{levels} * kMergeStages;
    counters_.moves += levels;
    sink(readers[nearest].front());
    readers[nearest].pop();
    if (!readers[nearest].exhausted()) heads.push(nearest);
  }
  await_all(memory, sort_);  // blocks asked for and no longer wanted
}

void PaperSorter::emit(const Entry& entry) {
  sort_.work(1);
  SplatToken token;
  token.splat = decode_splat(built_for_.splats, entry.bytes.data(), group_subtiles());
  token.group = group_;
  token.visit = visit_;
  sorted->push(token, sort_);
  ++emitted_;
}

SubtileRect PaperSorter::group_subtiles() const {
  const PixelRect& pixels = job_.groups[group_];
  const auto subtile = [](int px) { return static_cast<std::uint16_t>(px / kSubtilePx); };
  return {subtile(pixels.x0), subtile(pixels.y0), subtile(pixels.x1 + kSubtilePx - 1),
          subtile(pixels.y1 + kSubtilePx - 1)};
}

// Runs that are read back lie in the sort buffer, which is empty then.
SramUses PaperSorter::sram_uses(const PaperSorterConfig& config, const BuiltFor& built_for) {
  const std::uint32_t entry_bytes = splat_entry_bytes(built_for.splats);
  const SramUse block = sram_use("spill blocks", kSharedSram,
                                 {{config.spill_block_entries, "splats"}, {entry_bytes, "B"}},
                                 {8 * entry_bytes}, kOneOfEach);
  const auto bytes = static_cast<std::uint32_t>(block.bytes);
  SramUses uses = sort_memories(kSortBuffers, kSharedSram, config.buffer_entries, entry_bytes);
  uses.insert(uses.end(),
              {block, outstanding_table(kSharedSram, built_for.memory_port),
               unanswered_writes("spill writes", kSharedSram, built_for.memory_port, bytes)});
  return uses;
}

void PaperSorter::publish(DataSheet& sheet) {
  sheet.unit(*this);
  sheet.activity(sort_, "sorting", "takes, sorts and hands on the splats of one visit");
  sheet.counters(counters_);
  publish_network(sheet, config_, config_.buffer_entries, counters_.compare_exchanges,
                  counters_.moves, place_.lists_of_network);
  publish_trivial_sorts(sheet, config_, counters_.visits_trivial);
  sheet.sram(sram_uses(config_, built_for_));
  // Entries spilled and read back came in and went out once more each.
  publish_sort_accesses(sheet, kSortBuffers, counters_.splats + counters_.entries_spilled,
                        counters_.moves);
  sheet.accesses("spill blocks", counters_.entries_spilled, counters_.entries_spilled);
  sheet.port(memory, "spill writes");
  sheet.remedy(sort_, "sorting_units");
  sheet.remedy(memory, WaitFor::kReads, "sorting.buffer_entries");
  sheet.remedy(memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.signal("group", group_);
  sheet.signal("visit", visit_);
}

}  // namespace sgs
