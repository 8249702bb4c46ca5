// Splats of one group after the other.
#include "modules/streaminggs/rendering/rendering_estimate.h"

#include <algorithm>

namespace sgs {

RenderingEstimate::RenderingEstimate(const RenderingConfig& config, const StreamingJob& job,
                                     const PortEstimate& port)
    : config_(config),
      job_(job),
      port_(port),
      schedule_(config_),
      finished_(config.pixel_buffers, config.depth_cycles + config.drain_depth_cycles),
      buffers_(config.pixel_buffers) {}

void RenderingEstimate::begin_group(std::uint32_t group, const BlendRecord& blends) {
  group_ = group;
  blends_ = &blends;
  const PixelRect& pixels = job_.groups[group];
  corner_x_ = pixels.x0 / kSubtilePx;
  corner_y_ = pixels.y0 / kSubtilePx;
  columns_ = (pixels.x1 + kSubtilePx - 1) / kSubtilePx - corner_x_;
  rows_ = (pixels.y1 + kSubtilePx - 1) / kSubtilePx - corner_y_;
  const auto subtiles = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  schedule_.begin_group(subtiles, static_cast<std::size_t>(columns_));
  blended_out_.assign(subtiles, 0);
  unfinished_ = static_cast<std::uint32_t>(subtiles);
  finished_from_ = kNever;
  blend_ = std::max(blend_, buffers_[group % buffers_.size()]);
}

std::uint64_t RenderingEstimate::pass(FifoTimes& splats) {
  const std::uint64_t taken = splats.pop(blend_);
  blend_ = taken + 1;
  ++work_.blend_cycles;
  return taken;
}

std::uint64_t RenderingEstimate::blend(FifoTimes& splats, std::uint32_t number) {
  const BlendedSplat& splat = blends_->splats()[number];
  const std::uint64_t taken = splats.pop(blend_);
  if (!schedule_.any_unfinished(splat.box.subtiles, taken)) {
    const bool all = unfinished_ == 0 && taken >= schedule_.group_finished_from();
    ++(all ? work_.counters.splats_saturated : work_.counters.splats_hidden);
    blend_ = taken + 1;
    ++work_.blend_cycles;
    return taken;
  }
  ++work_.counters.splats_taken;
  schedule_.begin_splat(taken, splat.box.spanned);
  const std::uint64_t late = schedule_.counters().late_blends;
  const std::uint64_t blends = schedule_.counters().blends;
  reach(splat);
  work_.counters.spans += splat.spans;
  work_.counters.begun_span_reads += cycles_for(splat.spans, config_.spans_at_once());
  work_.counters.splats_spanned += splat.spans > 0 ? 1 : 0;
  const std::uint64_t in_vain = schedule_.counters().late_blends - late;
  work_.counters.splats += schedule_.counters().blends - blends > in_vain ? 1 : 0;
  blend_ = std::max(taken, schedule_.end_splat(splat.rows, splat.spans));
  work_.blend_cycles += blend_ - taken;
  return taken;
}

void RenderingEstimate::reach(const BlendedSplat& splat) {
  const BlendRow* const rows = blends_->rows_of(splat);
  const std::uint32_t* finishes = blends_->finishes_of(splat);
  const std::uint32_t* const last = finishes + splat.finishes;
  for (std::uint32_t row = 0; row < splat.rows; ++row) {
    const int y = splat.box.subtiles.y0 + static_cast<int>(row);
    for (int x = rows[row].x0; x < rows[row].x1; ++x) {
      const auto at = static_cast<std::size_t>(y * columns_ + x - corner_x_);
      const bool finishing = finishes != last && *finishes == at;
      finishes += finishing ? 1 : 0;
      schedule_.reach({at, x, y + corner_y_, blended_out_[at] == 0, finishing, row});
      if (!finishing) continue;
      blended_out_[at] = 1;
      ++work_.news;
      if (--unfinished_ == 0 && config_.saturation_feedback) {
        finished_from_ = schedule_.group_finished_from() + config_.feedback_latency_cycles;
      }
    }
  }
}

bool RenderingEstimate::finished(const GroupReach& reach, std::uint64_t cycle) const {
  if (!config_.saturation_feedback || work_.news == 0) return false;
  for (int y = reach.y0; y <= std::min<int>(reach.y1, rows_ - 1); ++y) {
    for (int x = reach.x0; x <= std::min<int>(reach.x1, columns_ - 1); ++x) {
      const auto at = static_cast<std::size_t>(y * columns_ + x);
      if (blended_out_[at] == 0 ||
          schedule_.subtile_finished_from(at) + config_.feedback_latency_cycles > cycle) {
        return false;
      }
    }
  }
  return true;
}

void RenderingEstimate::end_group() {
  const std::uint64_t all = std::max(blend_, schedule_.all_done());
  work_.blend_cycles += all - blend_;
  blend_ = finished_.push(all);
  ++work_.counters.groups;
  work_.counters.groups_saturated += unfinished_ == 0 && !job_.groups[group_].empty() ? 1 : 0;
  work_.cycles_of_groups.push_back(blend_ - ended_);
  ended_ = blend_;
  drain_ = finished_.pop(drain_);
  drain(job_.groups[group_]);
  buffers_[group_ % buffers_.size()] = drain_;
}

void RenderingEstimate::drain(const PixelRect& pixels) {
  const auto width = static_cast<std::uint32_t>(pixels.width());
  const std::uint32_t bytes = width * pixel_bytes(job_.frame_format);
  port_.charge_to(group_);
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    const std::uint32_t cycles = config_.drain_row_cycles(width);
    work_.drain_cycles += cycles;
    drain_ = port_
                 .write(drain_ + cycles, job_.pixel_address(pixels.x0, y), bytes,
                        job_.frame_buffer.region)
                 .sent;
  }
  if (pixels.empty()) return;
  drain_ += kClearCycles;
  work_.drain_cycles += kClearCycles;
}

std::uint64_t RenderingEstimate::done() const { return std::max(drain_, port_.all_answered()); }

RenderingUnit::Work RenderingEstimate::work() const {
  RenderingUnit::Work work = work_;
  work.clusters = schedule_.counters();
  work.traffic = port_.traffic();
  return work;
}

}  // namespace sgs
