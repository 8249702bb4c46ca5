// The two threads of the rendering unit.
#include "modules/streaminggs/rendering/rendering_unit.h"

#include "modules/datapath/work_rates.h"
#include "tlm/row_writer.h"

namespace sgs {
namespace {

constexpr std::uint64_t kClearCycles = 1;  // for a group's last row of pixels, behind its draining

}  // namespace

RenderingUnit::RenderingUnit(const sc_core::sc_module_name& name, const RenderingConfig& config,
                             Arrival arrival, const UnitContext& context,
                             std::function<void(std::uint32_t frame)> on_drawn)
    : sc_module(name),
      memory("memory", context.built_for.memory_port, context.clock.period()),
      config_(config),
      built_for_(context.built_for),
      job_(context.job),
      arrival_(arrival),
      on_drawn_(std::move(on_drawn)),
      blend_("blend", context.clock),
      drain_("drain", context.clock),
      finished_("finished", context.clock, config.pixel_buffers,
                config.depth_cycles + config.drain_depth_cycles),
      free_buffers_("free_buffers", context.clock, config.pixel_buffers, 0),
      schedule_(config_) {
  SC_THREAD(run_blend);
  SC_THREAD(run_drain);
  SC_THREAD(run_tell);
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
    finished_pixels_ += state->finished_pixels();
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
  for (std::uint32_t group = 0; group < job_.groups.size(); ++group) {
    take_up_group(drain_, memory, group);
    const std::shared_ptr<GroupState> state = finished_.pop(drain_);
    if (job_.begins_frame(group)) await_buffer(host, job_.frame_of(group), drain_);
    write_group(*state, job_.picture_of(group));
    free_buffers_.push(0, drain_);
    if (job_.ends_frame(group)) {
      drained_.push_back(memory.next());
      drained_one_.notify(sc_core::SC_ZERO_TIME);
    }
  }
  await_all(memory, drain_);
  drain_.idles();
}

void RenderingUnit::run_tell() {
  for (std::uint32_t frame = 0; frame < job_.frames(); ++frame) {
    while (drained_.empty()) sc_core::wait(drained_one_);
    memory.wait_before(drained_.front());
    drained_.pop_front();
    on_drawn_(frame);
  }
}

void RenderingUnit::write_group(const GroupState& state, const Picture& picture) {
  const PixelRect& pixels = state.pixels();
  const auto width = static_cast<std::uint32_t>(pixels.width());
  const std::uint32_t bytes = pixel_bytes(job_.frame_format);
  std::vector<std::byte> row(std::size_t{width} * bytes);
  const std::uint32_t row_cycles = config_.drain_row_cycles(width);
  RowWriter rows(memory, drain_);
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; ++x) {
      encode_pixel(job_.frame_format, state.colour(x, y, job_.background),
                   row.data() + static_cast<std::size_t>(x - pixels.x0) * bytes);
    }
    rows.make(row_cycles);
    rows.write(picture.pixel_address(pixels.x0, y), row.data(),
               static_cast<std::uint32_t>(row.size()), picture.frame_buffer.region,
               y + 1 < pixels.y1 ? row_cycles : 0);
  }
  // A sub-tile is cleared in the cycle after its last row was read: all but the last while others
  // are drained.
  if (!pixels.empty()) drain_.work(kClearCycles);
}

}  // namespace sgs
