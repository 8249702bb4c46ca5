// The two threads of VSU.
#include "modules/vsu/vsu.h"

#include <fmt/format.h>

#include <algorithm>

#include "algorithm/voxel/ray_sampling.h"
#include "algorithm/voxel/ray_walk.h"

namespace sgs {
namespace {

// The voxel tree as a traversal sees it: nodes come out of the cache. Misses are waited for as they
// happen, the cycles of the steps themselves pass at the end of each ray.
class CachedTree {
 public:
  CachedTree(TableCache<VoxelNode>& cache, MemoryPort& port, Activity& activity)
      : cache_(cache), port_(port), activity_(activity) {}

  VoxelNode node(std::uint32_t index) { return cache_.get(index, port_, activity_); }

 private:
  TableCache<VoxelNode>& cache_;
  MemoryPort& port_;
  Activity& activity_;
};

std::uint64_t ceil_div(std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; }

}  // namespace

Vsu::Vsu(const sc_core::sc_module_name& name, const VsuConfig& config, const ClockDomain& clock,
         const FrameJob& job, const SaturationBoard& board, MemoryPort& port,
         std::vector<TimedFifo<VisitShare>*> shares)
    : sc_module(name),
      config_(config),
      job_(job),
      board_(board),
      port_(port),
      shares_(std::move(shares)),
      traverse_activity_(std::string(this->name()) + ".traverse", clock),
      emit_activity_(std::string(this->name()) + ".emit", clock),
      nodes_(config.node_cache_bytes, job.layout.node_address(0), job.layout.node_count,
             region_id(Region::kVoxelTable)),
      records_(config.record_cache_bytes, job.layout.voxel_address(0), job.layout.voxel_count,
               region_id(Region::kVoxelTable)),
      table_(job.layout.voxel_count),
      ordered_(std::string(this->name()) + ".ordered", clock, config.groups_ahead) {
  SC_THREAD(traverse);
  SC_THREAD(emit);
}

void Vsu::traverse() {
  for (std::uint32_t group = 0; group < job_.groups.size(); ++group) {
    current_group_ = group;
    auto ordered = std::make_shared<OrderedGroup>();
    ordered->group = group;
    ordered->voxels = order_group(job_.groups[group]).voxels;
    if (ordered->voxels.empty()) ++counters_.groups_empty;
    ordered_.push(std::move(ordered), traverse_activity_);
  }
  traverse_activity_.enter(ActivityState::kStarved);
}

GroupVisits Vsu::order_group(const PixelRect& pixels) {
  if (job_.layout.node_count == 0) return {};
  CachedTree tree(nodes_, port_, traverse_activity_);
  const auto on_ray = [this](std::uint32_t steps, std::size_t edges) {
    traverse_activity_.work(std::max(ceil_div(steps, config_.steps_per_cycle),
                                     ceil_div(edges, config_.edges_per_cycle)));
  };
  GroupVisits visits;
  if (config_.sample_step_voxels > 0) {
    RaySampling sampling(job_.layout.voxel_frame, tree,
                         static_cast<float>(config_.sample_step_voxels));
    visits = group_visits(job_.view, pixels, sampling, table_, on_ray);
  } else {
    RayWalk walk(job_.layout.voxel_frame, tree);
    visits = group_visits(job_.view, pixels, walk, table_, on_ray);
  }
  // Kahn's algorithm: one cycle for each voxel taken and each edge removed.
  traverse_activity_.work(table_.voxel_count() + table_.edge_count());
  counters_.rays += visits.rays;
  counters_.steps += visits.steps;
  counters_.edges += visits.edges_offered;
  counters_.table_bytes_max = std::max(counters_.table_bytes_max, visits.table_bytes);
  counters_.node_misses = nodes_.misses();
  if (visits.table_bytes > config_.table_bytes) {
    SC_REPORT_ERROR("/sgs/vsu",
                    fmt::format("the ordering table of the group at pixel ({}, {}) takes {} bytes; "
                                "vsu.table_bytes is {}: raise it, or take larger voxels",
                                pixels.x0, pixels.y0, visits.table_bytes, config_.table_bytes)
                        .c_str());
  }
  return visits;
}

void Vsu::emit() {
  for (std::size_t done = 0; done < job_.groups.size(); ++done) {
    const std::shared_ptr<OrderedGroup> ordered = ordered_.pop(emit_activity_);
    for (const std::uint32_t voxel : ordered->voxels) {
      if (board_.saturated(ordered->group)) {
        ++counters_.visits_saturated;
        continue;
      }
      current_voxel_ = voxel;
      hand_out(ordered->group, records_.get(voxel, port_, emit_activity_));
      counters_.record_misses = records_.misses();
    }
    mark_end(ordered->group);
  }
  emit_activity_.enter(ActivityState::kStarved);
}

// Splits a visit into contiguous shares of even size, no smaller than min_share and whole bursts of
// first halves; which HFU begins rotates, so that small visits spread.
void Vsu::hand_out(std::uint32_t group, const VoxelRecord& voxel) {
  const auto hfus = static_cast<std::uint32_t>(shares_.size());
  const std::uint32_t unit = std::max(2U, config_.min_share);
  const std::uint32_t share =
      static_cast<std::uint32_t>(ceil_div(ceil_div(voxel.count, hfus), unit)) * unit;
  emit_activity_.work(1);
  for (std::uint32_t k = 0; k < hfus; ++k) {
    const std::uint32_t begin = std::min(k * share, voxel.count);
    const std::uint32_t end = std::min(begin + share, voxel.count);
    shares_[(k + next_visit_) % hfus]->push(
        {group, next_visit_, voxel.first + begin, end - begin, Mark::kEndOfVisit}, emit_activity_);
  }
  ++next_visit_;
  ++counters_.visits;
}

void Vsu::mark_end(std::uint32_t group) {
  emit_activity_.work(1);
  for (TimedFifo<VisitShare>* share : shares_) {
    share->push({group, next_visit_, 0, 0, Mark::kEndOfGroup}, emit_activity_);
  }
  ++next_visit_;
}

void Vsu::trace(sc_core::sc_trace_file* file) const {
  traverse_activity_.trace(file);
  emit_activity_.trace(file);
  ordered_.trace(file);
  sc_core::sc_trace(file, current_group_, std::string(name()) + ".group");
  sc_core::sc_trace(file, current_voxel_, std::string(name()) + ".voxel");
}

}  // namespace sgs
