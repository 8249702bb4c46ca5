// The time of VSU in paper order (paper_vsu.h) without a kernel: the same rays through the same
// tree, in the same turns, and the visits of what they order.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "algorithm/memory/scene_layout.h"
#include "algorithm/order/ordering_table.h"
#include "algorithm/splat/view.h"
#include "algorithm/voxel/voxel_grid.h"
#include "modules/streaminggs/vsu/paper_vsu.h"
#include "modules/streaminggs/vsu/ray_unit_estimate.h"
#include "tlm/fifo_times.h"

namespace sgs {

class PaperVsuEstimate {
 public:
  struct Ports {
    PortEstimate nodes, records;
  };
  // grid: what the table in DRAM holds. It and the view outlive the estimate.
  PaperVsuEstimate(const PaperVsuConfig& config, const OperationLatencies& latencies,
                   const VoxelTableLayout& layout, const VoxelGrid& grid, const View<float>& view,
                   const Ports& ports);
  PaperVsuEstimate(const PaperVsuEstimate&) = delete;  // its parts refer to each other

  // Follows a group's rays and hands its voxels out, pass by pass.
  // finished(cycle): whether the group is known to be; visit(piece, cycle): hands out the next
  // visit, whose shares are made in this cycle, and says when the last is taken; end(cycle): the
  // same of the mark behind the group.
  struct Group {
    std::uint32_t number;
    PixelRect pixels;
    std::function<bool(std::uint64_t)> finished;
    std::function<std::uint64_t(const VoxelRecord&, std::uint64_t)> visit;
    std::function<std::uint64_t(std::uint64_t)> end;
  };
  void order(const Group& group);

  PaperVsu::Work work() const;

 private:
  void hand_over(const std::vector<std::uint32_t>& voxels, bool last);
  void visit_voxel(std::uint32_t voxel);
  // The cycle in which a cache has the record that is wanted now.
  template <class Record>
  void look_up(TableCache<Record>& cache, std::uint32_t index);

  const PaperVsuConfig config_;
  const VoxelTableLayout& layout_;
  const VoxelGrid& grid_;
  const View<float>& view_;
  RayUnitEstimate rays_;
  PortEstimate record_port_;
  TableCache<VoxelRecord> records_;
  TableCache<float> cuts_;
  OrderingTable table_;
  FifoTimes ordered_;
  const Group* group_ = nullptr;  // at hand
  std::uint64_t emit_ = 0;        // until when visits are handed out
  PaperVsu::Work work_;
};

}  // namespace sgs
