// Expected pixels, times and counts, and the run that is held against them.
#include "testbench/units/rendering_run.h"

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "algorithm/memory/splat_record.h"
#include "algorithm/render/group_state.h"
#include "algorithm/splat/lane_macs.h"
#include "algorithm/splat/rendering_work.h"
#include "testbench/units/job_memory.h"
#include "testbench/units/multiplexers.h"
#include "testbench/units/rendering_timing_model.h"

namespace sgs::tb {
namespace {

std::uint64_t ceil_div(std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; }

// Of draining a row of pixels: a bank gives one sub-tile a cycle, and what is converted is limited.
std::uint64_t row_cycles(const RenderingPlan& plan, std::uint64_t width) {
  return std::max(ceil_div(width, plan.config.drain_pixels_per_cycle),
                  ceil_div(ceil_div(width, 4), plan.config.clusters));
}

// Of draining: of each place among the pixels that are converted at once, how many memories it
// meets over a group, at most. A memory is one of 16 pixels of a sub-tile, in a cluster and a
// buffer.
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

// What must come out: pixels and counts from the algorithm layer, times from the stepped model.
struct Expected {
  std::vector<std::byte> frame;
  RenderingUnit::Counters counters;
  std::uint64_t functional_blends = 0;              // into unfinished sub-tiles
  std::vector<std::vector<RenderingToken>> tokens;  // [group]
  std::vector<std::size_t> subtiles;                // [group]
  std::vector<std::uint64_t> drain_cycles;          // [group]
  std::vector<bool> saturated;                      // [group]
};

// Blends a splat and says what of the group it reaches.
RenderingToken blended(const Splat& splat, bool ellipse_test, GroupState& state, Expected& out) {
  RenderingToken token;
  token.is_splat = true;
  const BlendWork work = state.blend_scheduled(
      splat, [&](const SubtileReach& subtile) { token.reaches.push_back(subtile); });
  token.rows = work.rows;
  const SubtileRect box = state.box_of(splat).subtiles;
  for (std::size_t y = box.y0; y < box.y1; ++y) {
    for (std::size_t x = box.x0; x < box.x1; ++x) {
      token.footprint.push_back(y * state.subtile_columns() + x);
    }
  }
  // A footprint of at most four sub-tiles is blended as it is; of a larger one each row has a span.
  constexpr std::size_t kUntested = 4;
  if (ellipse_test && token.footprint.size() > kUntested) token.spans = box.y1 - box.y0;
  out.functional_blends += work.blended;
  out.counters.splats += work.blended > 0 ? 1 : 0;
  return token;
}

Expected expect(const RenderingPlan& plan) {
  Expected out;
  RenderResult frame;
  frame.image = Image(plan.job.view.width, plan.job.view.height);
  frame.transmittance.resize(frame.image.pixels.size());
  frame.contributors.resize(frame.image.pixels.size());
  for (std::size_t g = 0; g < plan.groups.size(); ++g) {
    const PixelRect& pixels = plan.job.groups[g];
    GroupState state(pixels, plan.job.view.width, plan.job.view.height, plan.config.precision,
                     plan.config.ellipse_test ? SubtileTest::kEllipse : SubtileTest::kBox);
    std::vector<RenderingToken> tokens;
    for (const auto& visit : plan.groups[g]) {
      for (const Splat& splat : visit) {
        tokens.push_back(blended(splat, plan.config.ellipse_test, state, out));
      }
      tokens.emplace_back();  // a rejected key, or the end of a visit
    }
    tokens.emplace_back();  // the end of the group
    out.tokens.push_back(std::move(tokens));
    out.subtiles.push_back(state.subtile_count());
    ++out.counters.groups;
    out.counters.groups_saturated += state.saturated() ? 1 : 0;
    out.counters.contributors += state.contributors();
    out.saturated.push_back(state.saturated());
    out.drain_cycles.push_back(static_cast<std::uint64_t>(pixels.height()) *
                                   row_cycles(plan, static_cast<std::uint64_t>(pixels.width())) +
                               1);
    state.store(plan.job.background, frame);
  }
  out.frame = encode_frame(plan.job.frame_format, frame.image);
  return out;
}

struct Times {
  std::vector<RenderingTimes> groups;
  std::vector<std::uint64_t> blend_begins;  // [group]
  std::uint64_t end = 0;                    // of the frame
};

// When a group that begins to drain at `at` has given its last row to the port, from which a
// transaction leaves a cycle; free_from: of the port.
std::uint64_t drained_at(const RenderingPlan& plan, const PixelRect& pixels, std::uint64_t at,
                         std::uint64_t& free_from) {
  const std::uint64_t longest = MemoryPortConfig{}.max_transaction_bytes;
  const auto width = static_cast<std::uint64_t>(pixels.width());
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    at += row_cycles(plan, width);
    const std::uint64_t begin = plan.job.pixel_address(pixels.x0, y);
    const std::uint64_t last = begin + width * pixel_bytes(plan.job.frame_format) - 1;
    at = std::max(at, free_from) + last / longest - begin / longest;
    free_from = at + 1;
  }
  return at + 1;  // the last sub-tile is cleared
}

// When splats are always there: a group is blended when the one before it is and a buffer is free;
// drained when the one before it is, the depths of a blend and of a conversion after its last
// blend.
Times expected_times(const RenderingPlan& plan, const Expected& expected,
                     std::uint64_t write_latency_cycles) {
  Times times;
  std::vector<std::uint64_t> drained;
  std::uint64_t port_free_from = 0;
  std::uint64_t blend_end = 1;  // input latency
  for (std::size_t g = 0; g < plan.groups.size(); ++g) {
    const std::size_t buffers = plan.config.pixel_buffers;
    if (g >= buffers) blend_end = std::max(blend_end, drained[g - buffers]);
    times.blend_begins.push_back(blend_end);
    times.groups.push_back(
        step_rendering(plan.config, expected.subtiles[g], expected.tokens[g], blend_end));
    blend_end += times.groups.back().cycles;
    std::uint64_t drain = blend_end + plan.config.depth_cycles + plan.config.drain_depth_cycles;
    if (g > 0) drain = std::max(drain, drained[g - 1]);
    drained.push_back(drained_at(plan, plan.job.groups[g], drain, port_free_from));
  }
  // The last row leaves while the last sub-tile is cleared.
  times.end = drained.back() - 1 + std::max<std::uint64_t>(write_latency_cycles, 1);
  return times;
}

// Notes when it is known that groups are finished.
class Feedback : public sc_core::sc_module, public FinishGroupIf {
 public:
  Feedback(const sc_core::sc_module_name& name, const ClockDomain& clock, std::size_t groups)
      : sc_module(name), cycles(groups), clock_(clock) {}
  void finish(std::uint32_t group, std::uint32_t known_in_cycles) override {
    cycles[group].push_back(clock_.now_cycles() + known_in_cycles);
  }
  std::vector<std::vector<std::uint64_t>> cycles;  // [group]

