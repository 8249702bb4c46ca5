// The voxel ordering table of the paper: the rays' sequences of voxels of one pixel group make a
// directed graph, and a topological order of it (Kahn, "Topological sorting of large networks",
// 1962) visits every voxel after all that hide it on some ray.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace sgs {

// SRAM that one group's table takes, by count of renamed voxels and of distinct edges: per voxel
// its global id (4 B), in-degree (2 B) and list head (2 B); per edge the successor and the next
// link (4 B).
constexpr std::uint32_t kOrderingBytesPerVoxel = 8;
constexpr std::uint32_t kOrderingBytesPerEdge = 4;

class OrderingTable {
 public:
  static constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

  // voxel_count: how many voxels exist; ids below it may appear in chains. capacity_bytes: SRAM
  // that is there for one group, at least that of a voxel.
  explicit OrderingTable(std::size_t voxel_count, std::uint64_t capacity_bytes = kUnlimited);

  // Forgets the group before.
  void clear();

  // Adds the voxels that one ray meets, nearest first. Voxels are renamed 0, 1, 2, ... as they
  // first appear; each consecutive pair gives an edge. Returns false where a voxel or an edge finds
  // no room: the table is to be cleared then.
  bool add_chain(const std::vector<std::uint32_t>& voxels);

  // Voxels in visiting order; among those that are ready the lowest renamed id goes first. Throws
  // std::logic_error on a cycle, which monotonic rays from one centre cannot make.
  std::vector<std::uint32_t> order() const;

  std::uint32_t voxel_count() const { return static_cast<std::uint32_t>(voxels_.size()); }
  std::uint32_t edge_count() const { return edge_count_; }        // distinct
  std::uint64_t edges_offered() const { return edges_offered_; }  // by all rays
  std::uint64_t sram_bytes() const {
    return std::uint64_t{voxel_count()} * kOrderingBytesPerVoxel +
           std::uint64_t{edge_count()} * kOrderingBytesPerEdge;
  }

 private:
  std::uint32_t rename(std::uint32_t voxel);
  bool fits() const { return sram_bytes() <= capacity_bytes_; }

  std::vector<std::int32_t> local_of_;                  // [voxels that exist] renamed id, or -1
  std::vector<std::uint32_t> voxels_;                   // [renamed id] global id
  std::vector<std::vector<std::uint32_t>> successors_;  // [renamed id]
  std::vector<std::uint32_t> last_chain_;
  const std::uint64_t capacity_bytes_;
  std::uint32_t edge_count_ = 0;
  std::uint64_t edges_offered_ = 0;
};

}  // namespace sgs
