// Expected pixels and counts, and the run that is held against them.
#include "testbench/units/rendering_run.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>
#include <vector>

#include "algorithm/memory/splat_record.h"
#include "algorithm/render/group_state.h"
#include "modules/datapath/lane_steps.h"
#include "modules/datapath/rendering_flows.h"
#include "modules/datapath/selection.h"
#include "testbench/units/job_memory.h"

namespace sgs::tb {
namespace {

std::uint64_t ceil_div(std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; }

bool has_one_port(const RenderingPlan& plan) { return plan.config.pixel_ports == 1; }

// Pixels of a sub-tile whose results come in the cycle in which their only port is read for
// another, and in the last cycle of the schedule.
std::uint64_t late_pixels(const RenderingPlan& plan, const BuiltFor& built_for) {
  if (!has_one_port(plan)) return 0;
  const Datapath blend = blend_pipeline(
      plan.config, in_16_bits(plan.config.precision) ? built_for.half : built_for.single);
  const std::uint32_t turn = plan.config.cluster_interval_cycles();
  return static_cast<std::uint64_t>(
      std::count_if(blend.loops.begin(), blend.loops.end(), [&](const DatapathLoop& pixel) {
        const std::uint32_t read = pixel.arrival - 1;
        return pixel.end % turn == read % turn && pixel.end == blend.depth_cycles;
      }));
}

// Subtractions that divide up to `most` by the clusters, where that is no shift.
std::uint64_t division_steps(int most, std::uint32_t clusters) {
  std::uint32_t power = 1;
  while (power < clusters) power *= 2;
  if (power == clusters) return 0;
  return counter_bits(static_cast<std::uint64_t>(most) / clusters);
}

// Least cycles to drain a row of pixels: a bank gives one sub-tile a cycle, or with one port is
// cleared of it, and the pixels that are converted are limited.
std::uint64_t row_cycles(const RenderingPlan& plan, std::uint64_t width) {
  return std::max(
      ceil_div(width, plan.config.drain_pixels_per_cycle),
      (has_one_port(plan) ? 2 : 1) * ceil_div(ceil_div(width, 4), plan.config.clusters));
}

// Draining converts several pixels at once. Each place among them meets at most this many memories
// over a group. A memory holds one of 16 pixels of a sub-tile, in a cluster and a buffer.
std::uint64_t memories_of_a_place(const RenderingPlan& plan) {
  std::vector<std::set<std::uint64_t>> met(plan.config.drain_pixels_per_cycle);
  for (int y = 0; y < plan.group.height; ++y) {
    for (int x = 0; x < plan.group.width; ++x) {
      const int cluster = (x / 4 + 2 * (y / 4)) % static_cast<int>(plan.config.clusters);
      const int memory = 16 * cluster + 4 * (y % 4) + x % 4;
      met[static_cast<std::size_t>(x) % met.size()].insert(static_cast<std::uint64_t>(memory));
    }
  }
  std::size_t most = 0;
  for (const auto& of_place : met) most = std::max(most, of_place.size());
  return most * plan.config.pixel_buffers;
}

// The expected output: pixels and counts from the algorithm layer. Finished groups drop splats, and
// when that is known depends on timing: the counts of splats and their rows are upper limits.
struct Expected {
  std::vector<std::byte> frame;
  std::uint64_t groups = 0, groups_saturated = 0;
  std::uint64_t splats = 0, splats_spanned = 0, spans = 0, contributors = 0;
  std::uint64_t functional_blends = 0;  // into unfinished sub-tiles
  std::uint64_t subtiles_finished = 0, rows = 0, begun_span_reads = 0;
  std::uint64_t drain_cycles = 0, finished_pixels = 0;
  std::vector<bool> saturated;  // [group]
};

// Blends a splat and counts what of the group it reaches.
void blend(const RenderingPlan& plan, const Splat& splat, GroupState& state, Expected& out) {
  const BlendWork work = state.blend_scheduled(splat, [&](const SubtileReach& subtile) {
    out.subtiles_finished += subtile.finishes ? 1 : 0;
  });
  out.rows += work.rows;
  out.functional_blends += work.blended;
  out.splats += work.blended > 0 ? 1 : 0;
  // A footprint of at most four sub-tiles is blended as it is; of a larger one each row has a span.
  constexpr std::size_t kUntested = 4;
  const SubtileRect box = state.box_of(splat).subtiles;
  const std::uint64_t rows = box.y1 - box.y0;
  if (!plan.config.ellipse_test || rows * (box.x1 - box.x0) <= kUntested) return;
  out.spans += rows;
  ++out.splats_spanned;
  out.begun_span_reads += ceil_div(rows, plan.config.spans_at_once());
}

Expected expect(const RenderingPlan& plan) {
  Expected out;
  RenderResult frame(plan.job.view.width, plan.job.view.height);
  for (std::size_t g = 0; g < plan.groups.size(); ++g) {
    const PixelRect& pixels = plan.job.groups[g];
    GroupState state(pixels, plan.job.view.width, plan.job.view.height, plan.config.precision,
                     plan.config.ellipse_test ? SubtileTest::kEllipse : SubtileTest::kBox);
    for (const auto& visit : plan.groups[g]) {
      for (const Splat& splat : visit) blend(plan, splat, state, out);
    }
    ++out.groups;
    out.groups_saturated += state.saturated() ? 1 : 0;
    out.contributors += state.contributors();
    out.finished_pixels += state.finished_pixels();
    out.saturated.push_back(state.saturated());
    out.drain_cycles += static_cast<std::uint64_t>(pixels.height()) *
                            row_cycles(plan, static_cast<std::uint64_t>(pixels.width())) +
                        1;
    state.store(plan.job.background, frame);
  }
  out.frame = encode_frame(plan.job.frame_format, frame.image);
  return out;
}

// Notes how often groups are said to be finished.
struct Feedback : sc_core::sc_module, FinishGroupIf {
  Feedback(const sc_core::sc_module_name& name, std::size_t groups)
      : sc_module(name), times(groups) {}
  void finish(std::uint32_t group, std::uint32_t) override { ++times[group]; }
  std::vector<std::uint32_t> times;  // [group]
};

// The tokens of each FIFO. By visit: visits in turn, each with its end; behind a group's visits its
// end takes a turn of its own. By token: each in turn, here with a rejected key behind a visit's
// splats.
std::vector<std::vector<SplatToken>> tokens_of(const RenderingPlan& plan) {
  std::vector<std::vector<SplatToken>> tokens(plan.inputs);
  const bool by_token = plan.arrival == Arrival::kByToken;
  std::uint32_t turn = 0, visit = 0;
  for (std::uint32_t g = 0; g < plan.groups.size(); ++g) {
    const auto put = [&](const Splat& splat, Mark mark) {
      tokens[turn % plan.inputs].push_back({splat, g, visit, mark});
      turn += mark != Mark::kNone || by_token ? 1 : 0;
    };
    for (const auto& splats : plan.groups[g]) {
      for (const Splat& splat : splats) put(splat, Mark::kNone);
      put({}, by_token ? Mark::kRejected : Mark::kEndOfVisit);
      ++visit;
    }
    put({}, Mark::kEndOfGroup);
    ++visit;
  }
  return tokens;
}

}  // namespace

void run_plan(Case& test, const BenchConfig& bench_config, const RenderingPlan& plan) {
  UnitBench bench(test, bench_config);
  Checks& checks = bench.checks();
  Feedback feedback("feedback", plan.job.groups.size());
  const auto inputs = bench.add_fifos<SplatToken>("sorted", plan.inputs, plan.input_entries, 1);
  std::uint64_t ends = 0;
  UnitContext context = bench.context(plan.job);
  context.built_for.group = plan.group;
  RenderingUnit unit("rendering", plan.config, plan.arrival, context,
                     [&](std::uint32_t) { ++ends; });
  for (TimedFifo<SplatToken>* input : inputs) unit.splats(*input);
  unit.finish(feedback);
  bench.add_unit(unit);
  const std::vector<std::vector<SplatToken>> tokens = tokens_of(plan);
  for (std::uint32_t s = 0; s < plan.inputs; ++s) {
    bench.add_thread(fmt::format("sorting{}", s), [&, s](Activity& activity) {
      for (const SplatToken& token : tokens[s]) inputs[s]->push(token, activity);
    });
  }
  const Expected expected = expect(plan);
  bench.run();

  checks.equal(ends, 1U, "ends of the frame reported");
  const RegionSpan& frame = plan.job.frame_buffer;
  checks.that(bench.read_back(frame.base, frame.bytes) == expected.frame,
              "the frame buffer differs from GroupState's pixels");
  checks.equal(bench.bytes_written(), frame.bytes, "bytes written");
  checks.equal(bench.bytes_read(), 0U, "bytes read");
  bench.check_counter("groups", expected.groups);
  bench.check_counter("groups_saturated", expected.groups_saturated);
  bench.check_counter("splats", expected.splats);
  bench.check_counter("contributors", expected.contributors);
  checks.that(
      unit.schedule_counters().subtile_blends - unit.schedule_counters().subtile_blends_late ==
          expected.functional_blends,
      "blends that change pixels");
  std::uint64_t pushed = 0;
  for (const auto& group : plan.groups) {
    for (const auto& visit : group) pushed += visit.size();
  }
  const std::uint64_t taken = bench.counter("splats_taken");
  checks.equal(taken + bench.counter("splats_hidden") + bench.counter("splats_saturated"), pushed,
               "splats sent on or dropped");
  for (std::uint32_t g = 0; g < plan.groups.size(); ++g) {
    const bool told = expected.saturated[g] && plan.config.saturation_feedback;
    checks.equal(feedback.times[g], told ? 1U : 0U,
                 fmt::format("how often group {} was said to be finished", g));
  }
  checks.equal(bench.busy_cycles("drain"), expected.drain_cycles, "busy cycles of draining");
  const std::uint64_t blends = bench.counter("subtile_blends"), spans = bench.counter("spans");
  const std::uint64_t spanned = bench.counter("splats_spanned"), rows_sent = bench.counter("rows");
  const std::uint64_t begun_span_reads = bench.accesses("begun spans").first;
  for (const auto& [name, got, all] :
       {std::tuple{"spans", spans, expected.spans},
        {"splats spanned", spanned, expected.splats_spanned},
        {"rows", rows_sent, expected.rows},
        {"begun spans read", begun_span_reads, expected.begun_span_reads}}) {
    checks.that(got <= all && (taken < pushed || got == all), name);
  }
  const RenderingFlows flows = rendering_flows(plan.config.precision);
  const OperationCounts conic = flows.conic.counts(), spans_begin = flows.spans_begin.counts(),
                        span = flows.span.counts(), subtile_blend = flows.subtile_blend.counts();
  const std::uint64_t blend_macs = blends * folded_macs(subtile_blend);
  std::uint64_t pixels = 0;
  for (const PixelRect& px : plan.job.groups) {
    pixels += static_cast<std::uint64_t>(px.width()) * static_cast<std::uint64_t>(px.height());
  }
  const OperationCounts drained = pixel_flow(plan.job.frame_format).counts();
  const std::uint64_t span_macs = spans * folded_macs(span) + spanned * folded_macs(spans_begin);
  // Sub-tiles that draining reads, once for each of their rows of pixels.
  std::uint64_t subtile_rows = 0;
  for (const PixelRect& px : plan.job.groups) {
    subtile_rows += ceil_div(static_cast<std::uint64_t>(px.width()), 4) *
                    static_cast<std::uint64_t>(px.height());
  }
  // The mask is asked of every row for a splat, and of the row that is held for each cluster.
  const auto rows = static_cast<std::uint64_t>(plan.group.height / 4);
  const auto words = ceil_div(static_cast<std::uint64_t>(plan.group.width / 4), 32);
  const std::uint64_t looks = blends + bench.counter("hazard_cycles");
  const std::uint64_t in_loop =
      ceil_div(plan.config.state_loop_cycles, plan.config.cluster_interval_cycles());
  const std::uint64_t bits = 8 * mask_use(plan.group).total_bytes();
  const auto [mask_reads, mask_writes] = bench.accesses("finished sub-tiles");
  checks.equal(mask_reads % bits, std::uint64_t{0}, "bits of the mask read");
  const std::uint64_t row_cycles = mask_reads / bits - pushed;
  checks.that(row_cycles >= rows_sent, "more than a row goes out in a cycle");
  checks.equal(mask_writes, expected.subtiles_finished + bits * plan.groups.size(),
               "bits of the mask written");
  bench.check_operations("rendering", "comparator",
                         pushed * rows * words + looks * in_loop + blends);
  const bool in_half = in_16_bits(plan.config.precision);
  // The quotient of a row's first cluster, and a subtraction for each cluster.
  const int group_columns = plan.group.width / 4;
  std::uint64_t steps_of_row =
      division_steps(2 * (plan.group.height / 4 - 1), plan.config.clusters);
  if (steps_of_row > 0) steps_of_row += plan.config.clusters;
  const auto added = [](const OperationCounts& of) { return of.scalings + of.index_adds; };
  bench.check_operations(
      "rendering", "adder",
      row_cycles * plan.config.clusters * words + rows_sent * steps_of_row +
          (blends + subtile_rows) *
              division_steps(group_columns * (plan.group.height / 4) - 1, plan.config.clusters) +
          pixels * added(drained) + taken * added(conic) + spans * added(span) +
          spanned * added(spans_begin) + (in_half ? 0 : blends * added(subtile_blend)));
  const std::uint64_t compared = pixels * drained.comparisons + taken * conic.comparisons +
                                 spans * span.comparisons + spanned * spans_begin.comparisons,
                      of_pixels = blends * subtile_blend.comparisons;
  bench.check_operations("rendering", "number_comparator", compared + (in_half ? 0 : of_pixels));
  bench.check_operations("rendering", in_half ? "exp2_split_half" : "exp2_split", blends * 16);
  bench.check_operations("rendering", in_half ? "exp2_table_half" : "exp2_table", blends * 16);
  // Lanes of pixels only chain, those of spans make quotients and roots; a conic in squares, too.
  const std::uint64_t conic_macs = taken * folded_macs(conic);
  const bool squares = conic.divisions > 0;
  bench.check_operations("rendering", "fp32_lane", span_macs + (squares ? conic_macs : 0));
  bench.check_operations(
      "rendering", "fp32_chaining_lane",
      pixels * folded_macs(drained) + (squares ? 0 : conic_macs) + (in_half ? 0 : blend_macs));
  if (in_half) {
    bench.check_operations("rendering", "half_comparator", of_pixels);
    bench.check_operations("rendering", "fp16_lane", blend_macs);
  }
  // Blended where alpha passes, the last time without a write; the 16 pixels of a sub-tile cleared
  // at once, read by rows in draining.
  std::uint64_t reads = expected.contributors + expected.finished_pixels, cleared = 0;
  for (const PixelRect& px : plan.job.groups) {
    const std::uint64_t columns = ceil_div(static_cast<std::uint64_t>(px.width()), 4);
    reads += 4 * columns * static_cast<std::uint64_t>(px.height());
    cleared += columns * ceil_div(static_cast<std::uint64_t>(px.height()), 4);
  }
  bench.check_accesses("pixel state", reads, expected.contributors + 16 * cleared);
  bench.check_accesses("finished pixels", 16 * blends, expected.finished_pixels + 16 * cleared);
  bench.check_accesses("sub-tiles in the loop", looks, blends);
  bench.check_accesses("cluster queues", blends, blends);
  checks.equal(bench.accesses("begun spans").second, spanned, "begun spans: writes");
  bench.check_accesses("spans", spans, spans);
  bench.check_accesses("splats under way", taken, taken);
  // The splat whose rows go out stands in registers, and the row of pixels that is written next,
  // and what waits for the only port, if it does; a pixel that is drained comes from its place's
  // share of all memories of pixels.
  const std::uint64_t late_bits =
      8 * plan.config.pixel_state_bytes() / 16 * late_pixels(plan, context.built_for);
  bench.check_operations("rendering", "register_bit",
                         8 * kSplatEntryBytes * taken +
                             8 * pixel_bytes(plan.job.frame_format) * pixels +
                             late_bits * expected.contributors);
  const std::uint64_t of_place = memories_of_a_place(plan);
  const std::uint64_t of_masks =
      counter_bits(plan.config.clusters / std::gcd(2U, plan.config.clusters) - 1);
  if (of_place > 1 || of_masks > 0) {
    bench.check_operations(
        "rendering", "select_bit",
        8 * plan.config.pixel_state_bytes() * counter_bits(of_place - 1) * pixels +
            rows_sent * plan.config.clusters * static_cast<std::uint64_t>(group_columns) *
                of_masks);
  }
}

}  // namespace sgs::tb
