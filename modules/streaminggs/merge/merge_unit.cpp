// The thread of the merge unit.
#include "modules/streaminggs/merge/merge_unit.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace sgs {

std::uint32_t MergeUnit::heap_entries(const MergeConfig& config, const BuiltFor& built_for) {
  const bool spills = config.on_overflow == OnOverflow::kSpill;
  return config.entries + (spills ? 0 : built_for.chunk_gaussians);
}

void MergeUnit::KeyCodec::encode(const FineCandidate& key, std::byte* out) const {
  const float words[4] = {key.depth, key.mean_x, key.mean_y, key.mean_z};
  std::memcpy(out, words, sizeof words);
  std::memcpy(out + 16, key.carried.data(), sizeof key.carried);
  const std::uint32_t slot = key.slot | (key.parts - 1) << kSlotBits;
  std::memcpy(out + 24, &slot, sizeof slot);
  std::memcpy(out + 28, &key.reach, sizeof key.reach);
}

FineCandidate MergeUnit::KeyCodec::decode(const std::byte* bytes) const {
  float words[4];
  std::memcpy(words, bytes, sizeof words);
  FineCandidate key;
  key.group = group;
  key.depth = words[0];
  key.mean_x = words[1];
  key.mean_y = words[2];
  key.mean_z = words[3];
  std::memcpy(key.carried.data(), bytes + 16, sizeof key.carried);
  std::uint32_t slot = 0;
  std::memcpy(&slot, bytes + 24, sizeof slot);
  key.slot = slot & ((1U << kSlotBits) - 1);
  key.parts = (slot >> kSlotBits) + 1;
  std::memcpy(&key.reach, bytes + 28, sizeof key.reach);
  return key;
}

MergeUnit::MergeUnit(const sc_core::sc_module_name& name, const MergeConfig& config,
                     const RegionSpan& spill, const UnitContext& context)
    : sc_module(name),
      memory("memory", context.built_for.memory_port, context.clock.period()),
      config_(config),
      built_for_(context.built_for),
      spill_(spill),
      merge_("merge", context.clock),
      pending_(heap_entries(config, context.built_for)) {
  SC_THREAD(run);
}

void MergeUnit::run() {
  for (std::uint32_t visit = 0;; ++visit) {
    FifoReadIf<FineCandidate>& input = in_turn(sorted, visit);
    FineCandidate key = input.pop(merge_);
    group_ = key.group;
    take_up_group(merge_, memory, group_, visit);
    while (key.mark == Mark::kNone) {
      take(key);
      key = input.pop(merge_);
    }
    group_ = key.group;
    merge_.work(1);
    if (all_finished(finished, group_)) drop_all();
    if (key.mark == Mark::kEndOfGroup) {
      end_group(key);
    } else {
      release_below(key.release_below);
      if (config_.on_overflow == OnOverflow::kBlendEarly) force_out();
    }
  }
}

void MergeUnit::take(const FineCandidate& key) {
  ++counters_.keys;
  if (all_finished(finished, group_)) {
    ++counters_.dropped_saturated;
    merge_.work(1);
    return;
  }
  if (pending_.full()) spill_farthest();
  wait_for_heap();
  pending_.insert(key);
  note_pending();
  counters_.pending_keys_max.raise_to(pending_.size());
  merge_.work(1);
}

// Releases every key nearer than `nearest`, from the chip and from the runs.
void MergeUnit::release_below(float nearest) {
  while (!all_finished(finished, group_)) {
    RunReader* run = nearest_of(runs_);
    const bool from_run =
        run != nullptr && (pending_.empty() || NearerKey{}(run->front(), pending_.min()));
    if (!from_run && pending_.empty()) return;
    if (!((from_run ? run->front() : pending_.min()).depth < nearest)) return;
    if (!from_run) {
      emit(take_nearest());
      continue;
    }
    merge_.work(1);
    emit(run->front());
    take_front(*run, runs_);
  }
}

// blend_early: the nearest keys go before they are final, until the buffer holds no more than it is
// meant to between two visits.
void MergeUnit::force_out() {
  while (pending_.size() > config_.entries && !all_finished(finished, group_)) {
    emit(take_nearest());
    ++counters_.forced_early;
  }
}

// Waits until the heap's last operation has left the root far enough behind; begins this cycle's
// then.
void MergeUnit::wait_for_heap() {
  const std::uint64_t now = merge_.clock().now_cycles();
  if (now < heap_free_) merge_.work(heap_free_ - now);
  heap_free_ = std::max(now, heap_free_) + config_.cycles_per_operation;
}

FineCandidate MergeUnit::take_nearest() {
  wait_for_heap();
  const FineCandidate key = pending_.delete_min();
  note_pending();
  merge_.work(1);
  return key;
}

