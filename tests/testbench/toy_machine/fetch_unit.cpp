// The two threads of the fetch unit.
#include "tests/testbench/toy_machine/fetch_unit.h"

#include "algorithm/memory/records.h"

namespace sgs::toy {

FetchUnit::FetchUnit(const sc_core::sc_module_name& name, const ToyConfig& config,
                     const ClockDomain& clock, const FrameJob& job)
    : sc_module(name),
      memory("memory", config.memory_port, clock.period()),
      config_(config),
      job_(job),
      ask_("ask", clock),
      add_("add", clock),
      buffer_(std::size_t{config.fetch.buffer_blocks} * config.fetch.block_gaussians *
              kFirstHalfBytes),
      fetched_("fetched", clock, config.fetch.buffer_blocks),
      free_slots_("free_slots", clock, config.fetch.buffer_blocks, 0) {
  SC_THREAD(run_ask);
  SC_THREAD(run_add);
}

std::byte* FetchUnit::slot(std::uint32_t number) {
  return buffer_.data() + std::size_t{number} * config_.fetch.block_gaussians * kFirstHalfBytes;
}

void FetchUnit::run_ask() {
  for (std::uint32_t s = 0; s < config_.fetch.buffer_blocks; ++s) free_slots_.push(s, ask_);
  const auto groups = static_cast<std::uint32_t>(groups_of(job_, config_).size());
  for (std::uint32_t group = 0; group < groups; ++group) {
    Fetched next;
    next.group = group;
    next.block = block_of(group, job_, config_);
    next.slot = free_slots_.pop(ask_, WaitFor::kRoom);
    ask_.work(1);
    next.ticket = start_read(memory, ask_, job_.layout.first_halves.address(next.block.first),
                             slot(next.slot), next.block.count * kFirstHalfBytes,
                             job_.layout.first_halves.region);
    counters_.gaussians += next.block.count;
    fetched_.push(next, ask_);
  }
  ask_.idles();
}

void FetchUnit::run_add() {
  while (true) {
    const Fetched block = fetched_.pop(add_);
    current_group_ = block.group;
    await(memory, add_, block.ticket);
    add_.work(block.block.count);
    const glm::vec3 colour = colour_of(slot(block.slot), block.block.count);
    free_slots_.push(block.slot, add_);
    colours->push({block.group, colour}, add_);
  }
}

SramUses FetchUnit::sram_uses(const ToyConfig& config) {
  return {sram_use("blocks", kScratch,
                   {{config.fetch.buffer_blocks, "blocks"},
                    {config.fetch.block_gaussians, "Gaussians"},
                    {kFirstHalfBytes, "B"}},
                   {8 * kFirstHalfBytes}, kOneOfEach),
          fifo_use<Fetched>("fetched", kScratch, config.fetch.buffer_blocks, "blocks"),
          outstanding_table(kScratch, config.memory_port)};
}

void FetchUnit::publish(DataSheet& sheet) {
  sheet.unit(*this);
  sheet.activity(ask_, "fetching", "asks for blocks of first halves");
  sheet.activity(add_, "adding", "adds their centres up");
  sheet.counters(counters_);
  Datapath adder;
  adder.name = adder.component = "adder";
  adder.lane = "fp32_lane";
  adder.lanes = adder.used_macs = 3;
  sheet.datapath(adder, counters_.gaussians);
  sheet.accesses("blocks", counters_.gaussians, counters_.gaussians);
  sheet.port(memory);
  sheet.sram(sram_uses(config_));
  sheet.queue(fetched_, "fetched");
  sheet.signal("group", current_group_);
}

}  // namespace sgs::toy
