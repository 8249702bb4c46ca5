// Medians, voxel by voxel.
#include "algorithm/voxel/voxel_cuts.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace sgs {
namespace {

struct Cutter {
  const ActivatedCloud& cloud;
  std::vector<std::uint32_t>& order;
  std::vector<float>& planes;

  float at(std::uint32_t index, int axis) const { return cloud.gaussians[index].mean[axis]; }

  // The plane is the smallest coordinate behind it. Where many are equal, some of them lie on
  // either side, all of them on the plane.
  void cut(const VoxelRecord& piece, int axis) const {
    const auto begin = order.begin() + piece.first;
    const auto end = begin + piece.count;
    if (piece.count <= kLeastCut) {
      std::sort(begin, end);
      return;
    }
    const std::uint32_t slot = cut_slot(piece), left = slot - piece.first;
    std::nth_element(begin, begin + left, end, [&](std::uint32_t a, std::uint32_t b) {
      return at(a, axis) < at(b, axis) || (at(a, axis) == at(b, axis) && a < b);
    });
    planes[cut_index(slot)] = at(order[slot], axis);
    cut({piece.first, left}, (axis + 1) % 3);
    cut({slot, piece.count - left}, (axis + 1) % 3);
  }
};

}  // namespace

std::vector<float> cut_voxels(const ActivatedCloud& cloud, const std::vector<VoxelRecord>& voxels,
                              std::vector<std::uint32_t>& storage_order) {
  std::vector<float> planes(cut_count(static_cast<std::uint32_t>(storage_order.size())));
  const Cutter cutter{cloud, storage_order, planes};
  constexpr std::size_t kGrain = 64;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, voxels.size(), kGrain),
                    [&](const auto& range) {
                      for (std::size_t v = range.begin(); v != range.end(); ++v) {
                        cutter.cut(voxels[v], 0);
                      }
                    });
  return planes;
}

}  // namespace sgs
