#include "algorithm/tune/visit_plan.h"

#include "algorithm/tune/visited_sequences.h"

namespace sgs {
namespace {

std::size_t bytes_of(const std::vector<std::vector<std::uint32_t>>& voxels) {
  std::size_t bytes = voxels.size() * sizeof(voxels[0]);
  for (const auto& group : voxels) bytes += group.capacity() * sizeof(group[0]);
  return bytes;
}

}  // namespace

std::shared_ptr<const VisitPlan::GroupVoxels> VisitPlan::visits(std::size_t at,
                                                                const View<float>& view) {
  if (at >= kept_.size()) kept_.resize(at + 1);
  if (kept_[at]) return kept_[at];
  auto made = std::make_shared<GroupVoxels>(visited_voxels(view, grid_, order_));
  for (std::vector<std::uint32_t>& group : *made) group.shrink_to_fit();
  if (const std::size_t bytes = bytes_of(*made); kept_bytes_ + bytes <= most_bytes_) {
    kept_bytes_ += bytes;
    kept_[at] = made;
  }
  return made;
}

GroupSequences VisitPlan::sequences(std::size_t at, const View<float>& view,
                                    const ActivatedCloud& cloud) {
  return visited_sequences(view, cloud, grid_, *visits(at, view), order_.group,
                           order_.visit_gaussians);
}

}  // namespace sgs
