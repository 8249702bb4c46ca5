// Nodes of the tree as an estimate knows them.
#include "modules/streaminggs/vsu/ray_unit_estimate.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace sgs {

std::vector<NodeFetchTimes::Waiting>* NodeFetchTimes::waiting_for(std::uint64_t tag) {
  for (Fetch& fetch : fetches_) {
    if (fetch.line.tag == tag) return &fetch.waiting;
  }
  return nullptr;
}

void NodeFetchTimes::answered(std::uint64_t cycle) {
  ready_from_ = std::max(cycle, ready_from_) + 1;
  ready_.push_back(ready_from_);
}

NodeFetchTimes::Fetch NodeFetchTimes::take() {
  Fetch fetch = std::move(fetches_.front());
  fetches_.pop_front();
  ready_.pop_front();
  return fetch;
}

RayUnitEstimate::RayUnitEstimate(const PaperVsuConfig& c, const OperationLatencies& latencies,
                                 const RecordArray& table, const std::vector<VoxelNode>& tree,
                                 const PortEstimate& port, ListsOut to)
    : RayTurns(c, latencies),
      nodes(c.node_cache_bytes, table),
      lists(std::move(to)),
      tree_(tree),
      port_(port) {}

std::vector<NodeFetches::Waiting>& RayUnitEstimate::ask(std::uint64_t tag, std::uint64_t cycle) {
  advance_to(cycle);
  NodeFetches::Fetch& fetch = fetches.ask();
  const auto missing = nodes.miss(tag);
  const RecordArray& table = nodes.table();
  fetch.line.tag = tag;
  std::memcpy(fetch.line.bytes + missing.at,
              &tree_[(missing.address - table.base) / sizeof(VoxelNode)], missing.bytes);
  const PortEstimate::Access access =
      port_.read(now_, missing.address, missing.bytes, table.region);
  fetches.answered(access.answered);
  go_on(access.sent);
  hold_look_ups(now_);
  return fetch.waiting;
}

void RayUnitEstimate::wait_for_nodes(std::uint64_t cycle) {
  if (cycle == kNever) {
    go_on(fetches.comes());
  } else {
    advance_to(std::min(cycle, fetches.comes()));
  }
}

void RayUnitEstimate::take_what_comes() {
  while (!fetches.empty()) {
    if (!fetches.any_come()) wait_for_nodes(kNever);
    advance_to(fetches.ready_cycle());
    nodes.fill(fetches.take().line);
  }
}

}  // namespace sgs
