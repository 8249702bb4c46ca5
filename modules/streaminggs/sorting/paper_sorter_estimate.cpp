// Lists, and runs of them that are written and read back.
#include "modules/streaminggs/sorting/paper_sorter_estimate.h"

#include "algorithm/memory/splat_record.h"

namespace sgs {

PaperSorterEstimate::PaperSorterEstimate(const PaperSorterConfig& config,
                                         const PaperSorterPlace& place, const PortEstimate& port)
    : config_(config), place_(place), port_(port) {}

void PaperSorterEstimate::take_mark(FifoTimes& splats) {
  now_ = splats.pop(now_);
  work_for(1);
}

void PaperSorterEstimate::take(std::uint32_t splat, FifoTimes& splats,
                               std::uint64_t finished_from) {
  now_ = splats.pop(now_);
  work_for(1);
  ++received_;
  if (buffer_.size() == config_.buffer_entries) {
    if (finished_from <= now_) return;
    sort_buffer();
    spill_buffer();
  }
  buffer_.push_back(splat);
}

void PaperSorterEstimate::end_list() {
  PaperSorter::Counters& counters = work_.counters;
  ++counters.visits;
  counters.visits_trivial += received_ == 1 ? 1 : 0;
  counters.splats += received_;
  counters.list_max = std::max(counters.list_max, received_);
}

void PaperSorterEstimate::clear() {
  received_ = emitted_ = spill_used_ = 0;
  buffer_.clear();
  runs_.clear();
}

void PaperSorterEstimate::sort_buffer() {
  std::sort(buffer_.begin(), buffer_.end());
  const SortingCost cost = sort_cost(config_, buffer_.size(), place_.lists_of_network);
  work_for(cost.cycles);
  work_.counters.compare_exchanges += cost.compare_exchanges;
  work_.counters.moves += cost.moves;
}

void PaperSorterEstimate::spill_buffer() {
  if (buffer_.empty()) return;
  runs_.push_back({{}, place_.spill.base + spill_used_});
  Run& run = runs_.back();
  for (const std::uint32_t splat : buffer_) {
    work_for(1);
    append(run, splat);
  }
  flush(run);
  spill_used_ += run.splats.size() * kSplatEntryBytes;
  ++work_.counters.runs_spilled;
  work_.counters.entries_spilled += buffer_.size();
  buffer_.clear();
}

// A block goes when it is full; what is left of the last one at the end of the run.
void PaperSorterEstimate::append(Run& run, std::uint32_t splat) {
  run.splats.push_back(splat);
  if (run.splats.size() - run.written == config_.spill_block_entries) flush(run);
}

void PaperSorterEstimate::flush(Run& run) {
  const std::size_t count = run.splats.size() - run.written;
  if (count == 0) return;
  now_ = port_
             .write(now_, run.address + run.written * kSplatEntryBytes,
                    static_cast<std::uint32_t>(count * kSplatEntryBytes), place_.spill.region)
             .sent;
  run.written = run.splats.size();
}

std::vector<PaperSorterEstimate::Run> PaperSorterEstimate::merge_pass(
    const std::vector<Run>& open, std::size_t fan_in, std::uint32_t pass,
    const std::uint64_t& finished_from) {
  std::vector<Run> longer;
  std::uint64_t used = 0;
  for (std::size_t at = 0; at < open.size(); at += fan_in) {
    Run run{{}, place_.spill.base + pass % 2 * (place_.spill.bytes / 2) + used};
    merge(&open[at], std::min(fan_in, open.size() - at), finished_from,
          [&](std::uint32_t splat) { append(run, splat); });
    flush(run);
    used += run.splats.size() * kSplatEntryBytes;
    work_.counters.entries_spilled += run.splats.size();
    longer.push_back(std::move(run));
  }
  return longer;
}

std::vector<PaperSorterEstimate::Reader> PaperSorterEstimate::begin_merge(const Run* runs,
                                                                          std::size_t count) {
  await_all();
  std::vector<Reader> readers;
  for (std::size_t r = 0; r < count; ++r) {
    if (runs[r].splats.empty()) continue;
    Reader reader{&runs[r]};
    request(reader, 0);
    request(reader, 1);
    load(reader);
    readers.push_back(reader);
  }
  return readers;
}

void PaperSorterEstimate::request(Reader& reader, std::uint32_t block) {
  const std::size_t count = std::min<std::size_t>(config_.spill_block_entries,
                                                  reader.run->splats.size() - reader.requested);
  if (count == 0) return;
  const PortEstimate::Access access =
      port_.read(now_, reader.run->address + reader.requested * kSplatEntryBytes,
                 static_cast<std::uint32_t>(count * kSplatEntryBytes), place_.spill.region);
  now_ = access.sent;
  reader.answered[block] = access.answered;
  reader.requested += count;
}

void PaperSorterEstimate::load(const Reader& reader) {
  now_ = std::max(now_, reader.answered[reader.current]);
}

void PaperSorterEstimate::pop(Reader& reader) {
  ++reader.taken;
  if (reader.exhausted()) return;
  if (reader.taken % config_.spill_block_entries == 0) {
    request(reader, reader.current);
    reader.current ^= 1U;
  }
  load(reader);
}

void PaperSorterEstimate::count_merged(std::size_t runs) {
  const std::uint32_t levels = merge_levels(runs);
  work_.counters.compare_exchanges += std::uint64_t{levels} * kMergeStages;
  work_.counters.moves += levels;
}

PaperSorter::Work PaperSorterEstimate::work() const {
  PaperSorter::Work work = work_;
  work.traffic = port_.traffic();
  return work;
}

}  // namespace sgs
