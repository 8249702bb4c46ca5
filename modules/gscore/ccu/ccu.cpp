// The threads of a CCU.
#include "modules/gscore/ccu/ccu.h"

#include <algorithm>

#include "algorithm/splat/make_splat.h"
#include "modules/datapath/work_rates.h"
#include "modules/gscore/gscore_datapaths.h"

namespace sgs::gscore {
namespace {

constexpr const char *kInput = "first halves", *kSecondHalves = "second halves",
                     *kSlices = "slices", *kCulled = "candidates",
                     *kGathered = "candidates of a slice", *kFetched = "fetched candidates";

std::uint32_t words_of(std::uint32_t bytes) {
  return static_cast<std::uint32_t>(cycles_for(bytes, kPortBytes));
}

// Bytes of the largest second half of any scene that it takes.
std::uint32_t most_second_half_bytes() {
  return split_of(StorageOrder::kFile, {SecondHalfEncoding::kRaw, kMostDegree, {}}).second_bytes;
}

// Entries of the FIFO of candidates, with room for the items in the pipeline before it.
std::uint32_t candidates_of(const GscoreConfig& config, const Datapath& cull) {
  return static_cast<std::uint32_t>(config.ccu.candidates +
                                    cycles_for(cull.depth_cycles, cull.interval_cycles()));
}

}  // namespace

Ccu::Ccu(const sc_core::sc_module_name& name, std::uint32_t index, const UnitContext& context)
    : sc_module(name),
      first_memory("first_memory", context.config.memory_port, context.clock.period()),
      second_memory("second_memory", context.config.memory_port, context.clock.period()),
      index_(index),
      config_(context.config),
      job_(context.job),
      cull_path_(cull_pipeline(config_)),
      convert_path_(convert_pipeline(config_, job_.layout.sh_degree())),
      first_bytes_(job_.layout.first_halves.record_bytes),
      second_bytes_(job_.layout.second_halves.record_bytes),
      load_("load", context.clock),
      cull_("cull", context.clock),
      fetch_("fetch", context.clock),
      convert_("convert", context.clock),
      input_(std::size_t{config_.ccu.input_slots} * config_.ccu.slice_gaussians * first_bytes_),
      second_halves_(std::size_t{config_.ccu.second_half_slots} * second_bytes_),
      slices_("slices", context.clock, config_.ccu.input_slots),
      free_input_("free_input", context.clock, config_.ccu.input_slots, 0),
      culled_("culled", context.clock, candidates_of(config_, cull_path_), cull_path_.depth_cycles),
      culled_places_(cull_path_.depth_cycles),
      fetched_("fetched", context.clock, config_.ccu.second_half_slots + 1),
      free_second_("free_second", context.clock, config_.ccu.second_half_slots,
                   words_of(second_bytes_)),
      converted_places_(convert_path_.depth_cycles) {
  for (std::uint32_t f = 0; f < job_.frames(); ++f) {
    sides_.push_back(frame_sides(job_.picture(f).view));
  }
  fetched_.announce_to(candidate_came_);
  for (Activity* a : {&load_, &cull_, &fetch_, &convert_}) context.phases.projecting.add(*a);
  SC_THREAD(run_load);
  SC_THREAD(run_cull);
  SC_THREAD(run_fetch);
  SC_THREAD(run_convert);
}

std::byte* Ccu::input(std::uint32_t slot, std::uint32_t at) {
  return input_.data() +
         (std::size_t{slot} * config_.ccu.slice_gaussians + at) * std::size_t{first_bytes_};
}

void Ccu::run_load() {
  for (std::uint32_t s = 0; s < config_.ccu.input_slots; ++s) free_input_.push(s, load_);
  if (config_.culls_chunks()) {
    load_visible();
  } else {
    load_passes();
  }
  Slice over;
  over.over = true;
  slices_.push(over, load_);
  load_.idles();
}

void Ccu::load_visible() {
  for (VisibleSlice next = visible->pop(load_); !next.over; next = visible->pop(load_)) {
    Slice slice;
    slice.first = next.first;
    slice.count = next.count;
    slice.frame = next.frame;
    slice.end_of_pass = next.end_of_pass;
    load(slice);
  }
}

// Every pass its own slices of the scene.
void Ccu::load_passes() {
  const std::uint32_t count = job_.layout.gaussian_count(), size = config_.ccu.slice_gaussians;
  for (Pass pass = passes->pop(load_); !pass.over; pass = passes->pop(load_)) {
    for (std::uint64_t first = std::uint64_t{index_} * size; first < count;
         first += std::uint64_t{config_.ccus} * size) {
      Slice slice;
      slice.first = static_cast<std::uint32_t>(first);
      slice.count = std::min(size, count - slice.first);
      slice.frame = job_.frame_of(pass.first);
      slice.end_of_pass = slice.first + slice.count == count;
      load(slice);
    }
  }
}

void Ccu::load(Slice slice) {
  slice.slot = free_input_.pop(load_, WaitFor::kRoom);
  load_.work(1);
  if (slice.count > 0) {
    slice.ticket = start_read(first_memory, load_, job_.layout.first_halves.address(slice.first),
                              input(slice.slot, 0), slice.count * first_bytes_,
                              job_.layout.first_halves.region);
  }
  counters_.first_halves += slice.count;
  slices_.push(slice, load_);
}

void Ccu::run_cull() {
  for (Slice slice = slices_.pop(cull_); !slice.over; slice = slices_.pop(cull_)) {
    if (slice.count > 0) {
      cull(slice);
    } else {
      pass_on_empty(slice);
    }
  }
  Candidate over;
  over.over = true;
  cull_.work(1);
  culled_.push(over, cull_);
  cull_.idles();
}

// The end of a slice goes with its last Gaussian, in its place if that is dropped.
void Ccu::cull(const Slice& slice) {
  const std::uint64_t interval = cull_path_.interval_cycles();
  await(first_memory, cull_, slice.ticket);
  for (std::uint32_t i = 0; i < slice.count; ++i) {
    culled_places_.wait_for_one(culled_, cull_);
    wait_for_turn(cull_, interval);
    const std::uint64_t began = cull_.clock().now_cycles();
    cull_.work(1);
    Candidate candidate;
    candidate.slot = slice.first + i;
    candidate.first = read_first_half(job_.layout.split, input(slice.slot, i));
    candidate.frame = slice.frame;
    candidate.there = may_touch_frame(job_.picture(slice.frame).view, sides_[slice.frame],
                                      candidate.first.mean, candidate.first.extents.scale_max);
    candidate.last = i + 1 == slice.count;
    candidate.end_of_pass = candidate.last && slice.end_of_pass;
    counters_.culled += candidate.there ? 0 : 1;
    if (candidate.there || candidate.last) {
      culled_.push(candidate, cull_);
    } else {
      culled_places_.add(began);
    }
    if (candidate.last) free_input_.push(slice.slot, cull_);
    cull_.work(interval - 1);
  }
}

// Nothing but the end of a pass.
void Ccu::pass_on_empty(const Slice& slice) {
  culled_places_.wait_for_one(culled_, cull_);
  cull_.work(1);
  Candidate end;
  end.last = true;
  end.end_of_pass = slice.end_of_pass;
  culled_.push(end, cull_);
  free_input_.push(slice.slot, cull_);
}

void Ccu::run_fetch() {
  for (std::uint32_t s = 0; s < config_.ccu.second_half_slots; ++s) free_second_.push(s, fetch_);
  std::vector<Candidate> slice;
  for (bool over = false; !over;) {
    slice.push_back(culled_.pop(fetch_));
    fetch_.work(1);
    over = slice.back().over;
    if (!over && !slice.back().last) continue;
    for (std::size_t first = 0; first < slice.size();) first = fetch_run(slice, first);
    counters_.gathered += slice.size();
    slice.clear();
  }
  fetch_.idles();
}

// Slots are taken and given back in turn.
std::size_t Ccu::fetch_run(std::vector<Candidate>& slice, std::size_t first) {
  std::size_t end = first + 1;
  if (slice[first].there) {
    slice[first].buffer = free_second_.pop(fetch_, WaitFor::kRoom);
    const std::uint32_t room = config_.ccu.second_half_slots - slice[first].buffer;
    const auto follows = [&] {
      return end < slice.size() && slice[end].there && end - first < room &&
             slice[end].slot == slice[end - 1].slot + 1;
    };
    for (; follows(); ++end) slice[end].buffer = free_second_.pop(fetch_, WaitFor::kRoom);
    const auto count = static_cast<std::uint32_t>(end - first);
    const std::uint64_t ticket =
        start_read(second_memory, fetch_, job_.layout.second_halves.address(slice[first].slot),
                   second_halves_.data() + std::size_t{slice[first].buffer} * second_bytes_,
                   count * second_bytes_, job_.layout.second_halves.region);
    for (std::size_t k = first; k < end; ++k) slice[k].ticket = ticket;
    counters_.second_halves += count;
    ++counters_.runs;
  }
  for (std::size_t k = first; k < end; ++k) {
    fetched_.push(slice[k], fetch_);
    fetch_.work(1);
  }
  return end;
}

void Ccu::run_convert() {
  while (!fetched_.front(convert_).over) {
    if (fetched_.front(convert_).there) {
      convert();
    } else {
      converted_places_.wait_for_one(*converted[0], convert_);
      pass_end();
    }
  }
  fetched_.remove_front();
  convert_.idles();
}

// Passes on the end of a slice whose last Gaussian was dropped; there is a place for it.
void Ccu::pass_end() {
  Converted end;
  end.last = true;
  end.end_of_pass = fetched_.front(convert_).end_of_pass;
  fetched_.remove_front();
  convert_.work(1);
  converted->push(end, convert_);
}

// A candidate stays where it is until its turn. A record leaves its buffer a word a cycle.
void Ccu::convert() {
  const Candidate candidate = fetched_.front(convert_);
  await(second_memory, convert_, candidate.ticket);
  converted_places_.wait_for_one(*converted[0], convert_);
  const std::uint64_t interval = convert_path_.interval_cycles();
  wait_for_turn(convert_, interval);
  const std::byte* record = second_halves_.data() + std::size_t{candidate.buffer} * second_bytes_;
  const DecodedGaussian g =
      read_record(job_.layout.split, job_.layout.second_half, candidate.first.mean,
                  candidate.first.carried, record, nullptr);
  fetched_.remove_front();
  free_second_.push(candidate.buffer, convert_);
  ++counters_.converted;
  const std::uint64_t began = convert_.clock().now_cycles();
  const std::uint64_t until = began + std::max<std::uint64_t>(interval, words_of(second_bytes_));
  convert_.works_until(until);
  convert_.work(1);
  Converted out;
  out.last = candidate.last;
  out.end_of_pass = candidate.end_of_pass;
  const auto convert_for = [&](std::uint32_t eye, ConvertedForEye& into) {
    const View<float>& view = job_.picture(candidate.frame, eye).view;
    into.there =
        make_tile_geometry(view, g.gaussian, config_.tiles.rules(), into.splat, into.boxes);
    if (into.there) {
      add_colour(view, job_.layout.sh_degree(), g.gaussian.mean, g.sh, into.splat);
    }
  };
  convert_for(0, out);
  if (job_.eyes > 1) convert_for(1, out.right);
  counters_.unseen += out.any_there() ? 0 : 1;
  if (out.any_there() || out.last) {
    converted->push(out, convert_);
  } else {
    converted_places_.add(began);
  }
  keep_lanes(until);
}

// Keeps the lanes busy until a cycle in which they are free; ends of slices pass beside them.
void Ccu::keep_lanes(std::uint64_t until) {
  while (comes_before(until)) {
    const Candidate& next = fetched_.front(convert_);
    if (next.there || next.over) break;
    if (!converted_places_.wait_for_one(*converted[0], convert_, until)) break;
    pass_end();
  }
  const std::uint64_t now = convert_.clock().now_cycles();
  if (now < until) convert_.work(until - now);
}

// True if a candidate can be taken before that cycle; waits for it or the cycle.
bool Ccu::comes_before(std::uint64_t cycle) {
  const ClockDomain& clock = convert_.clock();
  while (clock.now_cycles() < cycle) {
    if (fetched_.can_pop()) return true;
    const sc_core::sc_time left = static_cast<double>(cycle - clock.now_cycles()) * clock.period();
    if (fetched_.empty()) {
      sc_core::wait(left, candidate_came_);
    } else {
      sc_core::wait(std::min(left, fetched_.ready_at() - sc_core::sc_time_stamp()));
    }
  }
  return false;
}

SramUses Ccu::sram_uses(const GscoreConfig& config) {
  const CcuConfig& c = config.ccu;
  const Datapath cull = cull_pipeline(config);
  const std::uint32_t first_bytes = config.first_half_bytes();
  const std::uint32_t candidate_bytes = Candidate::sram_bytes(config.carried_words());
  // First halves that come from memory in a cycle, of one read: so many banks take them.
  const std::uint32_t come =
      std::min(static_cast<std::uint32_t>(cycles_for(kPortBytes, first_bytes)), c.slice_gaussians);
  SramUses uses = {
      sram_use(kInput, kBuffer,
               {{c.input_slots, "slots"}, {c.slice_gaussians, "Gaussians"}, {first_bytes, "B"}},
               {8 * first_bytes, SramPorts::kReadAndWrite, come}, {1, come}),
      sram_use(kSecondHalves, kBuffer,
               {{c.second_half_slots, "slots"}, {most_second_half_bytes(), "B"}}, {8 * kPortBytes},
               kOneOfEach),
      fifo_use<Slice>(kSlices, kBuffer, c.input_slots, "slices"),
      fifo_use<Candidate>(kCulled, kBuffer, candidates_of(config, cull), "candidates",
                          candidate_bytes),
      sram_use(kGathered, kBuffer, {{c.slice_gaussians, "candidates"}, {candidate_bytes, "B"}},
               {8 * candidate_bytes}, kOneOfEach),
      fifo_use<Candidate>(kFetched, kBuffer, c.second_half_slots + 1, "candidates",
                          candidate_bytes)};
  add(uses, outstanding_table(kBuffer, config.memory_port), 2);
  return uses;
}

void Ccu::publish(DataSheet& sheet) {
  sheet.unit(*this);
  sheet.activity(load_, "ccu load", "fetches first halves");
  sheet.activity(cull_, "ccu cull", "drops what cannot touch the frame");
  sheet.activity(fetch_, "ccu fetch", "asks for second halves");
  sheet.activity(convert_, "ccu convert", "projects and colours");
  sheet.counters(counters_);
  sheet.datapath(cull_path_, counters_.first_halves);
  sheet.datapath(convert_path_, counters_.converted);
  sheet.sram(sram_uses(config_));
  sheet.accesses(kInput, counters_.first_halves, counters_.first_halves);
  const std::uint64_t words = words_of(second_bytes_);
  sheet.accesses(kSecondHalves, counters_.converted * words, counters_.second_halves * words);
  sheet.accesses(kGathered, counters_.gathered, counters_.gathered);
  sheet.queue(slices_, kSlices);
  sheet.queue(culled_, kCulled);
  sheet.queue(fetched_, kFetched);
  sheet.port(first_memory);
  sheet.port(second_memory);
  sheet.left_out("gaussians_off_frame", "centre and largest scale: they cannot touch the frame",
                 counters_.culled, "second halves and conversion");
  sheet.remedy(cull_, "ccu.cull_lanes");
  sheet.remedy(convert_, "ccu.convert_lanes");
  sheet.remedy(first_memory, WaitFor::kReads, "ccu.input_slots");
  sheet.remedy(second_memory, WaitFor::kReads, "ccu.second_half_slots");
  sheet.remedy(first_memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.remedy(second_memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.remedy(slices_, WaitFor::kRoom, "ccu.input_slots");
  sheet.remedy(free_input_, WaitFor::kRoom, "ccu.input_slots");
  sheet.remedy(culled_, WaitFor::kRoom, "ccu.candidates");
  sheet.remedy(fetched_, WaitFor::kRoom, "ccu.second_half_slots");
  sheet.remedy(free_second_, WaitFor::kRoom, "ccu.second_half_slots");
  sheet.may_help("ccus");
}

}  // namespace sgs::gscore
