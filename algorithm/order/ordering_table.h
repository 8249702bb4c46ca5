// The voxel ordering table of the paper: the rays' sequences of voxels of one pixel group make a
// directed graph, and a topological order of it (Kahn, "Topological sorting of large networks",
// 1962) visits every voxel after all that hide it on some ray.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace sgs {

// The numbers of voxels in the ordering table: a hash table of numbers with linear probing. A slot
// holds a number only; whose it is stands in the ordering table itself.
class Renaming {
 public:
  // Slots for so many voxels: a power of two, at most three quarters of them taken.
  static std::uint64_t slots_for(std::uint64_t voxels) {
    std::uint64_t slots = 2;
    while (3 * slots < 4 * voxels) slots *= 2;
    return slots;
  }

  explicit Renaming(std::uint64_t voxels) : slots_(slots_for(voxels), kFree) {}

  // The slot of a voxel, or the free one where it belongs. is_of(number): whether that number is
  // the voxel's. Counts the slots that are looked at.
  template <class IsOf>
  std::uint32_t find(std::uint32_t voxel, const IsOf& is_of, std::uint64_t& looked_at) const {
    std::uint32_t slot = first_slot(voxel);
    for (;; slot = (slot + 1) & mask()) {
      ++looked_at;
      if (slots_[slot] == kFree || is_of(slots_[slot])) return slot;
    }
  }
  bool taken(std::uint32_t slot) const { return slots_[slot] != kFree; }
  std::uint32_t number(std::uint32_t slot) const { return slots_[slot]; }
  void take(std::uint32_t slot, std::uint32_t number) {
    slots_[slot] = number;
    taken_.push_back(slot);
  }
  void clear() {
    for (const std::uint32_t slot : taken_) slots_[slot] = kFree;
    taken_.clear();
  }

 private:
  static constexpr std::uint32_t kFree = ~0U;

  std::uint32_t mask() const { return static_cast<std::uint32_t>(slots_.size() - 1); }
  // Neighbouring voxels have neighbouring ids, of which several runs would lie on top of one
  // another: three shifts and exclusive ors spread them (Marsaglia, "Xorshift RNGs", 2003).
  std::uint32_t first_slot(std::uint32_t voxel) const {
    voxel ^= voxel << 13U;
    voxel ^= voxel >> 17U;
    voxel ^= voxel << 5U;
    return voxel & mask();
  }

  std::vector<std::uint32_t> slots_;
  std::vector<std::uint32_t> taken_;
};

// The voxels of the ordering table that wait for no other: a bit each, in words, above them a bit
// for each word that has any, and so on up to one word. The first is found from the top, a word a
// level.
class ReadyVoxels {
 public:
  static constexpr std::uint32_t kWordBits = 32;

  // Words of all levels.
  static std::uint64_t all_words_for(std::uint64_t voxels) {
    std::uint64_t sum = words_for(voxels);
    for (; voxels > kWordBits; voxels = words_for(voxels)) sum += words_for(words_for(voxels));
    return sum;
  }

  explicit ReadyVoxels(std::uint64_t voxels) {
    for (std::uint64_t bits = voxels;; bits = words_for(bits)) {
      words_.emplace_back(words_for(bits), 0);
      if (bits <= kWordBits) break;
    }
  }

  std::uint32_t levels() const { return static_cast<std::uint32_t>(words_.size()); }
  bool empty() const { return words_.back().front() == 0; }

  // Each returns how many words it has read and written: one of each level that changes.
  std::uint32_t set(std::uint32_t voxel) {
    std::uint32_t written = 0, at = voxel;
    for (auto& level : words_) {
      std::uint32_t& word = level[at / kWordBits];
      const bool was_empty = word == 0;
      word |= 1U << at % kWordBits;
      ++written;
      if (!was_empty) break;
      at /= kWordBits;
    }
    return written;
  }
  std::uint32_t clear(std::uint32_t voxel) {
    std::uint32_t written = 0, at = voxel;
    for (auto& level : words_) {
      std::uint32_t& word = level[at / kWordBits];
      word &= ~(1U << at % kWordBits);
      ++written;
      if (word != 0) break;
      at /= kWordBits;
    }
    return written;
  }

  // The lowest; not where there is none.
  std::uint32_t first() const {
    std::uint32_t at = 0;
    for (std::size_t level = words_.size(); level-- > 0;) {
      at = at * kWordBits + static_cast<std::uint32_t>(__builtin_ctz(words_[level][at]));
    }
    return at;
  }

