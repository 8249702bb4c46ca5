// The threads of VSU.
#include "modules/streaminggs/vsu/paper_vsu.h"

#include <algorithm>

#include "algorithm/voxel/ray_path.h"
#include "algorithm/voxel/ray_sampling.h"
#include "algorithm/voxel/voxel_grid.h"
#include "modules/datapath/work_rates.h"
#include "modules/streaminggs/spare_parts.h"
#include "modules/streaminggs/vsu/rays_in_flight.h"

namespace sgs {
namespace {

// Open pieces of a voxel that is being cut: one for each halving of its count; first slot and
// count.
constexpr std::uint32_t kOpenPieces = 32, kPieceBytes = 8;

// Registers for the pixels of the group whose rays are followed, and of the next.
constexpr std::uint32_t kGroupBits = 4 * 16;

}  // namespace

PaperVsu::PaperVsu(const sc_core::sc_module_name& name, const PaperVsuConfig& config,
                   const UnitContext& context)
    : sc_module(name),
      node_memory("node_memory", context.built_for.memory_port, context.clock.period()),
      record_memory("record_memory", context.built_for.memory_port, context.clock.period()),
      config_(config),
      built_for_(context.built_for),
      job_(context.job),
      traverse_("traverse", context.clock),
      emit_("emit", context.clock),
      records_(config.record_cache_bytes, job_.layout.voxel_table().voxels),
      cuts_(config.cut_cache_bytes, job_.layout.voxel_table().cuts),
      table_(job_.layout.voxel_table().voxels.count, config.table_bytes,
             config.line_destinations()),
      numbers_in_turn_(group_numbers(group_flow(GroupUse::kRays), context.built_for.single)),
      ordered_("ordered", context.clock, config.groups_ahead) {
  SC_THREAD(run_traverse);
  SC_THREAD(run_emit);
  const OperationLatencies& latencies = context.built_for.single;
  if (config.samples()) {
    samples_ =
        std::make_unique<SampledRays>(config, latencies, traverse_, node_memory, job_, lists());
    return;
  }
  rays_ = std::make_unique<RayUnit>(config, latencies, context.clock, traverse_, node_memory,
                                    job_.layout.voxel_table().nodes, lists());
  SC_THREAD(run_arrivals);
}

ListsOut PaperVsu::lists() {
  return {[this] { ordered_.wait_for_room(1, TimedFifo<OrderedPass>::kNever, traverse_); },
          [this](const std::vector<std::uint32_t>& voxels, bool last) { hand_over(voxels, last); }};
}

void PaperVsu::run_traverse() {
  const ClockDomain& clock = traverse_.clock();
  std::uint64_t has_registers = 0;  // from this cycle on
  for (std::uint32_t group = 0; group < job_.groups.size(); ++group) {
    current_group_ = group;
    if (job_.begins_frame(group) && take_up_frame(job_.frame_of(group))) {
      has_registers = clock.now_cycles();
    }
    take_up_group(traverse_, node_memory, group);
    const std::uint64_t now = clock.now_cycles();
    traverse_.work(std::max(now, numbers_in_turn_.stand(has_registers)) - now);
    const std::uint64_t from = clock.now_cycles();
    has_registers = from + 1;
    const GroupVisits visits = order_group(group);
    const std::uint64_t cycles = clock.now_cycles() - from;
    (visits.overflows > 0 ? cycles_of_full_tables_ : cycles_of_others_) += cycles;
    if (visits.voxels.empty()) ++counters_.groups_empty;
    counters_.rays += visits.rays;
    counters_.steps += visits.steps;
    counters_.edges += visits.edges_offered;
    counters_.overflows += visits.overflows;
    counters_.ordering_table_bytes_max.raise_to(visits.table_bytes);
  }
  traverse_.idles();
}

// True if its pose had to be awaited.
bool PaperVsu::take_up_frame(std::uint32_t frame) {
  const bool known = pose_known(host, frame);
  await_pose(host, frame, traverse_);
  if (samples_) samples_->take_up_view(job_.picture(frame).view);
  return !known;
}

GroupVisits PaperVsu::order_group(std::uint32_t group) {
  const PixelRect& pixels = job_.groups[group];
  const View<float>& view = job_.view_of(group);
  const VoxelTableLayout& voxels = job_.layout.voxel_table();
  if (voxels.nodes.count == 0) {
    hand_over({}, true);
    return {};
  }
  if (samples_) return group_visits(pixels, *samples_, table_);
  if (config_.sample_step_voxels > 0) {
    const SamplePath path(voxels.frame, config_.rays().sample_step_voxels);
    RaysInFlight in_flight(view, path, *rays_);
    return group_visits(pixels, in_flight, table_);
  }
  RaysInFlight in_flight(view, RayPath<float>(voxels.frame), *rays_);
  return group_visits(pixels, in_flight, table_);
}

void PaperVsu::run_arrivals() { rays_->fetches.run_arrivals(node_memory, traverse_.clock()); }

void PaperVsu::hand_over(const std::vector<std::uint32_t>& voxels, bool last) {
  ++counters_.passes;
  ordered_.push({current_group_, last, voxels}, traverse_);
}

void PaperVsu::run_emit() {
  for (std::size_t done = 0; done < job_.groups.size();) {
    const OrderedPass& ordered = ordered_.front(emit_);
    const std::uint32_t group = ordered.group;
    const bool last = ordered.last;
    take_up_group(emit_, record_memory, group);
    for (const std::uint32_t voxel : ordered.voxels) {
      if (all_finished(finished, group)) {
        ++counters_.visits_saturated;  // the rest of the list is forgotten at once
        continue;
      }
      visit_voxel(group, voxel);
    }
    ordered_.remove_front();
    if (!last) continue;
    mark_end(group);
    ++done;
  }
  emit_.idles();
}

void PaperVsu::visit_voxel(std::uint32_t group, std::uint32_t voxel) {
  current_voxel_ = voxel;
  ++counters_.voxels;
  const auto plane = [&](std::uint32_t index) {
    emit_.work(1);
    ++counters_.cuts;
    return cuts_.get(index, record_memory, emit_);
  };
  const auto visit = [&](const VoxelRecord& piece) {
    hand_out(group, piece);
    return !all_finished(finished, group);
  };
  visit_pieces(records_.get(voxel, record_memory, emit_), job_.view_of(group).position,
               config_.visit_gaussians, plane, visit);
}

// Splits a visit into contiguous shares of even size, one for each fetch, no smaller than min_share
// and whole bursts of first halves; which begins rotates, so that small visits spread.
void PaperVsu::hand_out(std::uint32_t group, const VoxelRecord& piece) {
  const auto fetches = static_cast<std::uint32_t>(shares.size());
  const std::uint32_t unit = std::max(2U, config_.min_share);
  const std::uint32_t share =
      static_cast<std::uint32_t>(cycles_for(cycles_for(piece.count, fetches), unit)) * unit;
  emit_.takes_up_group(group, next_visit_);
  emit_.work(1);
  for (std::uint32_t k = 0; k < fetches; ++k) {
    const std::uint32_t begin = std::min(k * share, piece.count);
    const std::uint32_t end = std::min(begin + share, piece.count);
    in_turn(shares, k + next_visit_)
        .push({group, next_visit_, piece.first + begin, end - begin, Mark::kEndOfVisit}, emit_);
  }
  ++next_visit_;
  ++counters_.visits;
}

void PaperVsu::mark_end(std::uint32_t group) {
  emit_.work(1);
  for (int k = 0; k < shares.size(); ++k) {
    shares[k]->push({group, next_visit_, 0, 0, Mark::kEndOfGroup}, emit_);
  }
  ++next_visit_;
}

SramUses PaperVsu::sram_uses(const PaperVsuConfig& config, const BuiltFor& built_for) {
  // A table of b bytes orders at most b / 8 voxels; each waits as a 4-byte id.
  SramUses uses =
      config.samples() ? SampledRays::sram_uses(config, built_for) : RayUnit::sram_uses(config);
  add(uses, TableCache<VoxelRecord>::sram_uses("record cache", "record cache tags", kSharedSram,
                                               config.record_cache_bytes));
  add(uses, TableCache<float>::sram_uses("cut cache", "cut cache tags", kSharedSram,
                                         config.cut_cache_bytes));
  uses.push_back(sram_use("open pieces", kSharedSram, {{kOpenPieces, "pieces"}, {kPieceBytes, "B"}},
                          {8 * kPieceBytes}, kOneOfEach));
  uses.push_back(sram_use("ordered voxels", kSharedSram,
                          {{config.groups_ahead, "groups"}, {config.table_bytes / 2, "B"}}, {32},
                          kOneOfEach));
  add(uses, outstanding_table(kSharedSram, built_for.memory_port), 2);  // tables of both ports
  return uses;
}

void PaperVsu::publish(DataSheet& sheet) {
  sheet.unit(*this);
  sheet.activity(traverse_, "vsu", "follows rays and orders the voxels of a group");
  sheet.activity(emit_, "visits", "hands out ordered voxels as visits");
  sheet.counters(counters_);
  if (rays_) sheet.counter("node_cache_misses", "nodes", "read from DRAM", rays_->nodes.misses());
  sheet.counter("cut_cache_misses", "planes", "of cut voxels read from DRAM", cuts_.misses());
  sheet.counter("record_cache_misses", "voxel records", "read from DRAM", records_.misses());
  numbers_in_turn_.publish(sheet, "vsu");
  sheet.part("vsu", "register_bit", 2.0 * kGroupBits, 1);
  sheet.operations("vsu", "register_bit",
                   double{kGroupBits} * static_cast<double>(numbers_in_turn_.groups()));
  samples_ ? samples_->publish(sheet) : rays_->publish(sheet);
  records_.publish_accesses(sheet, "record cache", "record cache tags");
  cuts_.publish_accesses(sheet, "cut cache", "cut cache tags");
  // A voxel is entered, and taken in two for each cut; what is visited is taken.
  sheet.accesses("open pieces", counters_.visits + counters_.cuts,
                 counters_.voxels + 2 * counters_.cuts);
  // The eye lies before or behind a cut; a look-up with the tags of a set.
  sheet.part("vsu", "comparator", 1 + 2.0 * kCacheWays, 1);
  sheet.operations(
      "vsu", "comparator",
      static_cast<double>(counters_.cuts + kCacheWays * (records_.lookups() + cuts_.lookups())));
  sheet.accesses("ordered voxels", counters_.voxels, counters_.voxels + counters_.visits_saturated);
  sheet.left_out("empty_groups", "no block of Gaussians can touch them", counters_.groups_empty,
                 "no visit, no blending");
  sheet.left_out("saturated_visits", "every pixel of the group was finished",
                 counters_.visits_saturated, "their Gaussians are not streamed");
  publish_spare(sheet, "spare_table_bytes", "vsu.table_bytes", config_.table_bytes,
                counters_.ordering_table_bytes_max, config_.least_table_bytes());
  samples_ ? sheet.port(node_memory, "adjacency writes") : sheet.port(node_memory);
  sheet.port(record_memory);
  // Where the table is full a group's rays are followed again.
  const Remedy of_rays = samples_ ? samples_->remedy() : rays_->remedy();
  sheet.remedy(traverse_,
               cycles_of_full_tables_ > cycles_of_others_ ? Remedy("vsu.table_bytes") : of_rays);
  for (const char* key : samples_ ? SampledRays::kMayHelp : RayUnit::kMayHelp) {
    sheet.may_help(key);
  }
  sheet.remedy(node_memory, WaitFor::kReads,
               samples_ ? samples_->remedy_of_reads() : Remedy("vsu.node_cache_bytes"));
  sheet.remedy(record_memory, WaitFor::kReads, "vsu.record_cache_bytes");
  sheet.sram(sram_uses(config_, built_for_));
  sheet.queue(ordered_, "ordered voxels");
  sheet.remedy(ordered_, WaitFor::kRoom, "vsu.groups_ahead");
  sheet.signal("group", current_group_);
  sheet.signal("voxel", current_voxel_);
}

}  // namespace sgs
