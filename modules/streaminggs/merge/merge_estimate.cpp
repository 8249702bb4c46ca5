// Keys in, keys out.
#include "modules/streaminggs/merge/merge_estimate.h"

#include <algorithm>
#include <utility>

namespace sgs {

MergeEstimate::MergeEstimate(const MergeConfig& config, std::uint32_t heap_entries,
                             const RegionSpan& spill, const PortEstimate& port)
    : config_(config), spill_(spill), port_(port), pending_(heap_entries) {}

void MergeEstimate::work_for(std::uint64_t cycles) {
  now_ += cycles;
  work_.merge_cycles += cycles;
}

void MergeEstimate::wait_for_heap() {
  const std::uint64_t now = now_;
  if (now < heap_free_) work_for(heap_free_ - now);
  heap_free_ = std::max(now, heap_free_) + config_.cycles_per_operation;
}

void MergeEstimate::take(const Key& key, FifoTimes& sorted, std::uint64_t finished_from) {
  now_ = sorted.pop(now_);
  ++work_.counters.keys;
  if (finished_from <= now_) {
    ++work_.counters.dropped_saturated;
    work_for(1);
    return;
  }
  if (pending_.full()) spill_farthest();
  wait_for_heap();
  pending_.insert(key);
  work_.counters.pending_max = std::max<std::uint64_t>(work_.counters.pending_max, pending_.size());
  work_for(1);
}

void MergeEstimate::take_mark(FifoTimes& sorted, std::uint64_t finished_from) {
  now_ = sorted.pop(now_);
  work_for(1);
  if (finished_from <= now_) drop_all();
}

MergeEstimate::Key MergeEstimate::take_nearest() {
  wait_for_heap();
  const Key key = pending_.delete_min();
  work_for(1);
  return key;
}

bool MergeEstimate::release(float nearest, std::uint64_t finished_from, Key& key) {
  if (finished_from <= now_) return false;
  Run* const run = nearest_run();
  const bool from_run = run != nullptr && (pending_.empty() || run->front() < pending_.min());
  if (!from_run && pending_.empty()) return false;
  if (!((from_run ? run->front() : pending_.min()).depth < nearest)) return false;
  if (from_run) {
    work_for(1);
    key = run->front();
    take_front(*run);
  } else {
    key = take_nearest();
  }
  return true;
}

bool MergeEstimate::force_out(std::uint64_t finished_from, Key& key) {
  const bool spills = config_.on_overflow == OnOverflow::kSpill;
  if (spills || pending_.size() <= config_.entries || finished_from <= now_) return false;
  key = take_nearest();
  ++work_.counters.forced_early;
  return true;
}

void MergeEstimate::spill_farthest() {
  if (runs_.size() == config_.spill_runs) merge_shortest_runs();
  const std::uint64_t count = keys_to_spill(config_, pending_.size(), spills_++);
  std::vector<Key> keys;
  for (std::uint64_t k = 0; k < count; ++k) {
    wait_for_heap();
    keys.push_back(pending_.delete_max());
    work_for(1);
  }
  std::reverse(keys.begin(), keys.end());
  keep(std::move(keys));
}

// As MergeUnit::merge_shortest_runs().
void MergeEstimate::merge_shortest_runs() {
  std::sort(runs_.begin(), runs_.end(),
            [](const Run& a, const Run& b) { return a.left() < b.left(); });
  constexpr std::size_t kFewest = 2;
  std::vector<Key> keys;
  std::size_t merged = 0;
  for (; merged < runs_.size(); ++merged) {
    const Run& run = runs_[merged];
    if (merged >= kFewest && run.left() > 2 * keys.size()) break;
    const auto bytes = static_cast<std::uint32_t>((run.keys.size() - run.requested) * kKeyBytes);
    if (bytes > 0) {
      now_ = port_.read(now_, run.address + run.requested * kKeyBytes, bytes, spill_.region).sent;
    }
    keys.insert(keys.end(), run.keys.begin() + static_cast<std::ptrdiff_t>(run.taken),
                run.keys.end());
  }
  runs_.erase(runs_.begin(), runs_.begin() + static_cast<std::ptrdiff_t>(merged));
  std::sort(keys.begin(), keys.end());
  work_for(keys.size());
  keep(std::move(keys));
}

// Written, and read from the front on.
void MergeEstimate::keep(std::vector<Key> keys) {
  Run run;
  run.address = spill_.base + spill_used_;
  const std::uint32_t block = config_.spill_block_entries;
  for (std::size_t k = 0; k < keys.size(); k += block) {
    const auto bytes =
        static_cast<std::uint32_t>(std::min<std::size_t>(block, keys.size() - k) * kKeyBytes);
    now_ = port_.write(now_, spill_.base + spill_used_, bytes, spill_.region).sent;
    spill_used_ = (spill_used_ + bytes) % std::max<std::uint64_t>(1, spill_.bytes / 2);
  }
  ++work_.counters.runs_spilled;
  work_.counters.keys_spilled += keys.size();
  run.keys = std::move(keys);
  now_ = std::max(now_, port_.all_answered());
  request(run);
  now_ = std::max(now_, port_.all_answered());
  request(run);
  runs_.push_back(std::move(run));
}

void MergeEstimate::request(Run& run) {
  const std::size_t count =
      std::min<std::size_t>(config_.spill_block_entries, run.keys.size() - run.requested);
  if (count == 0) return;
  now_ = port_
             .read(now_, run.address + run.requested * kKeyBytes,
                   static_cast<std::uint32_t>(count * kKeyBytes), spill_.region)
             .sent;
  run.requested += count;
}

MergeEstimate::Run* MergeEstimate::nearest_run() {
  Run* nearest = nullptr;
  for (Run& run : runs_) {
    if (nearest == nullptr || run.front() < nearest->front()) nearest = &run;
  }
  return nearest;
}

void MergeEstimate::take_front(Run& run) {
  ++run.taken;
  if (run.left() == 0) {
    runs_.erase(runs_.begin() + (&run - runs_.data()));
  } else if (run.taken % config_.spill_block_entries == 0) {
    request(run);
  }
}

void MergeEstimate::drop_all() {
  work_.counters.dropped_saturated += pending_.size();
  for (const Run& run : runs_) work_.counters.dropped_saturated += run.left();
  if (!runs_.empty()) now_ = std::max(now_, port_.all_answered());
  pending_.clear();
  runs_.clear();
  spill_used_ = 0;
  spills_ = 0;
}

MergeUnit::Work MergeEstimate::work() const {
  MergeUnit::Work work = work_;
  work.heap = pending_.work();
  work.traffic = port_.traffic();
  return work;
}

}  // namespace sgs
