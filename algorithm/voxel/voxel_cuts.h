// Voxels with more Gaussians than a list holds, cut until each piece fits: at the median along x,
// then y, then z, then x again; three cuts make eight boxes. The pieces of a voxel are boxes beside
// each other, so that from anywhere they can be visited front to back, exactly.
//
// Where a piece is cut follows from its count alone, along which axis from how often it was cut:
// only the planes are stored, a float for every kCutSpacing slots. How small the pieces get is up
// to who reads them.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "algorithm/splat/gaussian.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// Pieces of at most so many are not cut.
constexpr std::uint32_t kLeastCut = 64;
// A cut piece has more than kLeastCut, each half at least half of that: two cuts are so far apart.
constexpr std::uint32_t kCutSpacing = kLeastCut / 2;

constexpr std::uint32_t cut_slot(const VoxelRecord& piece) { return piece.first + piece.count / 2; }
constexpr std::uint32_t cut_index(std::uint32_t slot) { return slot / kCutSpacing; }
constexpr std::uint32_t cut_count(std::uint32_t slots) {
  return (slots + kCutSpacing - 1) / kCutSpacing;
}

// Puts the Gaussians of each voxel in the order of its pieces, those of a piece that is not cut by
// index, and returns the planes: [cut_index(slot)] world units, 0 where there is no cut. On each
// axis what lies in front of the slot is at most the plane, the rest at least.
std::vector<float> cut_voxels(const ActivatedCloud& cloud, const std::vector<VoxelRecord>& voxels,
                              std::vector<std::uint32_t>& storage_order);

// Calls visit(piece) for the pieces of a voxel of at most `most` Gaussians (0: the voxel as it is),
// nearest first as seen from `eye`; it returns whether to go on. plane(index): of cut_index().
template <class Plane, class Visit>
void visit_pieces(const VoxelRecord& voxel, const glm::vec3& eye, std::uint32_t most, Plane&& plane,
                  Visit&& visit) {
  struct Piece {
    VoxelRecord record;
    int axis;
  };
  constexpr int kMostOpen = 33;  // a piece for each halving of 32-bit counts, and one
  Piece open[kMostOpen];
  int count = 0;
  open[count++] = {voxel, 0};
  while (count > 0) {
    const Piece piece = open[--count];
    if (most == 0 || piece.record.count <= most || piece.record.count <= kLeastCut) {
      if (!visit(piece.record)) return;
      continue;
    }
    const std::uint32_t slot = cut_slot(piece.record), left = slot - piece.record.first;
    const int next = (piece.axis + 1) % 3;
    const Piece low{{piece.record.first, left}, next};
    const Piece high{{slot, piece.record.count - left}, next};
    const bool low_first = eye[piece.axis] < plane(cut_index(slot));
    open[count++] = low_first ? high : low;
    open[count++] = low_first ? low : high;
  }
}

}  // namespace sgs
