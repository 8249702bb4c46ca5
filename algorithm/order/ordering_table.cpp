// Renaming, edges and Kahn's algorithm.
#include "algorithm/order/ordering_table.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <stdexcept>

namespace sgs {

OrderingTable::OrderingTable(std::size_t voxel_count, std::uint64_t capacity_bytes)
    : local_of_(voxel_count, -1), capacity_bytes_(capacity_bytes) {}

void OrderingTable::clear() {
  for (const std::uint32_t voxel : voxels_) local_of_[voxel] = -1;
  for (std::size_t i = 0; i < voxels_.size(); ++i) successors_[i].clear();
  voxels_.clear();
  last_chain_.clear();
  edge_count_ = 0;
  edges_offered_ = 0;
}

std::uint32_t OrderingTable::rename(std::uint32_t voxel) {
  std::int32_t& local = local_of_[voxel];
  if (local < 0) {
    local = static_cast<std::int32_t>(voxels_.size());
    voxels_.push_back(voxel);
    if (successors_.size() < voxels_.size()) successors_.emplace_back();
  }
  return static_cast<std::uint32_t>(local);
}

bool OrderingTable::add_chain(const std::vector<std::uint32_t>& voxels) {
  if (!voxels.empty()) edges_offered_ += voxels.size() - 1;
  if (voxels == last_chain_) return true;  // neighbouring rays mostly agree: nothing new
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const std::uint32_t id = rename(voxels[i]);
    if (i > 0) {
      auto& known = successors_[before];
      if (std::find(known.begin(), known.end(), id) == known.end()) {
        known.push_back(id);
        ++edge_count_;
      }
    }
    if (!fits()) return false;
    before = id;
  }
  last_chain_ = voxels;
  return true;
}

std::vector<std::uint32_t> OrderingTable::order() const {
  std::vector<std::uint32_t> in_degree(voxels_.size(), 0);
  for (std::size_t i = 0; i < voxels_.size(); ++i) {
    for (const std::uint32_t next : successors_[i]) ++in_degree[next];
  }
  std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> ready;
  for (std::uint32_t id = 0; id < voxels_.size(); ++id) {
    if (in_degree[id] == 0) ready.push(id);
  }
  std::vector<std::uint32_t> order;
  order.reserve(voxels_.size());
  while (!ready.empty()) {
    const std::uint32_t id = ready.top();
    ready.pop();
    order.push_back(voxels_[id]);
    for (const std::uint32_t next : successors_[id]) {
      if (--in_degree[next] == 0) ready.push(next);
    }
  }
  if (order.size() != voxels_.size()) {
    throw std::logic_error("ordering table: the rays of a group contradict each other");
  }
  return order;
}

}  // namespace sgs