 private:
  const ClockDomain& clock_;
};

// What comes through each FIFO. By visit: visits in turn, each with its end; behind a group's
// visits its end takes a turn of its own. By token: each in turn, here with a rejected key behind a
// visit's splats.
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
  Feedback feedback("feedback", bench.clock(), plan.job.groups.size());
  const auto inputs = bench.add_fifos<SplatToken>("sorted", plan.inputs, plan.input_entries, 1);
  std::uint64_t ends = 0;
  UnitContext context = bench.context(plan.job);
  context.built_for.group = plan.group;
  RenderingUnit unit("rendering", plan.config, plan.arrival, context, [&] { ++ends; });
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
  const Times times = expected_times(plan, expected, bench_config.write_latency_cycles);
  if (bench_config.still()) {
    bench.add_thread("clock", [&](Activity&) {
      bench.wait_until_just_before(times.end);
      checks.equal(ends, 0U, "done a cycle too soon");
      bench.clock().wait_cycles(1);
      checks.equal(ends, 1U, "done in time");
    });
  }
  bench.run();

  checks.equal(ends, 1U, "ends of the frame reported");
  const RegionSpan& frame = plan.job.frame_buffer;
  checks.that(bench.read_back(frame.base, frame.bytes) == expected.frame,
              "the frame buffer differs from GroupState's pixels");
  checks.equal(bench.bytes_written(), frame.bytes, "bytes written");
  checks.equal(bench.bytes_read(), 0U, "bytes read");
  const RenderingUnit::Counters& want = expected.counters;
  bench.check_counter("groups", want.groups);
  bench.check_counter("groups_saturated", want.groups_saturated);
  bench.check_counter("splats", want.splats);
  bench.check_counter("contributors", want.contributors);
  checks.that(unit.schedule_counters().blends - unit.schedule_counters().late_blends ==
                  expected.functional_blends,
              "blends that change pixels");
  std::uint64_t pushed = 0;
  for (const auto& group : plan.groups) {
    for (const auto& visit : group) pushed += visit.size();
  }
  checks.equal(bench.counter("splats_taken") + bench.counter("splats_hidden") +
                   bench.counter("splats_saturated"),
               pushed, "splats sent on or dropped");
  std::uint64_t blend = 0, drain = 0, finishes = 0;
  RenderingTimes sum;
  for (std::uint32_t g = 0; g < plan.groups.size(); ++g) {
    const RenderingTimes& group = times.groups[g];
    const bool told = expected.saturated[g] && plan.config.saturation_feedback;
    checks.equal(feedback.cycles[g].size(), told ? 1U : 0U,
                 fmt::format("how often group {} was said to be finished", g));
    if (bench_config.still() && told && !feedback.cycles[g].empty()) {
      checks.equal(feedback.cycles[g][0], times.blend_begins[g] + *group.finished,
                   fmt::format("cycle in which group {} was finished", g));
    }
    blend += group.cycles;
    drain += expected.drain_cycles[g];
    sum.blends += group.blends;
    sum.spans += group.spans;
    sum.rows += group.rows;
    sum.row_cycles += group.row_cycles;
    sum.splats_hidden += group.splats_hidden;
    sum.splats_dropped += group.splats_dropped;
    finishes += group.subtiles_finished;
    sum.splats_spanned += group.splats_spanned;
    sum.begun_span_reads += group.begun_span_reads;
    sum.late_blends += group.late_blends;
    sum.hazard_cycles += group.hazard_cycles;
    sum.queue_cycles += group.queue_cycles;
  }
  checks.equal(bench.busy_cycles("drain"), drain, "busy cycles of draining");
  // With stalls it depends on when splats come what is known of sub-tiles.
  if (!bench_config.still()) return;
  bench.check_counter("splats_saturated", sum.splats_dropped);
  bench.check_counter("splats_hidden", sum.splats_hidden);
  const std::uint64_t dropped = sum.splats_hidden + sum.splats_dropped, taken = pushed - dropped;
  bench.check_counter("splats_taken", taken);
  bench.check_counter("splats_spanned", sum.splats_spanned);
  bench.check_counter("spans", sum.spans);
  bench.check_counter("rows", sum.rows);
  bench.check_counter("subtile_blends", sum.blends);
  bench.check_counter("subtile_blends_late", sum.late_blends);
  bench.check_counter("hazard_cycles", sum.hazard_cycles);
  bench.check_counter("queue_cycles", sum.queue_cycles);
  const RenderingWork work = rendering_work(plan.config.precision);
  const std::uint64_t blend_macs = sum.blends * folded_macs(work.subtile_blend);
  std::uint64_t pixels = 0;
  for (const PixelRect& px : plan.job.groups) {
    pixels += static_cast<std::uint64_t>(px.width()) * static_cast<std::uint64_t>(px.height());
  }
  const OperationCounts drained = pixel_work(plan.job.frame_format);
  const std::uint64_t span_macs = pixels * folded_macs(drained) + taken * folded_macs(work.conic) +
                                  sum.spans * folded_macs(work.span) +
                                  sum.splats_spanned * folded_macs(work.spans_begin);
  // The mask is asked of every row for a splat, and of the row that is held for each cluster.
  const auto rows = static_cast<std::uint64_t>(plan.group.height / 4);
  const auto words = ceil_div(static_cast<std::uint64_t>(plan.group.width / 4), 32);
  const std::uint64_t looks = sum.blends + sum.hazard_cycles;
  const std::uint64_t in_loop =
      ceil_div(plan.config.state_loop_cycles, plan.config.cluster_interval_cycles());
  const std::uint64_t dispatched =
      pushed * rows * words + sum.row_cycles * plan.config.clusters * words + looks * in_loop;
  bench.check_operations(
      "rendering", "comparator",
      dispatched + pixels * comparisons(drained) + taken * comparisons(work.conic) +
          sum.blends * comparisons(work.subtile_blend) + sum.spans * comparisons(work.span) +
          sum.splats_spanned * comparisons(work.spans_begin));
  const bool in_half = in_16_bits(plan.config.precision);
  bench.check_operations("rendering", in_half ? "exp2_table_half" : "exp2_table", sum.blends * 16);
  bench.check_operations("rendering", "fp32_lane", span_macs + (in_half ? 0 : blend_macs));
  if (in_half) bench.check_operations("rendering", "fp16_lane", blend_macs);
  // The 16 pixels of a sub-tile at once: blended, cleared; read by rows in draining.
  std::uint64_t reads = 16 * sum.blends, writes = 16 * sum.blends;
  for (const PixelRect& px : plan.job.groups) {
    const std::uint64_t columns = ceil_div(static_cast<std::uint64_t>(px.width()), 4);
    reads += 4 * columns * static_cast<std::uint64_t>(px.height());
    writes += 16 * columns * ceil_div(static_cast<std::uint64_t>(px.height()), 4);
  }
  bench.check_accesses("pixel state", reads, writes);
  const std::uint64_t bits = 8 * mask_use(plan.group).total_bytes();
  bench.check_accesses("finished sub-tiles", bits * (pushed + sum.row_cycles),
                       finishes + bits * plan.groups.size());
  bench.check_accesses("sub-tiles in the loop", looks, sum.blends);
  bench.check_accesses("cluster queues", sum.blends, sum.blends);
  bench.check_accesses("begun spans", sum.begun_span_reads, sum.splats_spanned);
  bench.check_accesses("spans", sum.spans, sum.spans);
  bench.check_accesses("splats under way", taken, taken);
  // The splat whose rows go out stands in registers, and the row of pixels that is written next; a
  // pixel that is drained comes from its place's share of all memories of pixels.
  bench.check_operations(
      "rendering", "register_bit",
      8 * kSplatEntryBytes * taken + 8 * pixel_bytes(plan.job.frame_format) * pixels);
  const std::uint64_t of_place = memories_of_a_place(plan);
  if (of_place > 1) {
    bench.check_operations("rendering", "select_bit",
                           8 * plan.config.pixel_state_bytes() * levels(of_place) * pixels);
  }
  checks.equal(bench.busy_cycles("rendering"), blend, "busy cycles of blending");
}

}  // namespace sgs::tb
