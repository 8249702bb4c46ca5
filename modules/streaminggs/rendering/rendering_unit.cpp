// The two threads of the rendering unit.
#include "modules/streaminggs/rendering/rendering_unit.h"

#include <algorithm>

#include "algorithm/memory/splat_record.h"
#include "algorithm/splat/filter_work.h"
#include "modules/datapath/work_rates.h"

namespace sgs {
namespace {

constexpr std::uint32_t kSubtileNumberBytes = 2;
constexpr const char* kBegunSpans = "begun spans";
constexpr std::uint32_t kBegunSpanBytes = 4 * kBegunSpanWords;

// Of each row of sub-tiles the first and the last that a splat reaches, or none: of rows that leave
// the lanes at once each in a bank of its own, a row a cycle to the dispatcher.
SramUse spans_use(const RenderingConfig& config, const PixelSize& group) {
  const auto rows = static_cast<std::uint32_t>((group.height + kSubtilePx - 1) / kSubtilePx);
  const auto columns = static_cast<std::uint32_t>((group.width + kSubtilePx - 1) / kSubtilePx);
  std::uint32_t bits = 1;
  while ((1U << bits) < columns) ++bits;
  const std::uint32_t at_once = std::min(config.spans_at_once(), std::max(1U, rows));
  return sram_use("spans", kSharedSram,
                  {{config.span_slots, "slots"}, {(rows * 2 * bits + 7) / 8, "B"}},
                  {2 * bits, SramPorts::kReadAndWrite, at_once}, {1, at_once});
}

// Of the dispatcher, for the first sub-tile of each cluster in what is left of a row: x & -x of its
// bits.
std::uint32_t row_comparators(const PixelSize& group, std::uint32_t clusters) {
  constexpr std::uint64_t kComparatorBits = 32;
  const auto columns = cycles_for(static_cast<std::uint64_t>(group.width), kSubtilePx);
  return clusters * static_cast<std::uint32_t>(cycles_for(columns, kComparatorBits));
}

}  // namespace

RenderingUnit::RenderingUnit(const sc_core::sc_module_name& name, const RenderingConfig& config,
                             Arrival arrival, const UnitContext& context,
                             std::function<void()> on_done)
    : sc_module(name),
      memory("memory", context.built_for.memory_port, context.clock.period()),
      config_(config),
      built_for_(context.built_for),
      job_(context.job),
      arrival_(arrival),
      on_done_(std::move(on_done)),
      blend_("blend", context.clock),
      drain_("drain", context.clock),
      finished_("finished", context.clock, config.pixel_buffers,
                config.depth_cycles + config.drain_depth_cycles),
      free_buffers_("free_buffers", context.clock, config.pixel_buffers, 0),
      schedule_(config_) {
  SC_THREAD(run_blend);
  SC_THREAD(run_drain);
}

void RenderingUnit::run_blend() {
  std::size_t turn = 0;
  std::uint64_t ended = 0;
  for (std::uint32_t group = 0; group < job_.groups.size(); ++group) {
    blend_.takes_up_group(group);
    free_buffers_.pop(blend_, WaitFor::kRoom);
    current_group_ = group;
    auto state = std::make_shared<GroupState>(
        job_.groups[group], job_.view.width, job_.view.height, config_.precision,
        config_.ellipse_test ? SubtileTest::kEllipse : SubtileTest::kBox);
    schedule_.begin_group(state->subtile_count(), state->subtile_columns());
    for (Mark mark = Mark::kNone; mark != Mark::kEndOfGroup;) {
      const SplatToken token = in_turn(splats, turn).pop(blend_);
      mark = token.mark;
      if (arrival_ == Arrival::kByVisit) blend_.takes_up_group(group, token.visit);
      if (mark == Mark::kNone) {
        blend_splat(token.splat, group, *state);
      } else {
        blend_.work(1);
      }
      turn += mark != Mark::kNone || arrival_ == Arrival::kByToken ? 1 : 0;
    }
    ++counters_.groups;
    counters_.groups_saturated += state->saturated() && !state->pixels().empty() ? 1 : 0;
    counters_.contributors += state->contributors();
    work_until(schedule_.all_done());
    finished_.push(std::move(state), blend_);
    const std::uint64_t now = blend_.clock().now_cycles();
    cycles_of_groups_.push_back(now - ended);
    ended = now;
  }
  blend_.idles();
}

void RenderingUnit::work_until(std::uint64_t cycle) {
  const std::uint64_t now = blend_.clock().now_cycles();
  if (cycle > now) blend_.work(cycle - now);
}

void RenderingUnit::blend_splat(const Splat& splat, std::uint32_t group, GroupState& state) {
  const std::uint64_t now = blend_.clock().now_cycles();
  const bool was_saturated = state.saturated();
  const SplatBox box = state.box_of(splat);
  if (!schedule_.any_unfinished(box.subtiles, now)) {
    const bool all = was_saturated && now >= schedule_.group_finished_from();
    ++(all ? counters_.splats_saturated : counters_.splats_hidden);
    blend_.work(1);
    return;
  }
  ++counters_.splats_taken;
  schedule_.begin_splat(now, box.spanned);
  const BlendWork work = state.blend_scheduled(splat, [&](const SubtileReach& subtile) {
    schedule_.reach(subtile);
    if (subtile.finishes) tell_finished(group, subtile.at, now);
  });
  counters_.spans += work.spans;
  counters_.begun_span_reads += cycles_for(work.spans, config_.spans_at_once());
  counters_.splats_spanned += work.spans > 0 ? 1 : 0;
  counters_.splats += work.blended > 0 ? 1 : 0;
  // The last transmittance is known when the blend has left the pipeline.
  if (state.saturated() && !was_saturated && config_.saturation_feedback) {
    finish->finish(group, static_cast<std::uint32_t>(schedule_.group_finished_from() - now));
  }
  work_until(schedule_.end_splat(work.rows, work.spans));
}

void RenderingUnit::tell_finished(std::uint32_t group, std::size_t at, std::uint64_t now) {
  if (finish_subtile.size() == 0 || !config_.saturation_feedback) return;
  const std::uint64_t known = schedule_.subtile_finished_from(at);
  finish_subtile->finish(group, at, static_cast<std::uint32_t>(known - now));
}

void RenderingUnit::run_drain() {
  for (std::uint32_t buffer = 0; buffer < config_.pixel_buffers; ++buffer) {
    free_buffers_.push(buffer, drain_);
  }
  for (std::size_t done = 0; done < job_.groups.size(); ++done) {
    drain_.takes_up_group(static_cast<std::uint32_t>(done));
    const std::shared_ptr<GroupState> state = finished_.pop(drain_);
    memory.charge_to(done);
    write_group(*state);
    free_buffers_.push(0, drain_);
  }
  await_all(memory, drain_);
  drain_.idles();
  on_done_();
}

void RenderingUnit::write_group(const GroupState& state) {
  const PixelRect& pixels = state.pixels();
  const auto width = static_cast<std::uint32_t>(pixels.width());
  const std::uint32_t bytes = pixel_bytes(job_.frame_format);
  std::vector<std::byte> row(std::size_t{width} * bytes);
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; ++x) {
      encode_pixel(job_.frame_format, state.colour(x, y, job_.background),
                   row.data() + static_cast<std::size_t>(x - pixels.x0) * bytes);
    }
    drain_.work(config_.drain_row_cycles(width));
    start_write(memory, drain_, job_.pixel_address(pixels.x0, y), row.data(),
                static_cast<std::uint32_t>(row.size()), job_.frame_buffer.region);
  }
  // A sub-tile is cleared in the cycle after its last row was read: all but the last while others
  // are drained.
  if (!pixels.empty()) drain_.work(kClearCycles);
}

