// The thread of the merge unit.
#include "modules/streaminggs/merge/merge_unit.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>

namespace sgs {
namespace {

// Levels of a binary heap of so many entries.
std::uint32_t heap_levels(std::uint64_t entries) {
  std::uint32_t levels = 0;
  while ((std::uint64_t{1} << levels) < entries) ++levels;
  return levels;
}

bool final_order(const PendingKey& a, const PendingKey& b) {
  return a.candidate.depth < b.candidate.depth ||
         (a.candidate.depth == b.candidate.depth && a.index < b.index);
}

}  // namespace

void MergeUnit::KeyCodec::encode(const PendingKey& key, std::byte* out) const {
  const FineCandidate& c = key.candidate;
  const float words[4] = {c.depth, c.mean_x, c.mean_y, c.mean_z};
  std::memcpy(out, words, sizeof words);
  std::memcpy(out + 16, c.carried.data(), sizeof c.carried);
  std::memcpy(out + 24, &c.slot, 4);
  std::memcpy(out + 28, &key.index, 4);
}

PendingKey MergeUnit::KeyCodec::decode(const std::byte* bytes) const {
  float words[4];
  std::memcpy(words, bytes, sizeof words);
  PendingKey key;
  key.candidate.group = group;
  key.candidate.depth = words[0];
  key.candidate.mean_x = words[1];
  key.candidate.mean_y = words[2];
  key.candidate.mean_z = words[3];
  std::memcpy(key.candidate.carried.data(), bytes + 16, sizeof key.candidate.carried);
  std::memcpy(&key.candidate.slot, bytes + 24, 4);
  std::memcpy(&key.index, bytes + 28, 4);
  return key;
}

MergeUnit::MergeUnit(const sc_core::sc_module_name& name, const MergeConfig& config,
                     const RegionSpan& spill, const UnitContext& context)
    : sc_module(name),
      memory("memory", context.built_for.memory_port),
      config_(config),
      built_for_(context.built_for),
      job_(context.job),
      spill_(spill),
      merge_("merge", context.clock) {
  SC_THREAD(run);
}

void MergeUnit::run() {
  for (std::uint32_t visit = 0;; ++visit) {
    FifoReadIf<FineCandidate>& input = in_turn(sorted, visit);
    FineCandidate key = input.pop(merge_);
    group_ = key.group;
    while (key.mark == Mark::kNone) {
      insert(key);
      key = input.pop(merge_);
    }
    group_ = key.group;
    if (finished->finished(group_)) drop_all();
    ask_for_ties();
    if (key.mark == Mark::kEndOfGroup) {
      end_group(key);
    } else {
      release_below(key.release_below);
      if (config_.on_overflow == OnOverflow::kBlendEarly) force_out();
    }
  }
}

void MergeUnit::insert(const FineCandidate& key) {
  merge_.work(1);
  ++counters_.keys;
  if (config_.on_overflow == OnOverflow::kSpill && pending_count_ >= config_.entries) {
    spill_farthest();
  }
  pending_[key.depth].push_back({key, 0, nullptr});
  arrived_.emplace_back(key.depth, key.slot);
  ++pending_count_;
  counters_.pending_max = std::max<std::uint64_t>(counters_.pending_max, pending_count_);
}

// Asks for the file indices of keys that this visit has tied. The visit's own slots are neighbours:
// one read covers them.
void MergeUnit::ask_for_ties() {
  std::uint32_t low = std::numeric_limits<std::uint32_t>::max(), high = 0;
  for (const auto& [depth, slot] : arrived_) {
    const auto here = pending_.find(depth);
    if (here == pending_.end() || here->second.size() < 2) continue;
    low = std::min(low, slot);
    high = std::max(high, slot);
  }
  std::shared_ptr<IndexBlock> block;
  for (const auto& [depth, slot] : arrived_) {
    const auto here = pending_.find(depth);
    if (here == pending_.end() || here->second.size() < 2) continue;
    for (PendingKey& key : here->second) {
      if (key.block) continue;
      ++counters_.looked_up;
      if (key.candidate.slot < low || key.candidate.slot > high) {
        ask_for(key, key.candidate.slot, 1);
        continue;
      }
      if (block) {
        key.block = block;
      } else {
        ask_for(key, low, high - low + 1);
        block = key.block;
      }
    }
  }
  arrived_.clear();
}

void MergeUnit::ask_for(PendingKey& key, std::uint32_t first_slot, std::uint32_t slots) {
  const RecordArray& indices = job_.layout.chunk_table().indices;
  key.block = std::make_shared<IndexBlock>();
  key.block->first_slot = first_slot;
  key.block->indices.resize(slots);
  key.block->ticket =
      start_read(memory, merge_, indices.address(first_slot), key.block->indices.data(),
                 slots * static_cast<std::uint32_t>(sizeof(std::uint32_t)), indices.region);
  in_flight_.push_back(key.block);
}

// Releases every key nearer than `nearest`.
void MergeUnit::release_below(float nearest) {
  while (!finished->finished(group_)) {
    const RunReader* run = nearest_of(runs_);
    if (pending_.empty() && run == nullptr) return;
    float depth = std::numeric_limits<float>::infinity();
    if (run != nullptr) depth = run->front().candidate.depth;
    if (!pending_.empty()) depth = std::min(depth, pending_.begin()->first);
    if (!(depth < nearest)) return;
    release_depth(depth);
  }
}

// Releases all keys of one depth, which is the nearest: in the order of the file.
void MergeUnit::release_depth(float depth) {
  std::vector<PendingKey> here;
  if (!pending_.empty() && pending_.begin()->first == depth) {
    here = std::move(pending_.begin()->second);
    pending_.erase(pending_.begin());
    pending_count_ -= static_cast<std::uint32_t>(here.size());
  }
  const auto run_at_depth = [&]() -> RunReader* {
    RunReader* run = nearest_of(runs_);
    return run != nullptr && run->front().candidate.depth == depth ? run : nullptr;
  };
  if (here.size() > 1 || (!here.empty() && run_at_depth() != nullptr)) look_up(here);
  const bool tied_before = !here.empty() && here.front().tied;
  const std::uint64_t released_before = counters_.released;
  std::size_t next = 0, at_depth = 0;
  for (;; ++at_depth) {
    RunReader* run = run_at_depth();
    if (next == here.size() && run == nullptr) break;
    if (run == nullptr || (next < here.size() && here[next].index < run->front().index)) {
      emit(here[next++]);
    } else {
      emit(run->front());
      take_front(*run, runs_);
    }
  }
  if (at_depth > 1 || tied_before) counters_.ties += counters_.released - released_before;
}

// blend_early: the nearest keys go before they are final, until the buffer holds no more than it is
// meant to between two visits. Of several at one depth the others may stay.
void MergeUnit::force_out() {
  while (pending_count_ > config_.entries && !finished->finished(group_)) {
    std::vector<PendingKey>& here = pending_.begin()->second;
    if (here.size() > 1) {
      look_up(here);
      for (PendingKey& key : here) key.tied = true;
    }
    const std::uint64_t released_before = counters_.released;
    emit(here.front());
    if (here.front().tied) counters_.ties += counters_.released - released_before;
    here.erase(here.begin());
    if (here.empty()) pending_.erase(pending_.begin());
    --pending_count_;
    ++counters_.forced_early;
  }
}

// Gives keys their file indices, waiting for those that are not there yet, and sorts them.
void MergeUnit::look_up(std::vector<PendingKey>& keys) {
  for (PendingKey& key : keys) {
    if (key.block) continue;
    ++counters_.looked_up;
    ask_for(key, key.candidate.slot, 1);
  }
  for (PendingKey& key : keys) {
    await(memory, merge_, key.block->ticket);
    key.index = key.block->indices[key.candidate.slot - key.block->first_slot];
  }
  std::sort(keys.begin(), keys.end(), final_order);
  while (!in_flight_.empty() && memory.done(in_flight_.front()->ticket)) in_flight_.pop_front();
}

void MergeUnit::emit(const PendingKey& key) {
  if (finished->finished(group_)) {
    ++counters_.dropped_saturated;
    return;
  }
  merge_.work(1);
  in_turn(released, sequence_).push(key.candidate, merge_);
  ++sequence_;
  ++counters_.released;
}

void MergeUnit::end_group(const FineCandidate& end) {
  release_below(std::numeric_limits<float>::infinity());
  drop_all();
  merge_.work(1);
  in_turn(released, sequence_).push(end, merge_);
  ++sequence_;
}

// The farthest keys on chip become a sorted run in DRAM: an eighth of the buffer at first, since
// the excess is mostly small, more when it turns out not to be.
void MergeUnit::spill_farthest() {
  if (runs_.size() == config_.spill_runs) merge_shortest_runs();
  const std::uint32_t eighths = std::min(4U, 1 + spills_ / config_.spill_runs);
  const std::uint32_t wanted = std::max(1U, pending_count_ * eighths / 8);
  ++spills_;
  std::vector<PendingKey> far;
  while (far.size() < wanted) {
    const auto farthest = std::prev(pending_.end());
    std::move(farthest->second.begin(), farthest->second.end(), std::back_inserter(far));
    pending_.erase(farthest);
  }
  pending_count_ -= static_cast<std::uint32_t>(far.size());
  look_up(far);
  if (!fits_spill_area(far.size())) merge_runs(runs_.end());
  const SpillPort to = spill_port();
  SpillWriter<KeyCodec> writer(to, spill_area_base() + spill_used_, KeyCodec{group_});
  for (const PendingKey& key : far) {
    merge_.work(1);
    writer.append(key);
  }
  ++counters_.runs_spilled;
  keep_run(to, writer.finish());
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

// Runs before `end` become one: behind all others or, when there are no others, in the other half
// of the spill area, which has room for all keys of a group.
void MergeUnit::merge_runs(std::list<RunReader>::iterator end) {
  if (end == runs_.end()) {
    spill_area_ ^= 1U;
    spill_used_ = 0;
  }
  std::list<RunReader> merging;
  merging.splice(merging.begin(), runs_, runs_.begin(), end);
  if (merging.empty()) return;
  const SpillPort to = spill_port();
  SpillWriter<KeyCodec> writer(to, spill_area_base() + spill_used_, KeyCodec{group_});
  for (RunReader* run = nearest_of(merging); run != nullptr; run = nearest_of(merging)) {
    merge_.work(1);
    writer.append(run->front());
    take_front(*run, merging);
  }
  keep_run(to, writer.finish());
}

// Written before it is read.
void MergeUnit::keep_run(const SpillPort& to, const SpillRun& run) {
  spill_used_ += run.entries * kSpilledKeyBytes;
  counters_.keys_spilled += run.entries;
  await_all(memory, merge_);
  runs_.emplace_back(to, run, KeyCodec{group_});
}

bool MergeUnit::fits_spill_area(std::uint64_t keys) const {
  return spill_used_ + keys * kSpilledKeyBytes <= spill_.bytes / 2;
}

void MergeUnit::take_front(RunReader& run, std::list<RunReader>& from) {
  run.pop();
  if (run.exhausted()) from.remove_if([&](const RunReader& r) { return &r == &run; });
}

MergeUnit::RunReader* MergeUnit::nearest_of(std::list<RunReader>& runs) {
  RunReader* nearest = nullptr;
  for (RunReader& run : runs) {
    if (nearest == nullptr || final_order(run.front(), nearest->front())) nearest = &run;
  }
  return nearest;
}

// The group is finished, or done with: nothing that still waits is needed.
void MergeUnit::drop_all() {
  counters_.dropped_saturated += pending_count_;
  for (const RunReader& run : runs_) counters_.dropped_saturated += run.left();
  pending_.clear();
  pending_count_ = 0;
  if (!runs_.empty()) await_all(memory, merge_);  // blocks that are still on their way
  runs_.clear();
  spill_used_ = 0;
  spills_ = 0;
}

SramUses MergeUnit::sram_uses(const MergeConfig& config, const BuiltFor& built_for) {
  SramUses uses = {
      sram_use("waiting keys", kSharedSram, {{config.entries, "keys"}, {kWaitingKeyBytes, "B"}})};
  if (config.on_overflow != OnOverflow::kSpill) return uses;
  const SramUse block = sram_use("spill blocks", kSharedSram,
                                 {{config.spill_block_entries, "keys"}, {kSpilledKeyBytes, "B"}});
  const auto bytes = static_cast<std::uint32_t>(block.bytes);
  uses.push_back(sram_use("spilled runs", kSharedSram,
                          {{config.spill_runs, "runs"},
                           {2, "blocks"},
                           {config.spill_block_entries, "keys"},
                           {kSpilledKeyBytes, "B"}}));
  uses.push_back(block);
  uses.push_back(unanswered_writes("spill writes", kSharedSram, built_for.memory_port, bytes));
  return uses;
}

void MergeUnit::publish(DataSheet& sheet) {
  sheet.unit(*this);
  sheet.activity(merge_, "merge", "takes keys, releases them in final order");
  sheet.counter("keys", "keys", "received", counters_.keys);
  sheet.counter("released", "keys", "in final order, to the fine filters", counters_.released);
  sheet.counter("forced_early", "keys", "of these before they were final", counters_.forced_early);
  sheet.counter("dropped_saturated", "keys", "dropped: their group was finished",
                counters_.dropped_saturated);
  sheet.counter("pending_keys_max", "keys", "most that waited on chip", counters_.pending_max);
  sheet.counter("ties_looked_up", "keys", "released beside others of the same depth",
                counters_.ties);
  sheet.counter("index_lookups", "keys", "whose place in the file was asked for: tied, or spilled",
                counters_.looked_up);
  sheet.counter("runs_spilled", "runs", "written to DRAM", counters_.runs_spilled);
  sheet.counter("keys_spilled", "keys", "written to DRAM, over all passes", counters_.keys_spilled);
  // A key climbs or sinks through the levels of the heap, once in and once out.
  const double moved_bits = 8.0 * static_cast<double>(counters_.keys) * 2 *
                            heap_levels(config_.entries) * kWaitingKeyBytes;
  sheet.operations("merge", "sram_middle_write_bit", moved_bits);
  sheet.operations("merge", "sram_middle_read_bit", moved_bits);
  sheet.part("merge", "sorting_unit", 1);  // not published: taken as one more sorting unit
  sheet.left_out("saturated_gaussians", "the group finished while its visits were under way",
                 counters_.dropped_saturated, "filtering and second halves");
  sheet.left_out("index_lookups", "no other waiting key had its depth, and it was not spilled",
                 counters_.keys - counters_.looked_up, "4 B of DRAM traffic each");
  sheet.sram(sram_uses(config_, built_for_));
  sheet.port(memory);
  sheet.signal("group", group_);
  sheet.signal("pending", pending_count_);
}

}  // namespace sgs
