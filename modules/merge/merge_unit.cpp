// The thread of the merge unit.
#include "modules/merge/merge_unit.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace sgs {
namespace {

// Heap order: the nearest key on top. Slots stand in for file indices until a tie asks for them.
bool behind(const FineCandidate& a, const FineCandidate& b) {
  return a.depth > b.depth || (a.depth == b.depth && a.slot > b.slot);
}

bool final_order(const PendingKey& a, const PendingKey& b) {
  return a.candidate.depth < b.candidate.depth ||
         (a.candidate.depth == b.candidate.depth && a.index < b.index);
}

}  // namespace

void MergeUnit::KeyCodec::encode(const PendingKey& key, std::byte* out) const {
  const FineCandidate& c = key.candidate;
  const float words[5] = {c.depth, c.mean_x, c.mean_y, c.mean_z, c.scale_max};
  std::memcpy(out, words, sizeof words);
  std::memcpy(out + 20, &c.slot, 4);
  std::memcpy(out + 24, &key.index, 4);
}

PendingKey MergeUnit::KeyCodec::decode(const std::byte* bytes) const {
  float words[5];
  std::memcpy(words, bytes, sizeof words);
  PendingKey key;
  key.candidate.group = group;
  key.candidate.depth = words[0];
  key.candidate.mean_x = words[1];
  key.candidate.mean_y = words[2];
  key.candidate.mean_z = words[3];
  key.candidate.scale_max = words[4];
  std::memcpy(&key.candidate.slot, bytes + 20, 4);
  std::memcpy(&key.index, bytes + 24, 4);
  return key;
}

MergeUnit::MergeUnit(const sc_core::sc_module_name& name, const MergeConfig& config,
                     const ClockDomain& clock, const FrameJob& job, const SaturationBoard& board,
                     MemoryPort& port, std::vector<TimedFifo<FineCandidate>*> sorted,
                     std::vector<TimedFifo<FineCandidate>*> released, std::uint64_t spill_base,
                     std::uint64_t spill_bytes)
    : sc_module(name),
      config_(config),
      job_(job),
      board_(board),
      port_(port),
      sorted_(std::move(sorted)),
      released_(std::move(released)),
      spill_base_(spill_base),
      spill_half_(spill_bytes / 2),
      activity_(this->name(), clock) {
  SC_THREAD(run);
}

void MergeUnit::run() {
  for (std::uint32_t visit = 0;; ++visit) {
    TimedFifo<FineCandidate>& input = *sorted_[visit % sorted_.size()];
    FineCandidate key = input.pop(activity_);
    group_ = key.group;
    while (key.mark == Mark::kNone) {
      insert(key);
      key = input.pop(activity_);
    }
    group_ = key.group;
    if (board_.saturated(group_)) drop_all();
    if (key.mark == Mark::kEndOfGroup) {
      end_group(key);
    } else {
      release_below(key.release_below);
    }
  }
}

void MergeUnit::insert(const FineCandidate& key) {
  activity_.work(1);
  ++counters_.keys;
  if (config_.on_overflow == OnOverflow::kSpill && pending_.size() >= config_.entries) {
    spill_farthest();
  }
  pending_.push_back(key);
  std::push_heap(pending_.begin(), pending_.end(), behind);
  pending_count_ = static_cast<std::uint32_t>(pending_.size());
  counters_.pending_max = std::max<std::uint64_t>(counters_.pending_max, pending_.size());
}

// Releases every key nearer than `nearest`; with blend_early also the nearest of those that are
// more than the buffer is meant to hold between two visits.
void MergeUnit::release_below(float nearest) {
  while (!board_.saturated(group_)) {
    const RunReader* run = nearest_run();
    float depth =
        run != nullptr ? run->front().candidate.depth : std::numeric_limits<float>::infinity();
    if (!pending_.empty()) depth = std::min(depth, pending_.front().depth);
    if ((pending_.empty() && run == nullptr) || !(depth < nearest)) break;
    release_depth(depth);
  }
  if (config_.on_overflow == OnOverflow::kBlendEarly) {
    while (pending_.size() > config_.entries && !board_.saturated(group_)) {
      // One at a time: the others of the same depth may stay.
      std::vector<PendingKey> tied = take_nearest(pending_.front().depth);
      emit(tied.front());
      ++counters_.forced_early;
      for (std::size_t i = 1; i < tied.size(); ++i) {
        pending_.push_back(tied[i].candidate);
        std::push_heap(pending_.begin(), pending_.end(), behind);
      }
    }
  }
}

// Releases all keys of one depth, which is the nearest: in the order of the file.
void MergeUnit::release_depth(float depth) {
  std::vector<PendingKey> here = take_nearest(depth);
  const auto run_at_depth = [&]() -> RunReader* {
    RunReader* run = nearest_run();
    return run != nullptr && run->front().candidate.depth == depth ? run : nullptr;
  };
  if (here.size() == 1 && run_at_depth() != nullptr) look_up(here);
  std::size_t next = 0;
  while (true) {
    RunReader* run = run_at_depth();
    if (next == here.size() && run == nullptr) return;
    if (run == nullptr || (next < here.size() && here[next].index < run->front().index)) {
      emit(here[next++]);
    } else {
      emit(run->front());
      run->pop();
      if (run->exhausted()) {
        runs_.erase(std::find_if(runs_.begin(), runs_.end(),
                                 [](const RunReader& r) { return r.exhausted(); }));
      }
    }
  }
}