void RenderingUnit::assume(const Work& work) {
  counters_ = work.counters;
  schedule_.assume(work.clusters);
  blend_.assume(work.blend_cycles);
  drain_.assume(work.drain_cycles);
  cycles_of_groups_ = work.cycles_of_groups;
  finished_.assume(work.counters.groups);
  memory.assume(work.traffic);
}

// A memory for each place of a pixel in a sub-tile, in each cluster: a blend reads and writes all
// 16 of a sub-tile at once, each its pixel. Whether a pixel is finished is known when it has been
// read, so all of them are. A row is converted as it leaves: until a write of it is made its pixels
// are in their buffer.
SramUses RenderingUnit::sram_uses(const RenderingConfig& config, const BuiltFor& built_for) {
  const auto width = static_cast<std::uint32_t>(built_for.group.width);
  const auto height = static_cast<std::uint32_t>(built_for.group.height);
  // A group that drains and one that is blended have memories of their own. A cluster without a
  // sub-tile of any group has none.
  const auto subtiles =
      static_cast<std::uint32_t>(cycles_for(width, kSubtilePx) * cycles_for(height, kSubtilePx));
  const std::uint32_t with_pixels = std::clamp(subtiles, 1U, config.clusters);
  const std::uint32_t pixel_banks = kSubtilePixels * with_pixels * config.pixel_buffers;
  const SramPeak of_clusters{config.clusters, config.clusters};
  return {sram_use("pixel state", kSharedSram,
                   {{config.pixel_buffers, "groups"},
                    {width, "px"},
                    {height, "px"},
                    {config.pixel_state_bytes(), "B"}},
                   {8 * config.pixel_state_bytes(), SramPorts::kReadAndWrite, pixel_banks},
                   {pixel_banks, pixel_banks}),
          sram_use("splats under way", kSharedSram,
                   {{config.span_slots, "slots"}, {kSplatEntryBytes, "B"}}, {8 * kSplatEntryBytes},
                   kOneOfEach),
          sram_use(kBegunSpans, kSharedSram, {{config.span_slots, "slots"}, {kBegunSpanBytes, "B"}},
                   {8 * kBegunSpanBytes}, kOneOfEach),
          spans_use(config, built_for.group),
          sram_use("cluster queues", kSharedSram,
                   {{config.clusters, "clusters"},
                    {config.cluster_queue_entries, "splats"},
                    {kSplatEntryBytes, "B"}},
                   {8 * kSplatEntryBytes, SramPorts::kReadAndWrite, config.clusters}, of_clusters),
          mask_use(built_for.group),
          outstanding_table(kSharedSram, built_for.memory_port),
          sram_use("sub-tiles in the loop", kSharedSram,
                   {{config.clusters, "clusters"},
                    {config.subtiles_in_loop(), "sub-tiles"},
                    {kSubtileNumberBytes, "B"}},
                   {8 * kSubtileNumberBytes * config.subtiles_in_loop(), SramPorts::kReadAndWrite,
                    config.clusters},
                   of_clusters),
          unanswered_writes("pixel writes", kSharedSram, built_for.memory_port,
                            width * pixel_bytes(built_for.frame_format))};
}

