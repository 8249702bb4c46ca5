// The thread of a sorting unit.
#include "modules/sorting/sorting_unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <queue>

#include "algorithm/memory/splat_record.h"
#include "modules/sorting/sorting_cost.h"

namespace sgs {
namespace {

// Splats of one group.
struct SplatCodec {
  using Entry = Splat;
  static constexpr std::uint32_t kBytes = kSplatEntryBytes;
  SubtileRect group;
  void encode(const Splat& splat, std::byte* out) const { encode_splat(splat, group, out); }
  Splat decode(const std::byte* bytes) const { return decode_splat(bytes, group); }
};

}  // namespace

SortingUnit::SortingUnit(const sc_core::sc_module_name& name, const SortingConfig& config,
                         const Place& place, const ClockDomain& clock, const FrameJob& job,
                         const SaturationBoard& board, MemoryPort& port,
                         std::vector<TimedFifo<SplatToken>*> inputs, TimedFifo<SplatToken>& output)
    : sc_module(name),
      config_(config),
      place_(place),
      job_(job),
      board_(board),
      port_(port),
      inputs_(std::move(inputs)),
      output_(output),
      activity_(this->name(), clock) {
  buffer_.reserve(config.buffer_entries);
  SC_THREAD(run);
}

void SortingUnit::run() {
  for (visit_ = place_.first_visit;; visit_ += place_.visit_step) {
    SplatToken end = collect();
    if (!board_.saturated(group_)) {
      sort_buffer();
      if (runs_.empty()) {
        for (const Splat& splat : buffer_) emit(splat);
      } else {
        spill_buffer();
        merge_runs();
      }
    }
    counters_.splats_saturated += received_ - emitted_;
    buffer_.clear();
    runs_.clear();
    spill_used_ = 0;
    output_.push(end, activity_);
  }
}

// Takes the visit's splats from all HFUs; returns the mark with which the visit ends.
SplatToken SortingUnit::collect() {
  std::vector<bool> ended(inputs_.size(), false);
  received_ = 0;
  emitted_ = 0;
  SplatToken end;
  for (std::size_t open = inputs_.size(); open > 0;) {
    const std::size_t from = inputs_.select(activity_, [&](std::size_t i) { return !ended[i]; });
    const SplatToken token = inputs_.fifo(from).pop(activity_);
    group_ = token.group;
    if (token.visit != visit_) {
      SC_REPORT_ERROR("/sgs/sorting", fmt::format("{}: a splat of visit {} while sorting visit {}",
                                                  name(), token.visit, visit_)
                                          .c_str());
    }
    if (token.mark != Mark::kNone) {
      ended[from] = true;
      end = token;
      --open;
    } else {
      accept(token);
      ++received_;
    }
  }
  ++counters_.visits;
  counters_.visits_trivial += received_ < 2 ? 1 : 0;
  counters_.splats += received_;
  counters_.list_max = std::max(counters_.list_max, received_);
  return end;
}

void SortingUnit::accept(const SplatToken& token) {
  activity_.work(1);
  if (buffer_.size() == config_.buffer_entries) {
    if (board_.saturated(group_)) return;
    sort_buffer();
    spill_buffer();
  }
  buffer_.push_back(token.splat);
}

void SortingUnit::sort_buffer() {
  std::sort(buffer_.begin(), buffer_.end(), in_front);
  const SortingCost cost = sort_cost(config_, buffer_.size());
  activity_.work(cost.cycles);
  counters_.compare_exchanges += cost.compare_exchanges;
}

void SortingUnit::spill_buffer() {
  if (buffer_.empty()) return;
  SpillWriter<SplatCodec> writer({port_, activity_, config_.spill_block_entries},
                                 place_.spill_base + spill_used_, SplatCodec{group_subtiles()});
  for (const Splat& splat : buffer_) {
    activity_.work(1);
    writer.append(splat);
  }
  runs_.push_back(writer.finish());
  spill_used_ += runs_.back().entries * kSplatEntryBytes;
  ++counters_.runs_spilled;
  counters_.entries_spilled += buffer_.size();
  buffer_.clear();
}

// While there are more runs than block buffers, the oldest are merged into one longer run, in turns
// between the two halves of the spill area; the last merge goes to rendering.
void SortingUnit::merge_runs() {
  const std::size_t fan_in =
      std::max(2U, config_.buffer_entries / (2 * config_.spill_block_entries));
  std::deque<SpillRun> open(runs_.begin(), runs_.end());
  const std::uint64_t half = place_.spill_bytes / 2;
  for (std::uint32_t pass = 1; open.size() > fan_in; ++pass) {
    std::deque<SpillRun> longer;
    std::uint64_t used = 0;
    for (std::size_t at = 0; at < open.size(); at += fan_in) {
      const std::vector<SpillRun> group(
          open.begin() + static_cast<std::ptrdiff_t>(at),
          open.begin() + static_cast<std::ptrdiff_t>(std::min(at + fan_in, open.size())));
      SpillWriter<SplatCodec> writer({port_, activity_, config_.spill_block_entries},
                                     place_.spill_base + pass % 2 * half + used,
                                     SplatCodec{group_subtiles()});
      merge(group.data(), group.size(), [&](const Splat& splat) { writer.append(splat); });
      longer.push_back(writer.finish());
      used += longer.back().entries * kSplatEntryBytes;
      counters_.entries_spilled += longer.back().entries;
    }
    open = std::move(longer);
  }
  const std::vector<SpillRun> last(open.begin(), open.end());
  merge(last.data(), last.size(), [&](const Splat& splat) { emit(splat); });
}

// Merges runs through the network: each entry passes the levels of a binary tree, kMergeWidth
// entries at a time.
template <class Sink>
void SortingUnit::merge(const SpillRun* runs, std::size_t count, Sink&& sink) {
  await_all(port_, activity_);  // the runs have been written
  std::deque<SpillReader<SplatCodec>> readers;
  for (std::size_t i = 0; i < count; ++i) {
    readers.emplace_back(SpillPort{port_, activity_, config_.spill_block_entries}, runs[i],
                         SplatCodec{group_subtiles()});
  }
  const auto behind = [&](std::size_t a, std::size_t b) {
    return in_front(readers[b].front(), readers[a].front());
  };
  std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(behind)> heads(behind);
  for (std::size_t i = 0; i < count; ++i) heads.push(i);
  const std::uint32_t levels = merge_levels(count);
  std::uint64_t owed = 0;  // merge cycles, in units of 1/kMergeWidth
  while (!heads.empty() && !board_.saturated(group_)) {
    const std::size_t nearest = heads.top();
    heads.pop();
    owed += std::uint64_t{levels} * config_.merge_interval_cycles;
    activity_.work(owed / kMergeWidth);
    owed %= kMergeWidth;
    counters_.compare_exchanges += std::uint64_t{levels} * kMergeStages;
    sink(readers[nearest].front());
    readers[nearest].pop();
    if (!readers[nearest].exhausted()) heads.push(nearest);
  }
  await_all(port_, activity_);  // blocks asked for and no longer wanted
}

void SortingUnit::emit(const Splat& splat) {
  activity_.work(1);
  SplatToken token;
  token.splat = splat;
  token.group = group_;
  token.visit = visit_;
  output_.push(token, activity_);
  ++emitted_;
}

SubtileRect SortingUnit::group_subtiles() const {
  const PixelRect& pixels = job_.groups[group_];
  const auto subtile = [](int px) { return static_cast<std::uint16_t>(px / kSubtilePx); };
  return {subtile(pixels.x0), subtile(pixels.y0), subtile(pixels.x1 + kSubtilePx - 1),
          subtile(pixels.y1 + kSubtilePx - 1)};
}

void SortingUnit::trace(sc_core::sc_trace_file* file) const {
  activity_.trace(file);
  sc_core::sc_trace(file, group_, std::string(name()) + ".group");
  sc_core::sc_trace(file, visit_, std::string(name()) + ".visit");
}

}  // namespace sgs