// The waiting keys of the nearest depth, on chip, in final order.
std::vector<PendingKey> MergeUnit::take_nearest(float depth) {
  std::vector<PendingKey> keys;
  while (!pending_.empty() && pending_.front().depth == depth) {
    std::pop_heap(pending_.begin(), pending_.end(), behind);
    keys.push_back({pending_.back(), 0});
    pending_.pop_back();
  }
  if (keys.size() > 1) look_up(keys);
  return keys;
}

// Fetches the file indices of keys and sorts by (depth, index).
void MergeUnit::look_up(std::vector<PendingKey>& keys) {
  for (PendingKey& key : keys) {
    start_read(port_, activity_, job_.layout.index_address(key.candidate.slot), &key.index,
               sizeof key.index, region_id(Region::kIndices));
  }
  await_all(port_, activity_);
  counters_.ties += keys.size();
  std::sort(keys.begin(), keys.end(), final_order);
}

void MergeUnit::emit(const PendingKey& key) {
  if (board_.saturated(group_)) {
    ++counters_.dropped_saturated;
    return;
  }
  activity_.work(1);
  pending_count_ = static_cast<std::uint32_t>(pending_.size());
  released_[sequence_ % released_.size()]->push(key.candidate, activity_);
  ++sequence_;
  ++counters_.released;
}

void MergeUnit::end_group(const FineCandidate& end) {
  release_below(std::numeric_limits<float>::infinity());
  drop_all();
  activity_.work(1);
  released_[sequence_ % released_.size()]->push(end, activity_);
  ++sequence_;
}

// The farthest half of the keys on chip becomes a sorted run in DRAM.
void MergeUnit::spill_farthest() {
  if (runs_.size() == config_.spill_runs) merge_spilled_runs();
  const auto middle = pending_.begin() + static_cast<std::ptrdiff_t>(pending_.size() / 2);
  std::nth_element(pending_.begin(), middle, pending_.end(),
                   [](const FineCandidate& a, const FineCandidate& b) { return behind(b, a); });
  std::vector<PendingKey> far;
  for (auto it = middle; it != pending_.end(); ++it) far.push_back({*it, 0});
  pending_.erase(middle, pending_.end());
  std::make_heap(pending_.begin(), pending_.end(), behind);
  look_up(far);
  const SpillPort to{port_, activity_, config_.spill_block_entries};
  SpillWriter<KeyCodec> writer(to, spill_base_ + spill_area_ * spill_half_ + spill_used_,
                               KeyCodec{group_});
  for (const PendingKey& key : far) {
    activity_.work(1);
    writer.append(key);
  }
  const SpillRun run = writer.finish();
  spill_used_ += run.entries * kSpilledKeyBytes;
  ++counters_.runs_spilled;
  counters_.keys_spilled += run.entries;
  await_all(port_, activity_);  // written before it is read
  runs_.emplace_back(to, run, KeyCodec{group_});
}

// All runs become one, in the other half of the spill area.
void MergeUnit::merge_spilled_runs() {
  spill_area_ ^= 1U;
  const SpillPort to{port_, activity_, config_.spill_block_entries};
  SpillWriter<KeyCodec> writer(to, spill_base_ + spill_area_ * spill_half_, KeyCodec{group_});
  for (RunReader* run = nearest_run(); run != nullptr; run = nearest_run()) {
    activity_.work(1);
    writer.append(run->front());
    run->pop();
    if (run->exhausted()) {
      runs_.erase(std::find_if(runs_.begin(), runs_.end(),
                               [](const RunReader& r) { return r.exhausted(); }));
    }
  }
  const SpillRun merged = writer.finish();
  spill_used_ = merged.entries * kSpilledKeyBytes;
  counters_.keys_spilled += merged.entries;
  await_all(port_, activity_);
  runs_.emplace_back(to, merged, KeyCodec{group_});
}

MergeUnit::RunReader* MergeUnit::nearest_run() {
  RunReader* nearest = nullptr;
  for (RunReader& run : runs_) {
    if (nearest == nullptr || final_order(run.front(), nearest->front())) nearest = &run;
  }
  return nearest;
}

// The group is finished, or done with: nothing that still waits is needed.
void MergeUnit::drop_all() {
  counters_.dropped_saturated += pending_.size();
  pending_.clear();
  pending_count_ = 0;
  if (!runs_.empty()) await_all(port_, activity_);  // blocks that are still on their way
  runs_.clear();
  spill_used_ = 0;
}

void MergeUnit::trace(sc_core::sc_trace_file* file) const {
  activity_.trace(file);
  sc_core::sc_trace(file, group_, std::string(name()) + ".group");
  sc_core::sc_trace(file, pending_count_, std::string(name()) + ".pending");
}

}  // namespace sgs
