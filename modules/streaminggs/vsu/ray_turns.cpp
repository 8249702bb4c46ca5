// Turns at what the rays share.
#include "modules/streaminggs/vsu/ray_turns.h"

#include <algorithm>
#include <utility>

#include "algorithm/order/ready_voxels.h"
#include "algorithm/order/renaming.h"
#include "modules/datapath/work_rates.h"
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

RayTurns::RayTurns(const PaperVsuConfig& c, const OperationLatencies& latencies)
    : config(c),
      begins_(pixel_ray_pipeline(c, latencies)),
      steps_(ray_step_pipeline(c, latencies)) {}

void RayTurns::free_from(std::uint64_t cycle) {
  pass_from_ = begins_free_ = steps_free_ = look_ups_free_ = tree_free_ = table_free_ = written_ =
      cycle;
}

void RayTurns::hold_look_ups(std::uint64_t cycle) {
  look_ups_free_ = std::max(look_ups_free_, cycle);
}

// Of lanes, the same in their turns. No ray is under way when a pass begins, so that they count
// from there.
std::uint64_t RayTurns::turn_of(const Datapath& lanes, std::uint64_t& free, std::uint64_t cycle) {
  const std::uint64_t interval = lanes.interval_cycles();
  const std::uint64_t of_pass = next_turn(std::max(free, cycle) - pass_from_, interval);
  return turn(free, pass_from_ + of_pass, interval);
}

std::uint64_t RayTurns::begin_ray(std::uint64_t cycle) {
  ++work_.rays;
  return turn_of(begins_, begins_free_, cycle) + config.ray_depth_cycles;
}

std::uint64_t RayTurns::step(std::uint64_t cycle, std::uint32_t log2_block) {
  ++work_.steps;
  return turn_of(steps_, steps_free_, cycle) + config.step_cycles(log2_block) + kMaskCycles;
}

std::uint64_t RayTurns::look_up(std::uint64_t cycle) { return turn(look_ups_free_, cycle, 1); }

std::uint64_t RayTurns::cycles_since(const OrderingAccesses& all) {
  return all.cycles - std::exchange(work_.accesses, all).cycles;
}

std::uint64_t RayTurns::found(std::uint64_t cycle) {
  ++work_.found;
  return std::max(tree_free_, cycle) + first_of_rounds_cycles(config.rays_in_flight);
}

std::uint64_t RayTurns::give_context(std::uint64_t cycle) { return tree_free_ = found(cycle); }

std::uint64_t RayTurns::enter(const OrderingTable& table, std::uint64_t cycle) {
  ++work_.entered;
  tree_free_ = turn(table_free_, found(cycle), cycles_since(table.accesses()));
  table_free_ = std::max(table_free_, written_);
  written_ = table_free_ + table.write_cycles();
  return table_free_;
}

std::uint64_t RayTurns::order_cycles(const OrderingTable& table) {
  const std::uint64_t clearing = names_bytes(config) / kNamesWord;
  work_.names_cleared += clearing;
  return std::max(cycles_since(table.accesses()), clearing);
}

std::uint64_t RayTurns::clear_cycles(const OrderingTable& table) {
  cycles_since(table.accesses());
  const std::uint64_t names = names_bytes(config) / kNamesWord, ready = ready_words(config);
  work_.names_cleared += names;
  work_.ready_cleared += ready;
  return std::max(names, ready);
}

}  // namespace sgs
