// The voxel ordering table of the paper: the rays' sequences of voxels of one pixel group make a
// directed graph, and a topological order of it (Kahn, "Topological sorting of large networks",
// 1962) visits every voxel after all that hide it on some ray.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "algorithm/order/ready_voxels.h"
#include "algorithm/order/renaming.h"

namespace sgs {

// Memory that one group's table takes, by count of renamed voxels and of distinct edges: per voxel
// its global id (4 B), in-degree (2 B) and list head (2 B); per edge the successor and the next
// link (4 B).
constexpr std::uint32_t kOrderingBytesPerVoxel = 8;
constexpr std::uint32_t kOrderingBytesPerEdge = 4;

// What has been read and written so far, a voxel's record or an edge at a time.
struct OrderingAccesses {
  std::uint64_t met = 0;                            // voxels
  std::uint64_t reads = 0, writes = 0;              // of the table
  std::uint64_t heads_read = 0;                     // of these reads: where edges are looked for
  std::uint64_t names_read = 0, names_written = 0;  // of the renaming
  std::uint64_t ready_read = 0, ready_written = 0;  // of the words of ready voxels
};

class OrderingTable {
  static constexpr std::uint32_t kNone = ~0U;

 public:
  static constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

  // voxel_count: how many voxels exist; ids below it may appear in chains. capacity_bytes:
  // memory that is there for one group, at least that of a voxel.
  explicit OrderingTable(std::size_t voxel_count, std::uint64_t capacity_bytes = kUnlimited);

  // Voxels for which a table of so many bytes has room.
  static std::uint64_t most_voxels(std::uint64_t capacity_bytes) {
    return capacity_bytes / kOrderingBytesPerVoxel;
  }

  // Forgets the group before.
  void clear();

  // Of a ray: the number of the voxel that it met last, if any.
  class Chain {
    friend class OrderingTable;
    std::uint32_t before = kNone;
  };

  // The next voxel that a ray meets. Voxels are renamed 0, 1, 2, ... as they first appear; each
  // consecutive pair of a ray gives an edge. Returns false where a voxel or an edge finds no room:
  // the table is to be cleared then.
  bool add(Chain& chain, std::uint32_t voxel);

  // Voxels in visiting order; among those that are ready the lowest renamed id goes first. The
  // in-degrees are used up: once, before the table is cleared. Throws std::logic_error on a cycle,
  // which monotonic rays from one centre cannot make.
  std::vector<std::uint32_t> order();

  std::uint32_t voxel_count() const { return static_cast<std::uint32_t>(voxels_.size()); }
  std::uint32_t edge_count() const {
    return static_cast<std::uint32_t>(edges_.size());
  }                                                               // distinct
  std::uint64_t edges_offered() const { return edges_offered_; }  // by all rays
  std::uint64_t bytes() const {
    return std::uint64_t{voxel_count()} * kOrderingBytesPerVoxel +
           std::uint64_t{edge_count()} * kOrderingBytesPerEdge;
  }
  const OrderingAccesses& accesses() const { return accesses_; }
  // What was written of the voxel added last: the table's words of 8 B, a voxel's record or two
  // edges, each kind by its number; and how many words of ready voxels.
  const std::vector<std::uint32_t>& written() const { return written_; }
  std::uint64_t ready_written() const { return ready_written_; }
  // Of a voxel by its number, in the order of its list: visit(word of the edge, successor).
  template <class Visit>
  void for_each_edge(std::uint32_t number, const Visit& visit) const {
    for (std::uint32_t at = voxels_[number].first_edge; at != kNone; at = edges_[at].next) {
      visit(word_of_edge(at), edges_[at].successor);
    }
  }
  // Of words, that finding the first of the ready voxels passes.
  std::uint32_t ready_levels() const { return ready_.levels(); }

 private:
  struct Voxel {
    std::uint32_t id, in_degree, first_edge;
  };
  struct Edge {
    std::uint32_t successor, next;
  };

  std::uint32_t rename(std::uint32_t voxel, bool first);  // of its ray
  void add_edge(std::uint32_t from, std::uint32_t to, bool is_new);
  bool fits() const { return bytes() <= capacity_bytes_; }

  static std::uint32_t word_of_edge(std::uint32_t edge) { return edge / 2; }
  void write(std::uint32_t word) {
    ++accesses_.writes;
    written_.push_back(word);
  }
  void count_ready(std::uint32_t words) {
    accesses_.ready_read += words;
    accesses_.ready_written += words;
    ready_written_ += words;
  }

  const std::uint64_t capacity_bytes_;
  std::vector<std::uint32_t> written_;  // words, of the voxel added last
  std::uint64_t ready_written_ = 0;     // words, likewise
  Renaming names_;
  ReadyVoxels ready_;
  std::vector<Voxel> voxels_;  // [renamed id]
  std::vector<Edge> edges_;
  std::uint64_t edges_offered_ = 0;
  OrderingAccesses accesses_;
};

}  // namespace sgs
