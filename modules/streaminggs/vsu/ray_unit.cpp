// Turns of the resources that rays share, and nodes of the tree in the kernel's time.
#include "modules/streaminggs/vsu/ray_unit.h"

#include <algorithm>
#include <utility>

#include "algorithm/order/ordering_table.h"
#include "modules/datapath/work_rates.h"
#include "modules/streaminggs/vsu/ordering_cycles.h"
#include "modules/streaminggs/vsu/vsu_datapaths.h"

namespace sgs {
namespace {

// The first of two things that share something gets it first.
std::uint64_t turn(std::uint64_t& free, std::uint64_t cycle, std::uint64_t cycles) {
  const std::uint64_t start = std::max(free, cycle);
  free = start + cycles;
  return start;
}

}  // namespace

std::uint64_t names_bytes(const PaperVsuConfig& config) {
  return kNameBytes * Renaming::slots_for(OrderingTable::most_voxels(config.table_bytes));
}

std::uint64_t ready_words(const PaperVsuConfig& config) {
  return ReadyVoxels::all_words_for(OrderingTable::most_voxels(config.table_bytes));
}

RayUnit::RayUnit(const PaperVsuConfig& c, const OperationLatencies& latencies,
                 const ClockDomain& clock, Activity& activity, MemoryPort& port,
                 const RecordArray& table, ListsOut to)
    : config(c),
      nodes(c.node_cache_bytes, table),
      lists(std::move(to)),
      clock_(clock),
      activity_(activity),
      port_(port),
      begins_(pixel_ray_pipeline(c, latencies)),
      steps_(ray_step_pipeline(c, latencies)) {}

void RayUnit::advance_to(std::uint64_t cycle) {
  if (cycle > now()) clock_.wait_cycles(cycle - now());
}

void RayUnit::begin_pass() {
  activity_.works();
  pass_from_ = begins_free_ = steps_free_ = look_ups_free_ = tree_free_ = table_free_ = written_ =
      now();
}

// The first cycle from `cycle` on in which the lanes are free, in their turns. Turns count from the
// beginning of the pass, when no ray is under way.
std::uint64_t RayUnit::turn_of(const Datapath& lanes, std::uint64_t& free, std::uint64_t cycle) {
  const std::uint64_t interval = lanes.interval_cycles();
  const std::uint64_t of_pass = next_turn(std::max(free, cycle) - pass_from_, interval);
  return turn(free, pass_from_ + of_pass, interval);
}

std::uint64_t RayUnit::begin_ray(std::uint64_t cycle) {
  ++counts_.rays;
  return turn_of(begins_, begins_free_, cycle) + config.ray_depth_cycles;
}

std::uint64_t RayUnit::step(std::uint64_t cycle, std::uint32_t log2_block) {
  ++counts_.steps;
  return turn_of(steps_, steps_free_, cycle) + config.step_cycles(log2_block) + kMaskCycles;
}

std::uint64_t RayUnit::look_up(std::uint64_t cycle) { return turn(look_ups_free_, cycle, 1); }

std::uint64_t RayUnit::found(std::uint64_t cycle) {
  ++counts_.found;
  return std::max(tree_free_, cycle) + first_of_rounds_cycles(config.rays_in_flight);
}

std::uint64_t RayUnit::give_context(std::uint64_t cycle) { return tree_free_ = found(cycle); }

std::uint64_t RayUnit::enter(const OrderingTable& table, std::uint64_t cycle) {
  ++counts_.entered;
  const OrderingAccesses before = std::exchange(counts_.accesses, table.accesses());
  tree_free_ = turn(table_free_, found(cycle), meeting_cycles(before, table.accesses()));
  table_free_ = std::max(table_free_, written_);
  written_ = table_free_ + writing_cycles(table, config.table_banks);
  return table_free_;
}

void RayUnit::order(const OrderingTable& table) {
  const std::uint64_t clearing = names_bytes(config) / kNamesWord;
  counts_.names_cleared += clearing;
  counts_.accesses = table.accesses();
  activity_.work(std::max(ordering_cycles(table, config.table_banks), clearing));
}

void RayUnit::clear(const OrderingTable& table) {
  counts_.accesses = table.accesses();
  const std::uint64_t names = names_bytes(config) / kNamesWord, ready = ready_words(config);
  counts_.names_cleared += names;
  counts_.ready_cleared += ready;
  activity_.work(std::max(names, ready));
}

std::vector<NodeFetches::Waiting>& RayUnit::ask(std::uint64_t tag, std::uint64_t cycle) {
  advance_to(cycle);
  auto& waiting = fetches.ask(tag, nodes, port_, activity_);
  look_ups_free_ = std::max(look_ups_free_, now());
  return waiting;
}

void RayUnit::wait_for_nodes(std::uint64_t cycle) {
  if (cycle == kNever) {
    activity_.waits_for(WaitFor::kReads, port_);
    sc_core::wait(fetches.news());
  } else {
    sc_core::wait(static_cast<double>(cycle - now()) * clock_.period(), fetches.news());
  }
  clock_.jitter();
  activity_.works();
}

void RayUnit::take_what_comes() {
  while (!fetches.empty()) {
    while (!fetches.any_come()) wait_for_nodes(kNever);
    advance_to(fetches.ready_cycle());
    nodes.fill(fetches.take().line);
  }
}

}  // namespace sgs