 private:
  static std::uint64_t words_for(std::uint64_t bits) { return (bits + kWordBits - 1) / kWordBits; }

  std::vector<std::vector<std::uint32_t>> words_;  // [level], the bits first
};

// Memory that one group's table takes, by count of renamed voxels and of distinct edges: per voxel
// its global id (4 B), in-degree (2 B) and list head or number of lines (2 B); per edge the
// successor and the next link (4 B).
constexpr std::uint32_t kOrderingBytesPerVoxel = 8;
constexpr std::uint32_t kOrderingBytesPerEdge = 4;

// Lines of the adjacency table that one voxel may take, where edges stand in such lines: a bound on
// what is kept of them.
constexpr std::uint32_t kMostAdjacencyLines = 8;

// Accesses to the table so far, each to a voxel's record or to an edge.
struct OrderingAccesses {
  std::uint64_t met = 0;                            // voxels
  std::uint64_t reads = 0, writes = 0;              // accesses to the table
  std::uint64_t heads_read = 0;                     // reads among these that look for edges
  std::uint64_t names_read = 0, names_written = 0;  // accesses to the renaming
  std::uint64_t ready_read = 0, ready_written = 0;  // accesses to the words of ready voxels
};

class OrderingTable {
  static constexpr std::uint32_t kNone = ~0U;

 public:
  static constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

  // voxel_count: how many voxels exist; ids below it may appear in chains. capacity_bytes:
  // memory that is there for one group, at least that of a voxel. line_destinations: 0 where edges
  // are linked words of the table; else they stand beside it, in lines of an adjacency table, each
  // of one source and of so many destinations.
  explicit OrderingTable(std::size_t voxel_count, std::uint64_t capacity_bytes = kUnlimited,
                         std::uint32_t line_destinations = 0);

  // Voxels for which a table of so many bytes has room.
  static std::uint64_t most_voxels(std::uint64_t capacity_bytes) {
    return capacity_bytes / kOrderingBytesPerVoxel;
  }

  // Forgets the group before.
  void clear();

  // The place of a ray: the number of the voxel that it met last, if any.
  class Chain {
   public:
    bool begun() const { return before != kNone; }
    std::uint32_t number() const { return before; }  // only where it has begun

   private:
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
    const std::uint64_t edges = line_destinations_ > 0 ? 0 : edge_count();
    return std::uint64_t{voxel_count()} * kOrderingBytesPerVoxel + edges * kOrderingBytesPerEdge;
  }
  const OrderingAccesses& accesses() const { return accesses_; }
  // The words written for the voxel added last. Words of the table have 8 B and hold a voxel's
  // record or two edges, each kind by its number. The count is of words of ready voxels.
  const std::vector<std::uint32_t>& written() const { return written_; }
  std::uint64_t ready_written() const { return ready_written_; }
  // Visits a voxel's edges, by its number, in the order of its list: visit(word of the edge,
  // successor).
  template <class Visit>
  void for_each_edge(std::uint32_t number, const Visit& visit) const {
    for (std::uint32_t at = voxels_[number].first_edge; at != kNone; at = edges_[at].next) {
      visit(word_of_edge(at), edges_[at].successor);
    }
  }
  // A voxel's edges in lines, by its number: how many, and the numbers of the voxels that they lead
  // to, in the order in which these were added.
  std::uint32_t out_degree(std::uint32_t number) const { return voxels_[number].out_degree; }
  std::vector<std::uint32_t> destinations(std::uint32_t number) const;
  // Whether the voxel added last came with an edge that was not there.
  bool added_edge() const { return added_edge_; }
  // Levels of words that finding the first of the ready voxels passes.
  std::uint32_t ready_levels() const { return ready_.levels(); }

 private:
  struct Voxel {
    std::uint32_t id, in_degree, first_edge, out_degree;
  };
  struct Edge {
    std::uint32_t successor, next;
  };

  std::uint32_t rename(std::uint32_t voxel, bool first);  // first: of its ray
  void add_edge(std::uint32_t from, std::uint32_t to, bool is_new);
  bool fits() const { return bytes() <= capacity_bytes_ && !full_lines_; }

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
  const std::uint32_t line_destinations_;
  bool full_lines_ = false;             // a voxel has more edges than its lines
  bool added_edge_ = false;             // of the voxel added last
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