// The look-up runs beside the heap's operation, which takes as long.
void MergeUnit::emit(const FineCandidate& key) {
  ++counters_.due;
  FineCandidate due = key;
  due.parts &= unfinished_eyes(masks, key.group, key.reach);
  if (due.parts == 0) {
    ++counters_.dropped_hidden;
    return;
  }
  counters_.ties += key.depth == last_depth_ ? 1 : 0;
  last_depth_ = key.depth;
  in_turn(released, sequence_).push(due, merge_);
  ++sequence_;
  ++counters_.released;
}

void MergeUnit::end_group(const FineCandidate& end) {
  release_below(std::numeric_limits<float>::infinity());
  drop_all();
  last_depth_ = -1;
  merge_.work(1);
  in_turn(released, sequence_).push(end, merge_);
  ++sequence_;
}

// The farthest keys on chip become a sorted run in DRAM. The farthest comes first: the run is
// written from its back.
void MergeUnit::spill_farthest() {
  if (runs_.size() == config_.spill_runs) merge_shortest_runs();
  const std::uint32_t eighths = std::min(4U, 1 + spills_ / config_.spill_runs);
  const std::uint64_t keys = std::max<std::uint64_t>(1, pending_.size() * eighths / 8);
  ++spills_;
  if (!fits_spill_area(keys)) merge_runs(runs_.end());
  const SpillPort to = spill_port();
  const SpillRun run{next_run_address(), keys};
  ReverseSpillWriter<KeyCodec> writer(to, run, KeyCodec{group_});
  for (std::uint64_t k = 0; k < keys; ++k) {
    wait_for_heap();
    const FineCandidate key = pending_.delete_max();
    note_pending();
    merge_.work(1);
    writer.append(key);
  }
  ++counters_.runs_spilled;
  keep_run(to, run);
}

// The shortest runs become one, up to the first that is more than twice as long as all before it
// together. Lengths then grow from run to run by a factor, and a key moves once a step: n keys cost
// about n log n, as long as there are not more steps than runs that can be open.
void MergeUnit::merge_shortest_runs() {
  runs_.sort([](const RunReader& a, const RunReader& b) { return a.left() < b.left(); });
  constexpr int kFewest = 2;
  auto end = runs_.begin();
  std::uint64_t keys = 0;
  for (int taken = 0; end != runs_.end() && (taken < kFewest || end->left() <= 2 * keys); ++taken) {
    keys += end->left();
    ++end;
  }
  merge_runs(fits_spill_area(keys) ? end : runs_.end());
}

// Merges the runs before `end` into one, which goes behind all others. When there are no others it
// goes to the other half of the spill area, which has room for all keys of a group.
void MergeUnit::merge_runs(std::list<RunReader>::iterator end) {
  if (end == runs_.end()) {
    spill_area_ ^= 1U;
    spill_used_ = 0;
  }
  std::list<RunReader> merging;
  merging.splice(merging.begin(), runs_, runs_.begin(), end);
  if (merging.empty()) return;
  const SpillPort to = spill_port();
  SpillWriter<KeyCodec> writer(to, next_run_address(), KeyCodec{group_});
  for (RunReader* run = nearest_of(merging); run != nullptr; run = nearest_of(merging)) {
    merge_.work(1);
    writer.append(run->front());
    take_front(*run, merging);
  }
  keep_run(to, writer.finish());
}

// Written before it is read.
void MergeUnit::keep_run(const SpillPort& to, const SpillRun& run) {
  spill_used_ += run.entries * KeyCodec::bytes();
  counters_.keys_spilled += run.entries;
  await_all(memory, merge_);
  runs_.emplace_back(to, run, KeyCodec{group_});
}

bool MergeUnit::fits_spill_area(std::uint64_t keys) const {
  return spill_used_ + keys * KeyCodec::bytes() <= spill_.bytes / 2;
}

void MergeUnit::take_front(RunReader& run, std::list<RunReader>& from) {
  run.pop();
  if (run.exhausted()) from.remove_if([&](const RunReader& r) { return &r == &run; });
}

MergeUnit::RunReader* MergeUnit::nearest_of(std::list<RunReader>& runs) {
  RunReader* nearest = nullptr;
  for (RunReader& run : runs) {
    if (nearest == nullptr || NearerKey{}(run.front(), nearest->front())) nearest = &run;
  }
  return nearest;
}

// The group is finished, or done with: nothing that still waits is needed. The heap is empty once
// its root says so, with the mark that is taken in this cycle.
void MergeUnit::drop_all() {
  counters_.dropped_saturated += pending_.size();
  for (const RunReader& run : runs_) counters_.dropped_saturated += run.left();
  pending_.clear();
  note_pending();
  if (!runs_.empty()) await_all(memory, merge_);  // blocks that are still on their way
  runs_.clear();
  spill_used_ = 0;
  spills_ = 0;
}

}  // namespace sgs