void RenderingUnit::publish_ledger(DataSheet& sheet) {
  const ClusterSchedule::Counters& clusters = schedule_.counters();
  const bool in_half = config_.precision == BlendPrecision::kHalf;
  sheet.datapath(conic_pipeline(built_for_.single), counters_.splats_taken);
  sheet.datapath(blend_pipeline(config_, in_half ? built_for_.half : built_for_.single),
                 clusters.blends);
  sheet.datapath(begin_pipeline(config_, built_for_.single), counters_.splats_spanned);
  sheet.datapath(span_pipeline(config_, built_for_.single), counters_.spans);
  sheet.accesses(kBegunSpans, counters_.begun_span_reads, counters_.splats_spanned);
  sheet.accesses("splats under way", counters_.splats_taken, counters_.splats_taken);
  sheet.accesses("spans", counters_.spans, counters_.spans);
  sheet.accesses("cluster queues", clusters.blends, clusters.blends);
  publish_dispatcher(sheet);
  publish_pixels(sheet);
  sheet.port(memory, "pixel writes");
}

void RenderingUnit::publish_dispatcher(DataSheet& sheet) {
  const ClusterSchedule::Counters& clusters = schedule_.counters();
  // Whether a splat's footprint is finished is asked of all rows at once, when it is taken.
  const std::uint64_t dropped = counters_.splats_hidden + counters_.splats_saturated;
  const double of_splat = mask_comparators(built_for_.group);
  const double of_row = row_comparators(built_for_.group, config_.clusters);
  // The head of a queue against all sub-tiles in the loop, in every cycle that it is looked at.
  const double of_loop = config_.subtiles_in_loop();
  // The splat whose rows go out.
  sheet.part("rendering", "register_bit", 8 * kSplatEntryBytes, 1);
  sheet.operations("rendering", "register_bit",
                   8 * kSplatEntryBytes * static_cast<double>(counters_.splats_taken));
  const auto looks = clusters.blends + clusters.hazard_cycles;
  sheet.part("rendering", "comparator", of_splat + of_row + config_.clusters * of_loop, 1);
  sheet.operations("rendering", "comparator",
                   of_splat * static_cast<double>(counters_.splats_taken + dropped) +
                       of_row * static_cast<double>(clusters.row_cycles) +
                       of_loop * static_cast<double>(looks));
  const std::uint64_t bits = mask_bits(built_for_.group);
  sheet.accesses("finished sub-tiles",
                 bits * (dropped + counters_.splats_taken + clusters.row_cycles),
                 clusters.finished + bits * counters_.groups);
  sheet.accesses("sub-tiles in the loop", looks, clusters.blends);
}

