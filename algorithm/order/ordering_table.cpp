// Renaming, edges and Kahn's algorithm.
#include "algorithm/order/ordering_table.h"

#include <algorithm>
#include <stdexcept>

namespace sgs {
namespace {

// A table for more voxels than exist has no use for the rest.
std::uint64_t most_held(std::size_t voxel_count, std::uint64_t capacity_bytes) {
  return std::max<std::uint64_t>(
      1, std::min<std::uint64_t>(voxel_count, OrderingTable::most_voxels(capacity_bytes)));
}

}  // namespace

OrderingTable::OrderingTable(std::size_t voxel_count, std::uint64_t capacity_bytes,
                             std::uint32_t line_destinations)
    : capacity_bytes_(capacity_bytes),
      line_destinations_(line_destinations),
      names_(most_held(voxel_count, capacity_bytes)),
      ready_(most_held(voxel_count, capacity_bytes)) {}

void OrderingTable::clear() {
  names_.clear();
  for (std::uint32_t id = 0; id < voxels_.size(); ++id) {
    if (voxels_[id].in_degree == 0) ready_.clear(id);
  }
  voxels_.clear();
  edges_.clear();
  edges_offered_ = 0;
  full_lines_ = false;
}

std::uint32_t OrderingTable::rename(std::uint32_t voxel, bool first) {
  std::uint64_t slots = 0;
  const auto is_of = [&](std::uint32_t number) {
    ++accesses_.reads;
    return voxels_[number].id == voxel;
  };
  const std::uint32_t slot = names_.find(voxel, is_of, slots);
  accesses_.names_read += slots;
  if (names_.taken(slot)) return names_.number(slot);
  const std::uint32_t number = voxel_count();
  voxels_.push_back({voxel, 0, kNone, 0});
  if (!fits()) {
    voxels_.back().in_degree = kNone;  // never ready: there is no bit for it
    return kNone;
  }
  names_.take(slot, number);
  ++accesses_.names_written;
  write(number);
  if (first) count_ready(ready_.set(number));
  return number;
}

// The head of the list stands in the voxel's record; who is new goes in front. A voxel that comes
// with its first edge was never ready, and its in-degree is written with the rest of its record.
void OrderingTable::add_edge(std::uint32_t from, std::uint32_t to, bool is_new) {
  const bool linked = line_destinations_ == 0;  // else a line holds them, and no record its head
  accesses_.reads += linked ? 1 : 0;
  accesses_.heads_read += linked ? 1 : 0;
  for (std::uint32_t at = voxels_[from].first_edge; at != kNone; at = edges_[at].next) {
    accesses_.reads += linked ? 1 : 0;
    if (edges_[at].successor == to) return;
  }
  edges_.push_back({to, voxels_[from].first_edge});
  voxels_[from].first_edge = edge_count() - 1;
  added_edge_ = true;
  const std::uint32_t before = voxels_[from].out_degree++;
  full_lines_ = !linked && voxels_[from].out_degree > kMostAdjacencyLines * line_destinations_;
  if (linked) write(word_of_edge(edge_count() - 1));
  // The list's head, or how many lines it has: known when the next edge from it is met.
  if (linked || before % line_destinations_ == 0) write(from);
  if (!is_new) write(to);  // the in-degree
  if (voxels_[to].in_degree++ == 0 && !is_new) count_ready(ready_.clear(to));
}

bool OrderingTable::add(Chain& chain, std::uint32_t voxel) {
  ++accesses_.met;
  const std::uint32_t voxels = voxel_count();
  written_.clear();
  ready_written_ = 0;
  added_edge_ = false;
  const bool first = chain.before == kNone;
  if (!first) ++edges_offered_;
  const std::uint32_t number = rename(voxel, first);
  if (number != kNone && !first) add_edge(chain.before, number, number == voxels);
  chain.before = number;
  return number != kNone && fits();
}

std::vector<std::uint32_t> OrderingTable::destinations(std::uint32_t number) const {
  std::vector<std::uint32_t> out;
  for_each_edge(number, [&](std::uint32_t, std::uint32_t to) { out.push_back(to); });
  std::reverse(out.begin(), out.end());  // who is new stands in front
  return out;
}

std::vector<std::uint32_t> OrderingTable::order() {
  std::vector<std::uint32_t> order;
  order.reserve(voxels_.size());
  while (!ready_.empty()) {
    const std::uint32_t number = ready_.first();
    accesses_.ready_read += ready_.levels();
    accesses_.ready_written += ready_.clear(number);
    ++accesses_.reads;
    order.push_back(voxels_[number].id);
    voxels_[number].in_degree = kNone;  // taken
    for (std::uint32_t at = voxels_[number].first_edge; at != kNone; at = edges_[at].next) {
      Voxel& next = voxels_[edges_[at].successor];
      accesses_.reads += line_destinations_ > 0 ? 1 : 2;
      ++accesses_.writes;
      if (--next.in_degree > 0) continue;
      count_ready(ready_.set(edges_[at].successor));
    }
  }
  if (order.size() != voxels_.size()) {
    throw std::logic_error("ordering table: the rays of a group contradict each other");
  }
  return order;
}

}  // namespace sgs
