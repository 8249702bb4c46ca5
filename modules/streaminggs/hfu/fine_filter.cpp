// The threads of the fine filter.
#include "modules/streaminggs/hfu/fine_filter.h"

#include <algorithm>

#include "algorithm/memory/record_split.h"
#include "algorithm/memory/splat_record.h"
#include "algorithm/splat/make_splat.h"
#include "modules/datapath/work_rates.h"
#include "modules/streaminggs/hfu/filter_datapaths.h"

namespace sgs {
namespace {

// Time until the oldest entry can be taken; at_most where it can, or there is none.
template <class T>
sc_core::sc_time until_ready(const TimedFifo<T>& from, const sc_core::sc_time& at_most) {
  if (from.empty() || from.can_pop()) return at_most;
  return std::min(at_most, from.ready_at() - sc_core::sc_time_stamp());
}

}  // namespace

FineFilter::FineFilter(const sc_core::sc_module_name& name, const HfuConfig& config,
                       const CodebookConfig& codebook, const FineFilterPlace& place,
                       const UnitContext& context)
    : sc_module(name),
      memory("memory", context.built_for.memory_port, context.clock.period()),
      config_(config),
      built_for_(context.built_for),
      place_(place),
      job_(context.job),
      fetch_("fetch", context.clock),
      tests_(side_by_side(
          fine_pipeline(config,
                        context.job.layout.split.fine_record(context.job.layout.sh_degree()),
                        context.built_for.single, context.built_for.fine_records),
          static_cast<std::uint32_t>(context.job.parts.size()))),
      record_bytes_(job_.layout.second_halves.record_bytes),
      test_cycles_(std::max<std::uint64_t>(
          config.ffus > 1 ? 1 : tests_.interval_cycles(),
          job_.layout.second_half.quantised() ? 1 : read_cycles(record_bytes_))),
      second_halves_(std::size_t{config.second_half_slots} * record_bytes_),
      wanted_(config.second_half_slots),
      free_slots_("free_slots", context.clock, config.second_half_slots,
                  job_.layout.second_half.quantised() ? 0 : read_cycles(record_bytes_)) {
  SC_THREAD(run_fetch);
  for (std::uint32_t p = 0; p < job_.parts.size(); ++p) make_part(p, context.clock, codebook);
}

void FineFilter::make_part(std::uint32_t index, const ClockDomain& clock,
                           const CodebookConfig& codebook) {
  const std::string number = job_.parts.size() > 1 ? std::to_string(index) : "";
  parts_.push_back(
      std::make_unique<Part>(index, number, clock, fetched_entries(config_),
                             group_numbers(group_flow(GroupUse::kPixels), built_for_.single)));
  Part& part = *parts_.back();
  sc_core::sc_spawn([this, &part] { run_filter(part); }, ("run_filter" + number).c_str());
  if (!job_.layout.second_half.quantised()) {
    part.fetched.announce_to(part.arrived);
    return;
  }
  part.stage = std::make_unique<DecodeStage>(number, clock, codebook);
  part.stage->decoded.announce_to(part.arrived);
  sc_core::sc_spawn([this, &part] { run_decode(part); }, ("run_decode" + number).c_str());
}

void FineFilter::run_fetch() {
  for (std::uint32_t slot = 0; slot < config_.second_half_slots; ++slot) {
    free_slots_.push(slot, fetch_);
  }
  while (true) {
    const FineCandidate candidate = candidates->pop(fetch_);
    take_up(candidate, fetch_);
    if (candidate.mark == Mark::kNone) {
      fetch(candidate);
    } else {
      fetch_.work(1);
      for (const auto& part : parts_) part->fetched.push(candidate, fetch_);
    }
  }
}

// Behind the merge unit candidates of several visits are mixed, so only the group is named there.
void FineFilter::take_up(const FineCandidate& candidate, Activity& activity) const {
  const bool by_visit = place_.rejects == Rejects::kDropped;
  activity.takes_up_group(candidate.group, by_visit ? candidate.visit : Activity::kNoVisit);
}

// Fetches the second half for those parts that still want it.
void FineFilter::fetch(FineCandidate candidate) {
  const std::uint32_t all = candidate.parts;
  candidate.parts &= unfinished_parts(finished, candidate.group);
  if (candidate.parts == 0) {
    fetch_.work(1);
    drop_saturated(candidate);
    counters_.dropped_saturated += count_parts(all);
    return;
  }
  counters_.dropped_saturated += count_parts(all & ~candidate.parts);
  counters_.dropped_fetched += count_parts(all & ~candidate.parts);
  candidate.buffer = free_slots_.pop(fetch_, WaitFor::kRoom);
  fetch_.work(1);
  memory.charge_to(candidate.group);
  candidate.ticket =
      start_read(memory, fetch_, job_.layout.second_halves.address(candidate.slot),
                 second_halves_.data() + std::size_t{candidate.buffer} * record_bytes_,
                 record_bytes_, job_.layout.second_halves.region);
  ++counters_.second_halves;
  wanted_[candidate.buffer] = count_parts(candidate.parts);
  FineCandidate rejected = candidate;
  rejected.mark = Mark::kRejected;
  for (const auto& part : parts_) {
    if ((candidate.parts >> part->index & 1U) != 0) {
      part->fetched.push(candidate, fetch_);
    } else if (place_.rejects == Rejects::kReported) {
      part->fetched.push(rejected, fetch_);
    }
  }
}

// A token that nothing follows keeps its place in the order all the same.
void FineFilter::drop_saturated(const FineCandidate& candidate) {
  if (place_.rejects == Rejects::kDropped) return;
  FineCandidate rejected = candidate;
  rejected.mark = Mark::kRejected;
  for (const auto& part : parts_) part->fetched.push(rejected, fetch_);
}

// Decodes the record in a slot, with the words that the first half carried for it.
DecodedGaussian FineFilter::read_slot(const Part& part, const FineCandidate& candidate) const {
  return read_record(job_.layout.split, job_.layout.second_half,
                     {candidate.mean_x, candidate.mean_y, candidate.mean_z}, candidate.carried,
                     second_halves_.data() + std::size_t{candidate.buffer} * record_bytes_,
                     part.stage ? codebooks->bytes() : nullptr);
}

// Called for each part that wants the record of the slot: when it begins to read it, or has read
// its codebook entries, and so the record. The last gives the slot back.
void FineFilter::free_slot(std::uint32_t slot, Activity& activity) {
  if (--wanted_[slot] == 0) free_slots_.push(slot, activity);
}

void FineFilter::run_decode(Part& part) {
  Activity& decode = part.stage->decode;
  while (true) {
    Decoded next;
    next.candidate = part.fetched.front(decode);
    const FineCandidate& candidate = next.candidate;
    take_up(candidate, decode);
    // Room for the decoded record is needed first: lines of its entries go there as they are read.
    part.stage->decoded.wait_for_room(1, TimedFifo<Decoded>::kNever, decode);
    if (candidate.mark != Mark::kNone) {
      decode.work(1);
    } else {
      await(memory, decode, candidate.ticket);
      ++counters_.second_halves_taken;
      if (finished[static_cast<int>(part.index)]->finished(candidate.group)) {
        decode.work(1);
      } else {
        const std::byte* record =
            second_halves_.data() + std::size_t{candidate.buffer} * record_bytes_;
        codebooks->read_entries(
            place_.reader + part.index,
            read_indices(job_.layout.split, job_.layout.second_half, candidate.carried, record),
            decode);
      }
      next.second = read_slot(part, candidate);
      free_slot(candidate.buffer, decode);
    }
    part.fetched.remove_front();
    part.stage->decoded.push(next, decode);
  }
}

void FineFilter::run_filter(Part& part) {
  part.places.assign(static_cast<std::size_t>(splats.size()) / parts_.size(),
                     PlacesUnderTest(config_.ffu_depth_cycles));
  while (true) filter_next(part);
}

void FineFilter::filter_next(Part& part) {
  if (part.stage) {
    filter_decoded(part);
  } else {
    filter_fetched(part);
  }
}

void FineFilter::filter_decoded(Part& part) {
  const Decoded& front = part.stage->decoded.front(part.filter);
  take_up(front.candidate, part.filter);
  if (front.candidate.mark == Mark::kNone) wait_for_numbers(part, front.candidate.group);
  wait_for_place(part, front.candidate.visit);
  const bool wanted = is_wanted(part, front.candidate);
  if (wanted) wait_for_turn_of_one(part);
  const Decoded next = front;
  part.stage->decoded.remove_front();
  if (next.candidate.mark != Mark::kNone) {
    pass_mark(part, next.candidate);
  } else if (wanted) {
    test(part, next);
  } else {
    drop(part, next.candidate);
  }
}

void FineFilter::filter_fetched(Part& part) {
  Decoded next;
  next.candidate = part.fetched.front(part.filter);
  take_up(next.candidate, part.filter);
  if (next.candidate.mark != Mark::kNone) {
    wait_for_place(part, next.candidate.visit);
    part.fetched.remove_front();
    pass_mark(part, next.candidate);
    return;
  }
  await(memory, part.filter, next.candidate.ticket);
  wait_for_numbers(part, next.candidate.group);
  ++counters_.second_halves_taken;
  wait_for_place(part, next.candidate.visit);
  const bool wanted = is_wanted(part, next.candidate);
  if (wanted) wait_for_turn_of_one(part);
  next.second = read_slot(part, next.candidate);
  free_slot(next.candidate.buffer, part.filter);
  part.fetched.remove_front();
  if (wanted) {
    test(part, next);
  } else {
    drop(part, next.candidate);
  }
}

bool FineFilter::is_wanted(const Part& part, const FineCandidate& candidate) const {
  return candidate.mark == Mark::kNone &&
         !finished[static_cast<int>(part.index)]->finished(candidate.group);
}

// Its group was known before its second half was fetched, which takes longer than the numbers.
void FineFilter::wait_for_numbers(Part& part, std::uint32_t group) const {
  const std::uint64_t now = part.filter.clock().now_cycles();
  part.filter.work(std::max(now, part.numbers.stand(group, 0)) - now);
}

// The FFUs have their turns spread evenly: records come apart by what reads or decodes them.
void FineFilter::wait_for_turn_of_one(Part& part) const {
  const std::uint64_t now = part.filter.clock().now_cycles();
  part.filter.work(next_spread_turn(now, tests_.interval_cycles(), config_.ffus) - now);
}

void FineFilter::wait_for_place(Part& part, std::uint32_t visit) {
  part.places[visit % part.places.size()].wait_for_one(to_sorting(part, visit), part.filter);
}

void FineFilter::pass_mark(Part& part, const FineCandidate& candidate) {
  part.filter.work(1);
  SplatToken end;
  end.group = candidate.group;
  end.visit = candidate.visit;
  end.mark = candidate.mark;
  to_sorting(part, end.visit).push(end, part.filter);
}

void FineFilter::drop(Part& part, const FineCandidate& candidate) {
  ++counters_.dropped_saturated;
  ++counters_.dropped_fetched;
  part.filter.work(1);
  reject(part, candidate);
}

void FineFilter::test(Part& part, const Decoded& decoded) {
  const std::uint64_t began = part.filter.clock().now_cycles();
  part.numbers.leaves(began + 1 + config_.ffu_depth_cycles);
  part.filter.work(1);
  ++counters_.fine_tests;
  hand_on(part, decoded, began);
  const std::uint64_t end = began + test_cycles_;
  while (part.filter.clock().now_cycles() < end) {
    if (mark_is_next(part)) {
      filter_next(part);
    } else {
      work_lanes(part, end);
    }
  }
  // The lanes of several work beside what is waited for.
  if (config_.ffus > 1) part.filter.works_until(began + tests_.interval_cycles());
}

// A mark passes beside the lanes.
bool FineFilter::mark_is_next(Part& part) {
  if (part.stage) {
    auto& from = part.stage->decoded;
    return from.can_pop() && from.front(part.filter).candidate.mark != Mark::kNone;
  }
  return part.fetched.can_pop() && part.fetched.front(part.filter).mark != Mark::kNone;
}

// Keeps the lanes busy up to cycle `end`, or until there may be a mark that passes beside them.
void FineFilter::work_lanes(Part& part, std::uint64_t end) {
  const ClockDomain& clock = part.filter.clock();
  const sc_core::sc_time left = static_cast<double>(end - clock.now_cycles()) * clock.period();
  part.filter.works();
  sc_core::wait(
      part.stage ? until_ready(part.stage->decoded, left) : until_ready(part.fetched, left),
      part.arrived);
  clock.jitter();
}

// Hands on the result of a test that began in cycle `began`.
void FineFilter::hand_on(Part& part, const Decoded& decoded, std::uint64_t began) {
  const FineCandidate& candidate = decoded.candidate;
  SplatToken token;
  const View<float>& view = job_.view_of(candidate.group, job_.eye_of(part.index));
  if (!make_geometry(view, decoded.second.gaussian, token.splat) ||
      !reaches_group(token.splat, job_.parts[part.index][candidate.group])) {
    if (place_.rejects == Rejects::kDropped) {
      part.places[candidate.visit % part.places.size()].add(began);
    }
    reject(part, candidate);
    return;
  }
  add_colour(view, job_.layout.sh_degree(), decoded.second.gaussian.mean, decoded.second.sh,
             token.splat);
  token.splat.index = candidate.slot;
  token.group = candidate.group;
  token.visit = candidate.visit;
  to_sorting(part, candidate.visit).push(token, part.filter);
  ++counters_.splats;
}

void FineFilter::reject(Part& part, const FineCandidate& candidate) {
  if (place_.rejects == Rejects::kDropped) return;
  SplatToken token;
  token.group = candidate.group;
  token.visit = candidate.visit;
  token.mark = Mark::kRejected;
  to_sorting(part, candidate.visit).push(token, part.filter);
}

FifoWriteIf<SplatToken>& FineFilter::to_sorting(const Part& part, std::uint32_t visit) {
  const std::size_t of_part = static_cast<std::size_t>(splats.size()) / parts_.size();
  return *splats[static_cast<int>(part.index * of_part + visit % of_part)];
}

}  // namespace sgs
