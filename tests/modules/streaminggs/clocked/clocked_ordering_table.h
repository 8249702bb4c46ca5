// The ordering table register by register: what is read names what is read next, a cycle each; what
// was found is written beside the next reads, a word of each bank a cycle, and bits of ready voxels
// a word a cycle. Reads see what is still to be written.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "algorithm/order/ordering_table.h"

namespace sgs::test {

class ClockedOrderingTable {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  using Chain = std::uint32_t;  // number of the voxel that a ray met last

  ClockedOrderingTable(std::size_t voxels, std::uint64_t bytes, std::uint32_t banks)
      : bytes_(bytes),
        held_(std::max<std::uint64_t>(1, std::min<std::uint64_t>(voxels, bytes / kVoxelBytes))),
        writes_(banks, 0) {
    clear();
  }

  std::uint64_t free_tags() { return 0; }  // its edges are words without
  void clear() {
    slots_.assign(Renaming::slots_for(held_), kNone);
    voxels_.clear();
    edges_.clear();
    ready_ = ReadyVoxels(held_);
    std::fill(writes_.begin(), writes_.end(), 0);
    ready_words_ = 0;
    fits_ = true;
  }
  bool fits() const { return fits_; }
  void begin_cycle() {}  // it has no port

  // The first read is of this cycle. from: the voxel that the ray met before.
  void begin_add(Chain from, std::uint32_t voxel) {
    from_ = from;
    voxel_ = voxel;
    number_ = kNone;
    slot_ = hash(voxel);
    doing_ = Doing::kSlot;
  }
  // Of the voxel that was added last.
  Chain number() const { return number_; }
  // Kahn's algorithm, from this cycle on; the voxels are in the order of their reading then.
  void begin_order() {
    order_.clear();
    next_ready();
  }
  const std::vector<std::uint32_t>& ordered() const { return order_; }
  bool idle() const { return doing_ == Doing::kNothing; }

  // A cycle of what has begun; what is read comes at its end.
  void step() {
    for (std::uint32_t& left : writes_) left -= left > 0 ? 1 : 0;
    ready_words_ -= ready_words_ > 0 ? 1 : 0;
    switch (doing_) {
      case Doing::kNothing:
      case Doing::kWritten:
        break;
      case Doing::kSlot:
      case Doing::kRecord:
        rename();
        break;
      case Doing::kEdge:
        compare_edge();
        break;
      case Doing::kReady:
        find_ready();
        break;
      case Doing::kSuccessors:
        count_down();
        break;
    }
    if (doing_ == Doing::kWritten) commit();
  }

 private:
  enum class Doing { kNothing, kSlot, kRecord, kEdge, kWritten, kReady, kSuccessors };
  static constexpr std::uint64_t kVoxelBytes = 8, kEdgeBytes = 4;
  struct Voxel {
    std::uint32_t id, in_degree, first_edge;
  };
  struct Edge {
    std::uint32_t successor, next;
  };

  std::uint32_t hash(std::uint32_t voxel) const {
    voxel ^= voxel << 13U;
    voxel ^= voxel >> 17U;
    voxel ^= voxel << 5U;
    return static_cast<std::uint32_t>(voxel & (slots_.size() - 1));
  }
  bool has_room() const {
    return voxels_.size() * kVoxelBytes + edges_.size() * kEdgeBytes <= bytes_;
  }
  std::size_t bank(std::size_t word) const { return word % writes_.size(); }

  // A slot has come, or beside the next slot the record that one names.
  void rename() {
    const bool mine = doing_ == Doing::kRecord && voxels_[slots_[slot_]].id == voxel_;
    if (doing_ == Doing::kRecord && !mine)
      slot_ = static_cast<std::uint32_t>((slot_ + 1) & (slots_.size() - 1));
    if (mine) {
      number_ = slots_[slot_];
    } else if (slots_[slot_] != kNone) {
      doing_ = Doing::kRecord;
      return;
    } else {
      number_ = static_cast<std::uint32_t>(voxels_.size());
      voxels_.push_back({voxel_, 0, kNone});
      is_new_ = true;
      if (!has_room()) {
        doing_ = Doing::kWritten;
        return;
      }
    }
    edge_ = from_ == kNone ? kNone : voxels_[from_].first_edge;
    doing_ = edge_ == kNone ? Doing::kWritten : Doing::kEdge;
    new_edge_ = from_ != kNone;
  }
  void compare_edge() {
    if (edges_[edge_].successor == number_) {
      new_edge_ = false;
      doing_ = Doing::kWritten;
    } else {
      edge_ = edges_[edge_].next;
      if (edge_ == kNone) doing_ = Doing::kWritten;
    }
  }
  // What was found is to be written, when what was found before has been.
  void commit() {
    if (ready_words_ > 0) return;
    for (const std::uint32_t left : writes_) {
      if (left > 0) return;
    }
    doing_ = Doing::kNothing;
    fits_ = has_room();
    if (is_new_ && fits_) {
      slots_[slot_] = number_;
      ++writes_[bank(number_)];
      if (!new_edge_) ready_words_ += ready_.set(number_);
    }
    if (new_edge_ && fits_) {
      edges_.push_back({number_, voxels_[from_].first_edge});
      voxels_[from_].first_edge = static_cast<std::uint32_t>(edges_.size() - 1);
      ++writes_[bank((edges_.size() - 1) / 2)];
      ++writes_[bank(from_)];
      if (!is_new_) ++writes_[bank(number_)];
      if (voxels_[number_].in_degree++ == 0 && !is_new_) ready_words_ += ready_.clear(number_);
      fits_ = has_room();
    }
    is_new_ = new_edge_ = false;
  }

  void next_ready() {
    left_ = ready_.levels() + 1;
    doing_ = ready_.empty() ? Doing::kNothing : Doing::kReady;
  }
  // A word of each level, then the record of the voxel.
  void find_ready() {
    if (--left_ > 0) return;
    number_ = ready_.first();
    ready_.clear(number_);
    order_.push_back(voxels_[number_].id);
    edge_ = voxels_[number_].first_edge;
    named_ = kNone;
    doing_ = Doing::kSuccessors;
    if (edge_ == kNone) next_ready();
  }
  // The record that the edge before names and, from another bank, the next edge.
  void count_down() {
    const bool conflict = named_ != kNone && edge_ != kNone && bank(named_) == bank(edge_ / 2);
    if (named_ != kNone && --voxels_[named_].in_degree == 0) ready_.set(named_);
    named_ = kNone;
    if (edge_ != kNone && !conflict) {
      named_ = edges_[edge_].successor;
      edge_ = edges_[edge_].next;
    }
    if (named_ == kNone && edge_ == kNone) next_ready();
  }

  const std::uint64_t bytes_, held_;
  std::vector<std::uint32_t> slots_;
  std::vector<Voxel> voxels_;
  std::vector<Edge> edges_;
  ReadyVoxels ready_{1};
  std::vector<std::uint32_t> writes_;  // [bank] words that wait
  std::uint32_t ready_words_ = 0;      // likewise
  bool fits_ = true;
  Doing doing_ = Doing::kNothing;
  Chain from_ = kNone;
  std::uint32_t voxel_ = 0, number_ = 0, slot_ = 0, edge_ = kNone;
  std::uint32_t left_ = 0, named_ = kNone;  // reads until a ready one is found; by an edge
  std::vector<std::uint32_t> order_;
  bool is_new_ = false, new_edge_ = false;
};

}  // namespace sgs::test
