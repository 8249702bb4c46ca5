// Rays, passes and visits of one group after the other.
#include "modules/streaminggs/vsu/paper_vsu_estimate.h"

#include <algorithm>

#include "algorithm/voxel/ray_path.h"
#include "algorithm/voxel/ray_sampling.h"
#include "algorithm/voxel/voxel_cuts.h"
#include "modules/streaminggs/vsu/rays_in_flight.h"

namespace sgs {

PaperVsuEstimate::PaperVsuEstimate(const PaperVsuConfig& config,
                                   const OperationLatencies& latencies,
                                   const VoxelTableLayout& layout, const VoxelGrid& grid,
                                   const View<float>& view, const Ports& ports)
    : config_(config),
      layout_(layout),
      grid_(grid),
      view_(view),
      rays_(config, latencies, layout.nodes, grid.nodes, ports.nodes,
            {[this] { rays_.go_on(ordered_.room(rays_.now())); },
             [this](const std::vector<std::uint32_t>& voxels, bool last) {
               hand_over(voxels, last);
             }}),
      record_port_(ports.records),
      records_(config.record_cache_bytes, layout.voxels),
      cuts_(config.cut_cache_bytes, layout.cuts),
      table_(layout.voxels.count, config.table_bytes, config.table_banks),
      ordered_(config.groups_ahead) {}

void PaperVsuEstimate::order(const Group& group) {
  group_ = &group;
  rays_.charge_to(group.number);
  const auto follow = [&](auto&& path) {
    RaysInFlight in_flight(view_, path, rays_);
    return group_visits(group.pixels, in_flight, table_);
  };
  GroupVisits visits;
  if (grid_.nodes.empty()) {
    hand_over({}, true);
  } else if (config_.sample_step_voxels > 0) {
    visits = follow(SamplePath(layout_.frame, config_.rays().sample_step_voxels));
  } else {
    visits = follow(RayPath<float>(layout_.frame));
  }
  PaperVsu::Counters& counters = work_.counters;
  if (visits.voxels.empty()) ++counters.groups_empty;
  counters.rays += visits.rays;
  counters.steps += visits.steps;
  counters.edges += visits.edges_offered;
  counters.overflows += visits.overflows;
  counters.table_bytes_max = std::max(counters.table_bytes_max, visits.table_bytes);
}

void PaperVsuEstimate::hand_over(const std::vector<std::uint32_t>& voxels, bool last) {
  ++work_.counters.passes;
  rays_.go_on(ordered_.push(rays_.now()));
  emit_ = ordered_.front(emit_);
  record_port_.charge_to(group_->number);
  for (const std::uint32_t voxel : voxels) {
    if (group_->finished(emit_)) {
      ++work_.counters.visits_saturated;
    } else {
      visit_voxel(voxel);
    }
  }
  ordered_.remove(emit_);
  if (!last) return;
  ++work_.emit_cycles;
  emit_ = group_->end(emit_ + 1);
}

void PaperVsuEstimate::visit_voxel(std::uint32_t voxel) {
  ++work_.counters.voxels;
  const auto plane = [&](std::uint32_t index) {
    ++emit_;
    ++work_.emit_cycles;
    ++work_.counters.cuts;
    look_up(cuts_, index);
    return grid_.cuts[index];
  };
  const auto visit = [&](const VoxelRecord& piece) {
    ++work_.counters.visits;
    ++work_.emit_cycles;
    emit_ = group_->visit(piece, emit_ + 1);
    return !group_->finished(emit_);
  };
  look_up(records_, voxel);
  visit_pieces(grid_.voxels[voxel], view_.position, config_.visit_gaussians, plane, visit);
}

template <class Record>
void PaperVsuEstimate::look_up(TableCache<Record>& cache, std::uint32_t index) {
  if (cache.find(index) != nullptr) return;
  const std::uint64_t tag = cache.line_of(index);
  const auto missing = cache.miss(tag);
  const PortEstimate::Access access =
      record_port_.read(emit_, missing.address, missing.bytes, cache.table().region);
  emit_ = access.answered;
  typename TableCache<Record>::Line line;
  line.tag = tag;
  cache.fill(line);
}

PaperVsu::Work PaperVsuEstimate::work() const {
  PaperVsu::Work work = work_;
  work.rays = rays_.work();
  work.traverse_cycles = rays_.busy_cycles();
  work.nodes = {rays_.nodes.lookups(), rays_.nodes.misses()};
  work.records = {records_.lookups(), records_.misses()};
  work.planes = {cuts_.lookups(), cuts_.misses()};
  work.ordered = ordered_.pushed();
  work.node_traffic = rays_.traffic();
  work.record_traffic = record_port_.traffic();
  return work;
}

}  // namespace sgs
