// The two threads of the rendering unit.
#include "modules/rendering/rendering_unit.h"

#include <algorithm>

namespace sgs {

RenderingUnit::RenderingUnit(const sc_core::sc_module_name& name, const RenderingConfig& config,
                             const ClockDomain& clock, const FrameJob& job, SaturationBoard& board,
                             MemoryPort& port, std::vector<TimedFifo<SplatToken>*> sorted,
                             Arrival arrival, std::function<void()> on_done)
    : sc_module(name),
      config_(config),
      job_(job),
      board_(board),
      port_(port),
      sorted_(std::move(sorted)),
      arrival_(arrival),
      on_done_(std::move(on_done)),
      blend_activity_(std::string(this->name()) + ".blend", clock),
      drain_activity_(std::string(this->name()) + ".drain", clock),
      finished_(std::string(this->name()) + ".finished", clock, config.pixel_buffers,
                config.depth_cycles),
      free_buffers_(std::string(this->name()) + ".free_buffers", clock, config.pixel_buffers, 0) {
  SC_THREAD(blend);
  SC_THREAD(drain);
}

void RenderingUnit::blend() {
  std::size_t turn = 0;
  for (std::uint32_t group = 0; group < job_.groups.size(); ++group) {
    free_buffers_.pop(blend_activity_, ActivityState::kBlocked);
    current_group_ = group;
    auto state = std::make_shared<GroupState>(
        job_.groups[group], job_.view.width, job_.view.height,
        config_.ellipse_test ? SubtileTest::kEllipse : SubtileTest::kBox);
    for (Mark mark = Mark::kNone; mark != Mark::kEndOfGroup;) {
      const SplatToken token = sorted_[turn % sorted_.size()]->pop(blend_activity_);
      mark = token.mark;
      if (mark == Mark::kNone) {
        blend_splat(token.splat, group, *state);
      } else if (mark == Mark::kRejected) {
        blend_activity_.work(1);
      }
      turn += mark != Mark::kNone || arrival_ == Arrival::kByToken ? 1 : 0;
    }
    ++counters_.groups;
    counters_.groups_saturated += state->saturated() ? 1 : 0;
    counters_.contributors += state->contributors();
    finished_.push(std::move(state), blend_activity_);
  }
  blend_activity_.enter(ActivityState::kStarved);
}

void RenderingUnit::blend_splat(const Splat& splat, std::uint32_t group, GroupState& state) {
  if (state.saturated()) {
    ++counters_.splats_saturated;
    return;
  }
  const BlendWork work = state.blend(splat);
  const auto cycles = [](std::uint32_t count, std::uint32_t per_cycle) {
    return (count + per_cycle - 1) / per_cycle;
  };
  blend_activity_.work(std::max({1U, cycles(work.blended, config_.clusters),
                                 cycles(work.tested, config_.subtile_tests_per_cycle)}));
  counters_.subtile_tests += work.tested;
  counters_.subtile_blends += work.blended;
  counters_.splats += work.blended > 0 ? 1 : 0;
  if (state.saturated() && config_.saturation_feedback) board_.set(group);
}

void RenderingUnit::drain() {
  for (std::uint32_t buffer = 0; buffer < config_.pixel_buffers; ++buffer) {
    free_buffers_.push(buffer, drain_activity_);
  }
  for (std::size_t done = 0; done < job_.groups.size(); ++done) {
    const std::shared_ptr<GroupState> state = finished_.pop(drain_activity_);
    write_group(*state);
    free_buffers_.push(0, drain_activity_);
  }
  await_all(port_, drain_activity_);
  drain_activity_.enter(ActivityState::kStarved);
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
    drain_activity_.work((width + config_.drain_pixels_per_cycle - 1) /
                         config_.drain_pixels_per_cycle);
    start_write(port_, drain_activity_,
                job_.layout.pixel_address(pixels.x0, y, job_.view.width, job_.frame_format),
                row.data(), static_cast<std::uint32_t>(row.size()),
                region_id(Region::kFrameBuffer));
  }
}

void RenderingUnit::trace(sc_core::sc_trace_file* file) const {
  blend_activity_.trace(file);
  drain_activity_.trace(file);
  sc_core::sc_trace(file, current_group_, std::string(name()) + ".group");
}

}  // namespace sgs
