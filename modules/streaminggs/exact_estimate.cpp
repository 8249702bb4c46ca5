// Visits, keys and splats of one group after the other.
#include "modules/streaminggs/exact_estimate.h"

#include <algorithm>
#include <limits>

#include "modules/streaminggs/streaming_sram.h"

namespace sgs {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

std::size_t ExactFrameWork::size_bytes() const {
  std::size_t sum = 0;
  for (const ExactGroupWork& group : of.groups) {
    sum += group.nodes.capacity() * sizeof(NodeWork) + group.visits.capacity() * sizeof(VisitWork) +
           group.keys.capacity() * sizeof(KeyWork) + group.blends.size_bytes();
  }
  return sum;
}

ExactEstimate::ExactEstimate(const ExactConfig& config, const ExactWork& work,
                             ExactUnitEstimates& units, RenderingEstimate& rendering)
    : config_(config), work_(work), units_(units), rendering_(rendering) {
  const ExactFifos kinds(config);
  visits_ = times_of(visit_fifos(config));
  keys_ = times_of(kinds.keys);
  sorted_ = times_of(kinds.sorted_keys);
  released_ = times_of(kinds.released);
  splats_ = times_of(kinds.splats);
}

std::uint64_t ExactEstimate::draw() {
  for (std::uint32_t group = 0; group < work_.groups.size(); ++group) draw_group(group);
  return rendering_.done();
}

// A visit goes when the next one that is not hidden is known.
void ExactEstimate::draw_group(std::uint32_t group) {
  group_ = group;
  of_ = &work_.groups[group];
  rendering_.begin_group(group, of_->blends);
  units_.vsu.begin_group();
  units_.merge.begin_group(group);
  last_depth_ = -1;
  bool saturated = false;
  const VisitWork* held = nullptr;
  std::uint32_t keys = 0, keys_of_held = 0;
  std::uint64_t now = 0;
  for (const VisitWork& visit : of_->visits) {
    now = units_.vsu.take_chunk(visit);
    saturated = rendering_.finished_from() <= now;
    if (saturated) break;
    if (!units_.vsu.hidden(visit, now)) {
      if (held != nullptr) send(*held, keys_of_held, visit.nearest, now);
      held = &visit;
      keys_of_held = keys;
    }
    keys = visit.keys;
  }
  if (held != nullptr && !saturated) send(*held, keys_of_held, kInfinity, now);
  units_.vsu.end_group(now, saturated);
  send_end(now);
  rendering_.end_group();
}

void ExactEstimate::send(const VisitWork& visit, std::uint32_t first_key, float nearest,
                         std::uint64_t cycle) {
  const std::uint64_t ready = units_.vsu.give(cycle);
  const bool dropped = rendering_.finished_from() <= ready;
  units_.vsu.count_visit(dropped);
  if (dropped) return;
  units_.vsu.given(visits_[visit_ % visits_.size()].push(ready));
  filter(visit.first, visit.count, first_key);
  merge_keys();
  units_.merge.take_mark(sorted_[visit_ % sorted_.size()], rendering_.finished_from());
  release_below(nearest);
  MergeEstimate::Key key;
  while (units_.merge.force_out(rendering_.finished_from(), key)) emit(key);
  ++visit_;
}

void ExactEstimate::send_end(std::uint64_t cycle) {
  const std::uint64_t ready = units_.vsu.give(cycle);
  units_.vsu.given(visits_[visit_ % visits_.size()].push(ready));
  filter(0, 0, 0);
  merge_keys();
  units_.merge.take_mark(sorted_[visit_ % sorted_.size()], rendering_.finished_from());
  release_below(kInfinity);
  units_.merge.drop_all();
  units_.merge.work_for(1);
  FineFilterEstimate::Candidate end;
  end.group = group_;
  end.mark = true;
  to_fine(end, KeyWork::kNoSplat);
  ++visit_;
}

// Through an HFU's coarse filter into a sorting unit.
void ExactEstimate::filter(std::uint32_t first, std::uint32_t count, std::uint32_t first_key) {
  const std::size_t hfu = visit_ % units_.coarse.size(), sorter = visit_ % units_.sorters.size();
  FifoTimes& keys = keys_[hfu * units_.sorters.size() + sorter];
  list_.clear();
  std::uint32_t next = first_key;
  const auto passes = [&](std::uint32_t slot) -> std::uint32_t {
    return next < of_->keys.size() && of_->keys[next].slot == slot ? 1 : 0;
  };
  CoarseFilterEstimate& coarse = units_.coarse[hfu];
  coarse.begin({group_, first, count, rendering_.finished_from()}, visits_[visit_ % visits_.size()],
               keys);
  while (coarse.next(passes)) {
    const KeyWork& key = of_->keys[next];
    list_.push_back({key.depth, key.slot, next++});
    coarse.go_on(keys.push(coarse.now()));
    units_.sorters[sorter].take(keys);
  }
  coarse.end();
  coarse.go_on(keys.push(coarse.now()));
  units_.sorters[sorter].sort(keys);
}

void ExactEstimate::merge_keys() {
  std::sort(list_.begin(), list_.end());
  const std::size_t sorter = visit_ % units_.sorters.size();
  FifoTimes& sorted = sorted_[sorter];
  for (const MergeEstimate::Key& key : list_) {
    units_.sorters[sorter].hand_on(sorted);
    units_.merge.take(key, sorted, rendering_.finished_from());
  }
  units_.sorters[sorter].hand_on(sorted);
}

void ExactEstimate::release_below(float nearest) {
  MergeEstimate::Key key;
  while (units_.merge.release(nearest, rendering_.finished_from(), key)) emit(key);
}

void ExactEstimate::emit(const MergeEstimate::Key& key) {
  MergeUnit::Counters& counters = units_.merge.counters();
  const KeyWork& work = of_->keys[key.number];
  ++counters.due;
  if (rendering_.finished(work.reach, units_.merge.now())) {
    ++counters.dropped_hidden;
    return;
  }
  counters.ties += key.depth == last_depth_ ? 1 : 0;
  last_depth_ = key.depth;
  ++counters.released;
  const std::uint32_t splats = work.splat == KeyWork::kNoSplat ? 0 : 1;
  const std::uint64_t finished_from = rendering_.finished_from();
  to_fine({group_, key.slot, false, 1, splats, &finished_from}, work.splat);
}

void ExactEstimate::to_fine(const FineFilterEstimate::Candidate& candidate, std::uint32_t splat) {
  const std::size_t hfu = sequence_++ % released_.size();
  units_.merge.go_on(released_[hfu].push(units_.merge.now()));
  FifoTimes& splats = splats_[hfu];
  units_.fine[hfu].take(
      candidate, released_[hfu], [&](std::uint32_t) -> FifoTimes& { return splats; },
      [&](std::uint32_t, std::uint64_t now, bool tested) {
        splats.push(now);
        if (tested && candidate.splats != 0) {
          rendering_.blend(splats, splat);
        } else {
          rendering_.pass(splats);
        }
      });
}

}  // namespace sgs
