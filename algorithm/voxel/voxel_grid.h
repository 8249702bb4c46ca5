// The grid of StreamingGS (DAC 2025): Gaussians by the cubic voxel that holds their centre. Only
// occupied cells exist: a sparse tree of 4x4x4 nodes finds them, so nothing is sized by the dense
// grid (real scenes span 10^12 cells).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "algorithm/splat/gaussian.h"

namespace sgs {

// A table that finds Gaussians by their storage slots, and which of the cloud's Gaussians goes into
// which slot. Whoever reads the table has the cloud in that order (`reordered`,
// ../splat/gaussian.h): to them a slot is a Gaussian's index, and equal depths are ordered by it.
template <class Table>
struct Arrangement {
  Table table;
  std::vector<std::uint32_t> storage_order;  // [slot] index in the cloud
};

// 64 children, one bit each, in Morton order of their place in the 4x4x4 block. Children lie
// contiguously: child k of a node is entry first_child + popcount(occupied below bit k), a node of
// the next finer level or, on the finest, a voxel. This is also the record in the modelled DRAM (16
// B).
struct VoxelNode {
  std::uint64_t occupied = 0;
  std::uint32_t first_child = 0;
  std::uint32_t reserved = 0;
};

// Where a voxel's Gaussians lie, in storage slots. The record in the modelled DRAM (8 B).
struct VoxelRecord {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

// The place and size of the tree: a traversal needs them besides the table.
struct VoxelFrame {
  float voxel_size = 0;       // world units
  glm::ivec3 origin_cell{0};  // cell of the root's corner; cell i spans [i, i + 1) voxel_size
  int levels = 1;             // the root spans 4^levels cells a side; levels <= 10
  int side_cells() const { return 1 << (2 * levels); }
};

struct VoxelGrid {
  VoxelFrame frame;
  std::vector<VoxelNode> nodes;     // breadth first, root at 0; empty for an empty cloud
  std::vector<VoxelRecord> voxels;  // Morton order
  std::vector<float> cuts;          // cuts of voxels into pieces: cut_voxels()
};

// Place of local cell (x, y, z), each 0 to 3, among the 64 children.
inline unsigned child_bit(unsigned x, unsigned y, unsigned z) {
  constexpr unsigned kSpread[4] = {0, 1, 8, 9};
  return kSpread[x] | kSpread[y] << 1U | kSpread[z] << 2U;
}

// Which Gaussians are stored: all, or only those that some view could show (opacity >= 1/255).
enum class Stored { kAll, kVisible };

// Their indices in the cloud, ascending.
std::vector<std::uint32_t> stored_gaussians(const ActivatedCloud& cloud, Stored stored);

// Cell of a coordinate along one axis.
int cell_of(float coordinate, float voxel_size);

// Storage order: by voxel, then index. Throws InputError when the occupied cells span more than
// 2^20 along an axis (the message names the smallest voxel size that fits).
Arrangement<VoxelGrid> arrange_by_voxels(const ActivatedCloud& cloud, float voxel_size,
                                         Stored stored = Stored::kVisible);

// Longest side of the box between the 0.1 % and 99.9 % quantiles of the centres; world units.
float inner_extent(const ActivatedCloud& cloud);

// The paper's voxel sizes, in world units: 0.4 for small synthetic scenes, 2 for real ones. A scene
// counts as small when its inner extent is at most kSmallSceneExtent.
constexpr float kSmallSceneExtent = 10;
constexpr double kSmallVoxelSize = 0.4, kRealVoxelSize = 2;
double paper_voxel_size(float inner_extent);

// Which children of a node a ray can still meet, and how large the block is in which there are
// none: it is crossed in one step.

// [axis][place of a child along it, 0 to 3] the children there, one bit each (child_bit).
constexpr std::uint64_t kChildLayers[3][4] = {
    {0x0055005500550055, 0x00aa00aa00aa00aa, 0x5500550055005500, 0xaa00aa00aa00aa00},
    {0x0000333300003333, 0x0000cccc0000cccc, 0x3333000033330000, 0xcccc0000cccc0000},
    {0x000000000f0f0f0f, 0x00000000f0f0f0f0, 0x0f0f0f0f00000000, 0xf0f0f0f000000000}};

// Children at `place` of an axis or, seen along `step` (-1, 0 or 1), behind it.
constexpr std::uint64_t children_from(int axis, int step, unsigned place) {
  std::uint64_t out = kChildLayers[axis][place];
  for (unsigned other = 0; other < 4; ++other) {
    const bool behind = step > 0 ? other > place : step < 0 && other < place;
    if (behind) out |= kChildLayers[axis][other];
  }
  return out;
}

// log2 of the cells a side of the largest block around child `at` of a node in which a ray that has
// done with that child can meet nothing more: the child, its octant of the node, or the node, of
// 4^level cells a side. A ray only ever moves on along `step`.
inline int empty_block(const VoxelNode& node, const glm::uvec3& at, const glm::ivec3& step,
                       int level) {
  const unsigned child = child_bit(at.x, at.y, at.z);
  std::uint64_t ahead = node.occupied & ~(std::uint64_t{1} << child);
  for (int axis = 0; axis < 3; ++axis) ahead &= children_from(axis, step[axis], at[axis]);
  if (ahead == 0) return 2 * level;
  const bool octant_empty = (ahead >> (child & ~7U) & 0xffU) == 0;
  return 2 * (level - 1) + (octant_empty ? 1 : 0);
}

// Voxels with more Gaussians than a list holds, cut until each piece fits: at the median along x,
// then y, then z, then x again; three cuts make eight boxes. The pieces of a voxel are boxes beside
// each other, so that from anywhere they can be visited front to back, exactly.
//
// Where a piece is cut follows from its count alone, along which axis from how often it was cut:
// only the planes are stored, a float for every kCutSpacing slots. How small the pieces get is up
// to who reads them.

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
