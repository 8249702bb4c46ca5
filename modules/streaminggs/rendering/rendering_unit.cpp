// The two threads of the rendering unit.
#include "modules/streaminggs/rendering/rendering_unit.h"

#include <algorithm>

#include "modules/streaminggs/work_rates.h"

namespace sgs {

RenderingUnit::RenderingUnit(const sc_core::sc_module_name& name, const RenderingConfig& config,
                             Arrival arrival, const UnitContext& context,
                             std::function<void()> on_done)
    : sc_module(name),
      memory("memory", context.built_for.memory_port),
      config_(config),
      built_for_(context.built_for),
      job_(context.job),
      arrival_(arrival),
      on_done_(std::move(on_done)),
      blend_("blend", context.clock),
      drain_("drain", context.clock),
      finished_("finished", context.clock, config.pixel_buffers, config.depth_cycles),
      free_buffers_("free_buffers", context.clock, config.pixel_buffers, 0) {
  SC_THREAD(run_blend);
  SC_THREAD(run_drain);
}

void RenderingUnit::run_blend() {
  std::size_t turn = 0;
  for (std::uint32_t group = 0; group < job_.groups.size(); ++group) {
    free_buffers_.pop(blend_, ActivityState::kBlocked);
    current_group_ = group;
    auto state = std::make_shared<GroupState>(
        job_.groups[group], job_.view.width, job_.view.height,
        config_.ellipse_test ? SubtileTest::kEllipse : SubtileTest::kBox);
    for (Mark mark = Mark::kNone; mark != Mark::kEndOfGroup;) {
      const SplatToken token = in_turn(splats, turn).pop(blend_);
      mark = token.mark;
      if (mark == Mark::kNone) {
        blend_splat(token.splat, group, *state);
      } else if (mark == Mark::kRejected) {
        blend_.work(1);
      }
      turn += mark != Mark::kNone || arrival_ == Arrival::kByToken ? 1 : 0;
    }
    ++counters_.groups;
    counters_.groups_saturated += state->saturated() ? 1 : 0;
    counters_.contributors += state->contributors();
    finished_.push(std::move(state), blend_);
  }
  blend_.enter(ActivityState::kStarved);
}

void RenderingUnit::blend_splat(const Splat& splat, std::uint32_t group, GroupState& state) {
  if (state.saturated()) {
    ++counters_.splats_saturated;
    return;
  }
  const BlendWork work = state.blend(splat);
  blend_.work(std::max({std::uint64_t{1}, cycles_for(work.blended, config_.clusters),
                        cycles_for(work.tested, config_.subtile_tests_per_cycle)}));
  counters_.subtile_tests += work.tested;
  counters_.subtile_blends += work.blended;
  counters_.splats += work.blended > 0 ? 1 : 0;
  // The last transmittance is known when the blend has left the pipeline.
  if (state.saturated() && config_.saturation_feedback) {
    finish->finish(group, config_.depth_cycles);
  }
}

void RenderingUnit::run_drain() {
  for (std::uint32_t buffer = 0; buffer < config_.pixel_buffers; ++buffer) {
    free_buffers_.push(buffer, drain_);
  }
  for (std::size_t done = 0; done < job_.groups.size(); ++done) {
    const std::shared_ptr<GroupState> state = finished_.pop(drain_);
    write_group(*state);
    free_buffers_.push(0, drain_);
  }
  await_all(memory, drain_);
  drain_.enter(ActivityState::kStarved);
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
    drain_.work(cycles_for(width, config_.drain_pixels_per_cycle));
    start_write(memory, drain_, job_.pixel_address(pixels.x0, y), row.data(),
                static_cast<std::uint32_t>(row.size()), job_.frame_buffer.region);
  }
}

// A row is converted as it leaves: until a write of it is made its pixels are in their buffer.
SramUses RenderingUnit::sram_uses(const RenderingConfig& config, const BuiltFor& built_for) {
  const std::uint32_t px = built_for.group_px;
  return {
      sram_use("pixel state", kSharedSram,
               {{config.pixel_buffers, "groups"}, {px, "px"}, {px, "px"}, {kPixelStateBytes, "B"}},
               {8 * kSubtilePixels * kPixelStateBytes, SramPorts::kReadAndWrite, config.clusters}),
      unanswered_writes("pixel writes", kSharedSram, built_for.memory_port,
                        px * pixel_bytes(built_for.frame_format))};
}

void RenderingUnit::publish(DataSheet& sheet) {
  sheet.unit(*this);
  sheet.activity(blend_, "rendering", "blends sorted splats into the pixels of a group");
  sheet.activity(drain_, "drain", "writes finished pixels");
  sheet.counter("groups", "groups", "rendered", counters_.groups);
  sheet.counter("groups_saturated", "groups", "of these with every pixel finished early",
                counters_.groups_saturated);
  sheet.counter("splats", "splats", "blended into at least one sub-tile", counters_.splats);
  sheet.counter("splats_saturated", "splats", "that came when their group was finished",
                counters_.splats_saturated);
  sheet.counter("subtile_tests", "sub-tiles", "put to the ellipse test", counters_.subtile_tests);
  sheet.counter("subtile_blends", "sub-tiles", "blended", counters_.subtile_blends);
  sheet.counter("contributors", "pixels", "blended with an alpha above 1/255",
                counters_.contributors);
  const double pixels = static_cast<double>(counters_.subtile_blends) * kSubtilePixels;
  sheet.part("rendering", "pixel_lane", config_.clusters * kSubtilePixels, 1);
  sheet.operations("rendering", "pixel_lane", pixels);
  // Each blend reads and writes a sub-tile; so do clearing and draining a group.
  std::uint64_t subtiles = counters_.subtile_blends;
  for (std::uint64_t group = 0; group < counters_.groups; ++group) {
    const PixelRect& px = job_.groups[group];
    subtiles += cycles_for(static_cast<std::uint64_t>(px.width()), kSubtilePx) *
                cycles_for(static_cast<std::uint64_t>(px.height()), kSubtilePx);
  }
  sheet.accesses("pixel state", subtiles, subtiles);
  sheet.port(memory, "pixel writes");
  sheet.sram(sram_uses(config_, built_for_));
  sheet.queue(finished_, "pixel state");
  sheet.signal("group", current_group_);
}

}  // namespace sgs
