// The threads of the fine filter.
#include "modules/streaminggs/hfu/fine_filter.h"

#include "algorithm/memory/record_split.h"
#include "algorithm/memory/splat_record.h"
#include "algorithm/splat/make_splat.h"
#include "modules/streaminggs/hfu/filter_datapaths.h"

namespace sgs {
namespace {

// Of those whose second halves are on their way or waiting, and a mark.
std::uint32_t fetched_entries(const HfuConfig& config) { return config.second_half_slots + 1; }

}  // namespace

FineFilter::FineFilter(const sc_core::sc_module_name& name, const HfuConfig& config,
                       const CodebookConfig& codebook, const FineFilterPlace& place,
                       const UnitContext& context)
    : sc_module(name),
      memory("memory", context.built_for.memory_port),
      config_(config),
      built_for_(context.built_for),
      place_(place),
      job_(context.job),
      fetch_("fetch", context.clock),
      filter_("filter", context.clock),
      tests_(fine_datapath(config, context.job.layout.sh_degree())),
      record_bytes_(job_.layout.second_halves.record_bytes),
      second_halves_(std::size_t{config.second_half_slots} * record_bytes_),
      fetched_("fetched", context.clock, fetched_entries(config)),
      free_slots_("free_slots", context.clock, config.second_half_slots, 0) {
  SC_THREAD(run_fetch);
  SC_THREAD(run_filter);
  if (!job_.layout.second_half.quantised()) return;
  stage_ = std::make_unique<DecodeStage>(context.clock, codebook);
  SC_THREAD(run_decode);
}

void FineFilter::run_fetch() {
  for (std::uint32_t slot = 0; slot < config_.second_half_slots; ++slot) {
    free_slots_.push(slot, fetch_);
  }
  while (true) {
    FineCandidate candidate = candidates->pop(fetch_);
    if (candidate.mark == Mark::kNone) {
      if (finished->finished(candidate.group)) {
        drop_saturated(candidate);
        continue;
      }
      candidate.buffer = free_slots_.pop(fetch_, WaitFor::kRoom);
      fetch_.work(1);
      candidate.ticket =
          start_read(memory, fetch_, job_.layout.second_halves.address(candidate.slot),
                     second_halves_.data() + std::size_t{candidate.buffer} * record_bytes_,
                     record_bytes_, job_.layout.second_halves.region);
      ++counters_.second_halves;
    }
    fetched_.push(candidate, fetch_);
  }
}

// A token that nothing follows keeps its place in the order all the same.
void FineFilter::drop_saturated(const FineCandidate& candidate) {
  ++counters_.dropped_saturated;
  if (place_.rejects == Rejects::kDropped) return;
  FineCandidate rejected = candidate;
  rejected.mark = Mark::kRejected;
  fetched_.push(rejected, fetch_);
}

// The next candidate in order, its second half read from what was fetched.
FineFilter::Decoded FineFilter::take_fetched(Activity& activity) {
  Decoded out;
  out.candidate = fetched_.pop(activity);
  const FineCandidate& candidate = out.candidate;
  if (candidate.mark != Mark::kNone) return out;
  await(memory, activity, candidate.ticket);
  const SecondHalfFormat& format = job_.layout.second_half;
  const RecordSplit& split = job_.layout.split;
  const std::byte* record = second_halves_.data() + std::size_t{candidate.buffer} * record_bytes_;
  if (stage_ && !finished->finished(candidate.group)) {
    codebooks->read_entries(place_.reader, read_indices(split, format, candidate.carried, record),
                            activity);
  }
  out.second = read_record(split, format, {candidate.mean_x, candidate.mean_y, candidate.mean_z},
                           candidate.carried, record, stage_ ? codebooks->bytes() : nullptr);
  free_slots_.push(candidate.buffer, activity);
  return out;
}

void FineFilter::run_decode() {
  while (true) stage_->decoded.push(take_fetched(stage_->decode), stage_->decode);
}

void FineFilter::run_filter() {
  while (true) {
    const Decoded next = stage_ ? stage_->decoded.pop(filter_) : take_fetched(filter_);
    if (next.candidate.mark == Mark::kNone) {
      test(next);
      continue;
    }
    SplatToken end;
    end.group = next.candidate.group;
    end.visit = next.candidate.visit;
    end.mark = next.candidate.mark;
    in_turn(splats, end.visit).push(end, filter_);
  }
}

void FineFilter::test(const Decoded& decoded) {
  const FineCandidate& candidate = decoded.candidate;
  if (finished->finished(candidate.group)) {
    ++counters_.dropped_saturated;
    ++counters_.dropped_fetched;
    reject(candidate);
    return;
  }
  filter_.work(tests_.interval_cycles());
  ++counters_.tests;
  SplatToken token;
  if (!make_geometry(job_.view, decoded.second.gaussian, token.splat) ||
      !reaches_group(token.splat, job_.groups[candidate.group])) {
    reject(candidate);
    return;
  }
  add_colour(job_.view, job_.layout.sh_degree(), decoded.second.gaussian.mean, decoded.second.sh,
             token.splat);
  token.splat.index = candidate.slot;
  token.group = candidate.group;
  token.visit = candidate.visit;
  in_turn(splats, candidate.visit).push(token, filter_);
  ++counters_.splats;
}

void FineFilter::reject(const FineCandidate& candidate) {
  if (place_.rejects == Rejects::kDropped) return;
  SplatToken token;
  token.group = candidate.group;
  token.visit = candidate.visit;
  token.mark = Mark::kRejected;
  in_turn(splats, candidate.visit).push(token, filter_);
}

SramUses FineFilter::sram_uses(const HfuConfig& config, const BuiltFor& built_for) {
  SramUses uses = {
      sram_use("second halves", kSharedSram,
               {{config.second_half_slots, "slots"}, {built_for.second_half_bytes, "B"}},
               {8 * kPortBytes}),
      fifo_use<FineCandidate>("fetched candidates", kSharedSram, fetched_entries(config),
                              "candidates")};
  if (built_for.second_half.quantised()) {
    uses.push_back(fifo_use<Decoded>("decoded Gaussians", kSharedSram, kDecodedEntries, "entries"));
  }
  return uses;
}

void FineFilter::publish(DataSheet& sheet) {
  sheet.unit(*this);
  sheet.activity(fetch_, "fetch", "asks for second halves");
  if (stage_) sheet.activity(stage_->decode, "decode", "reads their codebook entries");
  sheet.activity(filter_, "fine", "puts them through the FFU");
  sheet.counter("second_halves", "Gaussians", "fetched", counters_.second_halves);
  sheet.counter("fine_tests", "Gaussians", "tested", counters_.tests);
  sheet.counter("splats", "splats", "that touch their group, passed on", counters_.splats);
  sheet.counter("dropped_saturated", "Gaussians", "dropped: their group was finished",
                counters_.dropped_saturated);
  sheet.counter("dropped_fetched", "Gaussians", "of these with their second half already fetched",
                counters_.dropped_fetched);
  sheet.datapath(tests_, counters_.tests);
  const std::uint64_t words = counters_.second_halves * sram_words(record_bytes_, {8 * kPortBytes});
  sheet.accesses("second halves", words, words);
  sheet.left_out("saturated_gaussians", "the group finished while its visits were under way",
                 counters_.dropped_saturated - counters_.dropped_fetched,
                 "filtering and second halves");
  sheet.left_out("saturated_tests", "the group finished while second halves were under way",
                 counters_.dropped_fetched, "the fine test: second halves were fetched");
  sheet.port(memory);
  sheet.sram(sram_uses(config_, built_for_));
  sheet.queue(fetched_, "fetched candidates");
  if (stage_) sheet.queue(stage_->decoded, "decoded Gaussians");
  sheet.remedy(filter_, "hfu.ffu_lanes");
  if (stage_) sheet.remedy(stage_->decode, "codebook.line_bytes");
  sheet.remedy(memory, WaitFor::kReads, "hfu.second_half_slots");
  sheet.remedy(memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.remedy(fetched_, WaitFor::kRoom, "hfu.second_half_slots");
  sheet.remedy(free_slots_, WaitFor::kRoom, "hfu.second_half_slots");
}

}  // namespace sgs
