// The time of the rendering unit (rendering_unit.h) without a kernel and without pixels: the same
// schedule of the clusters over the sub-tiles that the golden renderer's splats reached.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "algorithm/render/blend_record.h"
#include "modules/streaminggs/rendering/cluster_schedule.h"
#include "modules/streaminggs/rendering/rendering_unit.h"
#include "tlm/fifo_times.h"
#include "tlm/port_estimate.h"

namespace sgs {

class RenderingEstimate {
 public:
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  RenderingEstimate(const RenderingConfig& config, const StreamingJob& job,
                    const PortEstimate& port);
  RenderingEstimate(const RenderingEstimate&) = delete;  // the schedule refers to the configuration

  void begin_group(std::uint32_t group, const BlendRecord& blends);
  // A token that came in cycle `ready` at the earliest: a splat by its number in the record, or a
  // mark. Says when it was taken.
  std::uint64_t blend(FifoTimes& splats, std::uint32_t splat);
  std::uint64_t pass(FifoTimes& splats);
  void end_group();

  // From which cycle on the other units see that the group at hand is finished.
  std::uint64_t finished_from() const { return finished_from_; }
  // Whether they see in a cycle that all sub-tiles of a reach are.
  bool finished(const GroupReach& reach, std::uint64_t cycle) const;

  // When the last pixel has been written.
  std::uint64_t done() const;
  RenderingUnit::Work work() const;

 private:
  void reach(const BlendedSplat& splat);
  void drain(const PixelRect& pixels);

  const RenderingConfig config_;
  const StreamingJob& job_;
  PortEstimate port_;
  ClusterSchedule schedule_;
  FifoTimes finished_;
  std::vector<std::uint64_t> buffers_;  // ring: when they were drained
  std::uint32_t group_ = 0;
  const BlendRecord* blends_ = nullptr;
  int corner_x_ = 0, corner_y_ = 0, columns_ = 0, rows_ = 0;  // of the group, sub-tiles
  std::vector<std::uint8_t> blended_out_;                     // [sub-tile] finished
  std::uint32_t unfinished_ = 0;
  std::uint64_t finished_from_ = kNever;
  std::uint64_t blend_ = 0, drain_ = 0;  // until when they work
  std::uint64_t ended_ = 0;              // the group before
  RenderingUnit::Work work_;
};

}  // namespace sgs
