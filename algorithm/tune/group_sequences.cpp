// The order of the reference renderer; drawing of any order.
#include "algorithm/tune/group_sequences.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "algorithm/render/blend_pass.h"
#include "algorithm/render/group_state.h"
#include "algorithm/splat/make_splat.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

namespace {

// Any multiple of 4 gives the same picture. Next to the renderer's tiles of 16 px a splat falls on
// fewer groups, which spares a twelfth of the time; with 64 px too few are left for many threads.
constexpr int kGroupPx = 32;

// [slot] position among the splats, or kNoSplat.
std::vector<std::uint32_t> positions_of(const std::vector<Splat>& splats, std::size_t slots) {
  std::vector<std::uint32_t> positions(slots, kNoSplat);
  for (std::size_t i = 0; i != splats.size(); ++i) {
    positions[splats[i].index] = static_cast<std::uint32_t>(i);
  }
  return positions;
}

std::size_t bytes_of(const std::vector<std::vector<std::uint32_t>>& voxels) {
  std::size_t bytes = voxels.size() * sizeof(voxels[0]);
  for (const auto& group : voxels) bytes += group.capacity() * sizeof(group[0]);
  return bytes;
}

}  // namespace

GroupSequences reference_sequences(const View<float>& view, const ActivatedCloud& cloud) {
  GroupSequences out;
  out.width = view.width;
  out.height = view.height;
  SplatSequence sequence(view, cloud);
  sequence.next(sequence.keys().size(), out.splats);
  out.groups = pixel_groups(view.width, view.height, square_of(kGroupPx));
  SplatBins bins = bin_splats(cell_grid(view.width, view.height, square_of(kGroupPx)),
                              out.splats.data(), out.splats.size());
  out.first = std::move(bins.first);
  out.entries = std::move(bins.entries);
  return out;
}

RenderResult draw(const GroupSequences& sequences, const glm::vec3& background,
                  BlendPrecision precision) {
  RenderResult result(sequences.width, sequences.height);
  tbb::parallel_for(std::size_t{0}, sequences.groups.size(), [&](std::size_t group) {
    GroupState state(sequences.groups[group], sequences.width, sequences.height, precision);
    for (std::size_t i = sequences.first[group]; i != sequences.first[group + 1]; ++i) {
      if (state.saturated()) break;
      state.blend(sequences.splat_of(i));
    }
    state.store(background, result);
  });
  return result;
}

GroupSequences visited_sequences(const View<float>& view, const ActivatedCloud& cloud,
                                 const VoxelGrid& grid,
                                 const std::vector<std::vector<std::uint32_t>>& group_voxels,
                                 const PixelSize& group_size, std::uint32_t visit_gaussians) {
  GroupSequences out;
  out.width = view.width;
  out.height = view.height;
  out.groups = pixel_groups(view.width, view.height, group_size);
  SplatSequence frame(view, cloud);
  frame.next(frame.keys().size(), out.splats);
  const std::vector<std::uint32_t> positions = positions_of(out.splats, cloud.size());

  std::vector<std::vector<std::uint32_t>> sequences(out.groups.size());
  tbb::parallel_for(std::size_t{0}, out.groups.size(), [&](std::size_t group) {
    std::vector<std::uint32_t>& sequence = sequences[group];
    const auto plane = [&](std::uint32_t index) { return grid.cuts[index]; };
    const auto visit = [&](const VoxelRecord& piece) {
      const auto visited = static_cast<std::ptrdiff_t>(sequence.size());
      const std::uint32_t end = piece.first + piece.count;
      for (std::uint32_t slot = piece.first; slot != end; ++slot) {
        // Splats lie in the order of depth: fetched ahead.
        constexpr std::uint32_t kAhead = 8;
        const std::uint32_t ahead = slot + kAhead < end ? positions[slot + kAhead] : kNoSplat;
        if (ahead != kNoSplat) {
          __builtin_prefetch(&out.splats[ahead]);
          __builtin_prefetch(&out.splats[ahead].footprint);
        }
        const std::uint32_t position = positions[slot];
        if (position == kNoSplat) continue;
        if (reaches_group(out.splats[position], out.groups[group])) sequence.push_back(position);
      }
      std::sort(sequence.begin() + visited, sequence.end());
      return true;
    };
    for (const std::uint32_t voxel : group_voxels[group]) {
      visit_pieces(grid.voxels[voxel], view.position, visit_gaussians, plane, visit);
    }
  });
  out.first.push_back(0);
  for (const auto& sequence : sequences) {
    out.entries.insert(out.entries.end(), sequence.begin(), sequence.end());
    out.first.push_back(out.entries.size());
  }
  return out;
}

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