// Each blend reads and writes a sub-tile. Draining reads it once for each row of pixels, and clears
// it.
void RenderingUnit::publish_pixels(DataSheet& sheet) {
  std::uint64_t drained = 0, cleared = 0, pixels = 0;
  for (std::uint64_t group = 0; group < counters_.groups; ++group) {
    const PixelRect& px = job_.groups[group];
    const auto width = static_cast<std::uint64_t>(px.width());
    const auto height = static_cast<std::uint64_t>(px.height());
    drained += height * cycles_for(width, kSubtilePx);
    cleared += cycles_for(height, kSubtilePx) * cycles_for(width, kSubtilePx);
    pixels += width * height;
  }
  const std::uint64_t blends = schedule_.counters().blends;
  sheet.datapath(drain_pipeline(config_, job_.frame_format, built_for_.single), pixels);
  // A blend reads and writes all places of a sub-tile, draining those of a row, clearing all again.
  sheet.accesses("pixel state", kSubtilePixels * blends + kSubtilePx * drained,
                 kSubtilePixels * (blends + cleared));
}

void RenderingUnit::publish(DataSheet& sheet) {
  sheet.unit(*this);
  sheet.activity(blend_, "rendering", "blends sorted splats into the pixels of a group");
  sheet.activity(drain_, "drain", "writes finished pixels");
  sheet.counter("groups", "groups", "rendered", counters_.groups);
  sheet.counter("groups_saturated", "groups", "of these with every pixel finished early",
                counters_.groups_saturated);
  sheet.counter("splats", "splats", "blended into at least one sub-tile", counters_.splats);
  sheet.counter("splats_taken", "splats", "sent on to the clusters, whether they reach any or not",
                counters_.splats_taken);
  sheet.counter("splats_saturated", "splats", "that came when their group was finished",
                counters_.splats_saturated);
  sheet.counter("splats_hidden", "splats",
                "that came when all sub-tiles of their footprint were finished",
                counters_.splats_hidden);
  sheet.counter("rows", "rows", "of sub-tiles that the dispatcher took", schedule_.counters().rows);
  sheet.counter("splats_spanned", "splats", "on more sub-tiles than a few: rows got spans",
                counters_.splats_spanned);
  sheet.counter("spans", "rows", "of sub-tiles whose span in the ellipse was computed",
                counters_.spans);
  const ClusterSchedule::Counters& clusters = schedule_.counters();
  sheet.counter("subtile_blends", "sub-tiles", "blended", clusters.blends);
  sheet.counter("subtile_blends_late", "sub-tiles",
                "of these finished already, which was not known yet", clusters.late_blends);
  sheet.counter("hazard_cycles", "cycles", "that clusters waited for the splat ahead on a sub-tile",
                clusters.hazard_cycles);
  sheet.counter("queue_cycles", "cycles", "that sub-tiles waited for room at their cluster",
                clusters.queue_cycles);
  sheet.counter("contributors", "pixels", "blended with an alpha above 1/255",
                counters_.contributors);
  sheet.by_part("cycles", "cycles", "of rendering, from the end of the group before",
                cycles_of_groups_);
  publish_ledger(sheet);
  // All three work at the same time, on different splats.
  const bool by_rows = clusters.span_cycles > clusters.begin_cycles;
  const char* lanes = by_rows ? "rendering.span_lanes" : "rendering.begin_lanes";
  const bool by_lanes =
      std::max(clusters.span_cycles, clusters.begin_cycles) > schedule_.cluster_cycles();
  sheet.remedy(blend_, by_lanes ? lanes : "rendering.clusters");
  for (const char* key : {"rendering.clusters", "rendering.cluster_lanes", "rendering.begin_lanes",
                          "rendering.span_lanes", "rendering.span_slots"}) {
    sheet.may_help(key);
  }
  sheet.remedy(drain_, "rendering.drain_pixels_per_cycle");
  sheet.remedy(memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.sram(sram_uses(config_, built_for_));
  sheet.queue(finished_, "pixel state");
  sheet.remedy(finished_, WaitFor::kRoom, "rendering.pixel_buffers");
  sheet.remedy(free_buffers_, WaitFor::kRoom, "rendering.pixel_buffers");
  sheet.signal("group", current_group_);
}

}  // namespace sgs
