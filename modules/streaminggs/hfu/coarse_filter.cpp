// The two threads of the coarse filter.
#include "modules/streaminggs/hfu/coarse_filter.h"

#include <algorithm>
#include <utility>

#include "modules/datapath/work_rates.h"
#include "modules/streaminggs/hfu/filter_datapaths.h"

namespace sgs {

CoarseFilter::CoarseFilter(const sc_core::sc_module_name& name, const HfuConfig& config,
                           const UnitContext& context)
    : sc_module(name),
      memory("memory", context.built_for.memory_port, context.clock.period()),
      config_(config),
      built_for_(context.built_for),
      tests_(side_by_side(coarse_pipeline(config, context.job.layout.split.bound_by,
                                          context.job.parts_of_group(), context.built_for.single),
                          context.job.parts_of_group())),
      has_cfus_(has_cfus(config, context.job.layout.split.bound_by)),
      numbers_(
          group_numbers(group_flow(GroupUse::kFilter, parts_across(context.job.parts_of_group())),
                        context.built_for.single)),
      job_(context.job),
      record_bytes_(job_.layout.first_halves.record_bytes),
      load_("load", context.clock),
      filter_("filter", context.clock),
      input_(std::size_t{config.input_slots} * config.slice_gaussians * record_bytes_),
      slices_("slices", context.clock, config.input_slots),
      free_slots_("free_slots", context.clock, config.input_slots, 0) {
  SC_THREAD(run_load);
  SC_THREAD(run_filter);
}

void CoarseFilter::run_load() {
  for (std::uint32_t slot = 0; slot < config_.input_slots; ++slot) {
    free_slots_.push(slot, load_);
  }
  while (true) {
    VisitShare share = shares->pop(load_);
    take_up_group(load_, memory, share.group, share.visit);
    const std::uint64_t known = load_.clock().now_cycles() + 1;
    if (share.count > 0 && all_finished(finished, share.group)) {
      counters_.dropped_saturated += share.count;
      share.count = 0;
    }
    const std::uint32_t end = share.first + share.count;
    do {
      Slice slice;
      slice.share = share;
      slice.share.count = std::min(end - share.first, config_.slice_gaussians);
      slice.known = known;
      slice.slot = free_slots_.pop(load_, WaitFor::kRoom);
      load_.work(1);
      if (slice.share.count > 0) {
        slice.ticket = start_read(memory, load_, job_.layout.first_halves.address(share.first),
                                  first_half(slice.slot, 0), slice.share.count * record_bytes_,
                                  job_.layout.first_halves.region);
        counters_.first_halves += slice.share.count;
      }
      share.first += slice.share.count;
      if (share.first < end) slice.share.mark = Mark::kNone;
      slices_.push(slice, load_);
    } while (share.first < end);
  }
}

void CoarseFilter::run_filter() {
  places_.assign(static_cast<std::size_t>(survivors.size()),
                 PlacesUnderTest(config_.cfu_depth_cycles));
  while (true) {
    const Slice slice = slices_.pop(filter_);
    current_group_ = slice.share.group;
    current_visit_ = slice.share.visit;
    filter_.takes_up_group(current_group_, current_visit_);
    if (slice.share.count > 0) {
      await(memory, filter_, slice.ticket);
      if (has_cfus_) wait_for_numbers(slice);
      filter_slice(slice);
    }
    free_slots_.push(slice.slot, filter_);
    if (slice.share.mark != Mark::kNone) {
      ++counters_.shares;
      places_of(slice.share.visit).wait_for_one(in_turn(survivors, slice.share.visit), filter_);
      filter_.work(1);
      FineCandidate end;
      end.group = slice.share.group;
      end.visit = slice.share.visit;
      end.mark = slice.share.mark;
      end.release_below = slice.share.release_below;
      in_turn(survivors, end.visit).push(end, filter_);
    }
  }
}

// Made as soon as the group is known, and no test takes the numbers that were there before.
void CoarseFilter::wait_for_numbers(const Slice& slice) {
  const std::uint64_t now = filter_.clock().now_cycles();
  filter_.work(std::max(now, numbers_.stand(slice.share.group, slice.known)) - now);
}

std::byte* CoarseFilter::first_half(std::uint32_t slot, std::uint32_t at) {
  return input_.data() +
         (std::size_t{slot} * config_.slice_gaussians + at) * std::size_t{record_bytes_};
}

// The CFUs take a Gaussian each in their turns, a cycle after each other as these come out of the
// input buffer; so they are done a cycle apart, and a candidate a cycle goes on. Without CFUs a
// Gaussian takes that cycle. Simulated time is only let pass where somebody could see it: before a
// candidate is handed on, and at the end.
void CoarseFilter::filter_slice(const Slice& slice) {
  const RecordSplit& split = job_.layout.split;
  const std::uint64_t cfus = has_cfus_ ? tests_.copies : 1;
  const std::uint64_t of_test = has_cfus_ ? tests_.interval_cycles() : 1;
  FifoWriteIf<FineCandidate>& to = in_turn(survivors, slice.share.visit);
  PlacesUnderTest& places = places_of(slice.share.visit);
  const std::uint64_t began = filter_.clock().now_cycles();
  std::uint64_t passed = began, cycle = began;
  std::uint32_t open = 0;  // parts
  for (std::uint32_t i = 0; i < slice.share.count; ++i) {
    if (i % tests_.copies == 0) {
      open = unfinished_parts(finished, slice.share.group);
      if (open == 0) {
        counters_.dropped_saturated += slice.share.count - i;
        break;
      }
    }
    if (places.taken(cycle) >= to.room()) {
      filter_.work(cycle - passed);
      places.wait_for_one(to, filter_);
      cycle = passed = filter_.clock().now_cycles();
    }
    cycle = next_turn_of_one(cycle, of_test, cfus) + 1;
    numbers_.leaves(cycle + config_.cfu_depth_cycles);
    ++counters_.read;
    const SplitFirstHalf first = read_first_half(split, first_half(slice.slot, i));
    Bounds bounds;
    for (std::uint32_t eye = 0; eye < job_.eyes; ++eye) {
      bounds[eye] = bound_first_half(split, first, job_.view_of(slice.share.group, eye));
    }
    const std::uint32_t parts = test(bounds, slice.share.group, open);
    if (parts == 0) {
      places.add(cycle - 1);
      continue;
    }
    counters_.coarse_passed += count_parts(parts);
    ++counters_.coarse_candidates;
    filter_.work(cycle - passed);
    FineCandidate candidate;
    candidate.group = slice.share.group;
    candidate.visit = slice.share.visit;
    candidate.slot = slice.share.first + i;
    candidate.parts = parts;
    candidate.depth = depth_of(bounds[0]);
    candidate.mean_x = first.mean.x;
    candidate.mean_y = first.mean.y;
    candidate.mean_z = first.mean.z;
    candidate.carried = first.carried;
    candidate.reach = reach(bounds, slice.share.group, parts);
    to.push(candidate, filter_);
    cycle = passed = filter_.clock().now_cycles();
  }
  // A slice of a finished group is taken in a cycle of its own, if no mark behind it has one.
  if (cycle == began && slice.share.mark == Mark::kNone) ++cycle;
  filter_.work(cycle - passed);
}

// The parts that the Gaussian may touch, of those that are open. A part without pixels is finished
// as soon as the news of it has arrived; until then nothing touches it.
std::uint32_t CoarseFilter::test(const Bounds& bounds, std::uint32_t group, std::uint32_t open) {
  if (!config_.coarse_filter) return open;
  ++counters_.coarse_tests;
  counters_.coarse_tests_of_parts += count_parts(open);
  std::uint32_t parts = 0;
  for (std::uint32_t p = 0; p < part_count(); ++p) {
    const bool tested = (open >> p & 1U) != 0;
    const PixelRect& pixels = job_.parts[p][group];
    if (tested && !pixels.empty() && touches(bounds[job_.eye_of(p)], pixels)) parts |= 1U << p;
  }
  return parts;
}

// Sub-tiles that a Gaussian may reach, in the eyes that it may touch; used only in the key of exact
// order.
GroupReach CoarseFilter::reach(const Bounds& bounds, std::uint32_t group,
                               std::uint32_t parts) const {
  const auto* by_extents = std::get_if<ExtentBound>(&bounds[0]);
  const bool known = by_extents != nullptr && by_extents->in_front && config_.coarse_filter;
  if (!known) return {};
  const PixelRect& pixels = job_.groups[group];
  const auto of_eye = [&](std::uint32_t eye) {
    return reached_pixels(std::get<ExtentBound>(bounds[eye]), pixels);
  };
  constexpr std::uint32_t kRight = 2, kBoth = 3;
  if (parts == kBoth) return group_reach(of_both(of_eye(0), of_eye(1)), pixels);
  return group_reach(of_eye(parts == kRight ? 1 : 0), pixels);
}

SramUses CoarseFilter::sram_uses(const HfuConfig& config, const BuiltFor& built_for) {
  // First halves that come from memory in one cycle, at most; may be more than one.
  const auto come =
      static_cast<std::uint32_t>(cycles_for(kPortBytes, std::max(1U, built_for.first_half_bytes)));
  return {sram_use("input", kInputSram,
                   {{config.input_slots, "slots"},
                    {config.slice_gaussians, "Gaussians"},
                    {built_for.first_half_bytes, "B"}},
                   {8 * built_for.first_half_bytes, SramPorts::kReadAndWrite, come}, {1, come}),
          fifo_use<Slice>("slices", kSharedSram, config.input_slots, "slices"),
          outstanding_table(kSharedSram, built_for.memory_port)};
}

void CoarseFilter::publish(DataSheet& sheet) {
  sheet.unit(*this);
  sheet.activity(load_, "load", "fetches first halves into the input buffer");
  sheet.activity(filter_, "coarse", "puts them through the CFUs");
  sheet.counters(counters_);
  if (has_cfus_) {
    sheet.datapath(tests_, counters_.read);
    numbers_.publish(sheet, "coarse");
  }
  sheet.left_out("saturated_gaussians", "the group finished while its visits were under way",
                 counters_.dropped_saturated, "filtering and second halves");
  sheet.port(memory);
  sheet.sram(sram_uses(config_, built_for_));
  sheet.accesses("input", counters_.read, counters_.first_halves);
  sheet.queue(slices_, "slices");
  if (has_cfus_) {
    sheet.remedy(filter_, "hfu.cfu_lanes");
    sheet.may_help("hfu.cfus");
  }
  sheet.may_help("hfus");
  sheet.remedy(memory, WaitFor::kReads, "hfu.input_slots");
  sheet.remedy(memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.remedy(slices_, WaitFor::kRoom, "hfu.input_slots");
  sheet.remedy(free_slots_, WaitFor::kRoom, "hfu.input_slots");
  sheet.signal("group", current_group_);
  sheet.signal("visit", current_visit_);
}

}  // namespace sgs
