// Sums of energy and area.
#include "testbench/cost/cost.h"

#include <algorithm>
#include <cctype>

#include "modules/dram/dram_config.h"

namespace sgs {
namespace {

constexpr double kPj = 1e-12, kMw = 1e-3;
constexpr const char* kMemoryInterface = "memory_interface";

void add(CostResult& cost, const std::string& component, const Band& amount) {
  cost.total = cost.total + amount;
  for (auto& [name, sum] : cost.by_component) {
    if (name != component) continue;
    sum = sum + amount;
    return;
  }
  cost.by_component.emplace_back(component, amount);
}

// "decoded Gaussians" -> "decoded_gaussians": as components are written.
std::string component_of(std::string use) {
  for (char& c : use) {
    const auto letter = static_cast<unsigned char>(c);
    c = std::isalnum(letter) != 0 ? static_cast<char>(std::tolower(letter)) : '_';
  }
  return use;
}

CostResult logic_area(const MachineResult& machine, const Technology& technology) {
  CostResult area;
  for (const Parts& part : machine.parts) {
    add(area, part.component, part.count * technology.mm2(part.kind));
  }
  return area;
}

Band sram_area(const SramUses& uses, const Technology& technology) {
  Band sram;
  for (const SramUse& use : uses) sram = sram + technology.sram.mm2(use);
  return sram;
}

CostResult machine_area(const MachineResult& machine, const Technology& technology) {
  CostResult area = logic_area(machine, technology);
  add(area, "sram", sram_area(machine.sram_uses, technology));
  return area;
}

CostResult with_interface_if_counted(CostResult cost, const Band& interface,
                                     const Technology& technology) {
  if (technology.memory_interface.counted) add(cost, kMemoryInterface, interface);
  return cost;
}

Totals totals_of(const CostResult& machine, const Band& interface) {
  return {machine.total, machine.total + interface, interface};
}

// Area of all that leaks as logic does: parts, and memories in registers.
Band leaking_area(const MachineResult& machine, const Technology& technology) {
  Band area = logic_area(machine, technology).total;
  for (const SramUse& use : machine.sram_uses) {
    if (use.in_registers()) area = area + technology.sram.mm2(use);
  }
  return area;
}

// Register bits that stand there, of parts and of memories built of registers; and how many of them
// are clocked in all, where words are clocked only as they take something: those of a part by each
// of its operations, those of a memory by each write.
struct Clocked {
  double bits = 0, gated = 0;
};

Clocked clocked(const MachineResult& machine, const Technology& technology) {
  Clocked sum;
  for (const Parts& part : machine.parts) {
    sum.bits += part.count * technology.part(part.kind).register_bits;
  }
  for (const Operations& work : machine.operations) {
    sum.gated += work.count * technology.part(work.kind).register_bits;
  }
  for (const SramUse& use : machine.sram_uses) {
    if (!use.in_registers()) continue;
    sum.bits += 8.0 * static_cast<double>(use.total_bytes());
    for (const SramAccesses& accesses : machine.sram_accesses) {
      if (accesses.use != use.name) continue;
      sum.gated += static_cast<double>(accesses.writes) * use.shape.width_bits;
    }
  }
  return sum;
}

// With a gate before each word. High: at least what all registers take that are clocked in every
// cycle, without gates, as they take it in the middle. With more than that the clock of a published
// machine would take several times the power that it has in all.
Band clock_pj(const FrameResult& frame, const Technology& technology) {
  const Clocked of = clocked(frame.machine, technology);
  if (of.bits == 0) return {};
  const Band& bit = technology.part(kRegisterClock).pj;
  const double bit_cycles = of.bits * static_cast<double>(frame.cycles - frame.rest_cycles);
  const double ungated = bit_cycles * bit.middle;
  const Band gated = of.gated * bit + bit_cycles / kGatedBits * technology.part(kClockGate).pj;
  return {gated.low, gated.middle, std::max(gated.high, ungated)};
}

SramUse write_queues(const FrameResult& frame, const Technology& technology) {
  constexpr std::uint32_t kBurstBits = 256;
  const std::uint64_t bytes = technology.memory_interface.write_queue_bytes *
                              frame.memory.write_queue_entries / DramConfig().write_queue_entries;
  SramUse queue =
      sram_use("waiting writes", "controller", {{bytes, "B"}}, {kBurstBits}, kOneOfEach);
  queue.count = frame.memory.channels;
  return queue;
}

// Channels of the table's memory that have the peak bandwidth of the frame's.
double priced_channels(const FrameResult& frame, const Technology& technology) {
  return frame.memory.peak_gb_s / technology.memory_interface.gb_s;
}

Band memory_interface_area(const FrameResult& frame, const Technology& technology) {
  return priced_channels(frame, technology) * technology.memory_interface.mm2 +
         technology.sram.mm2(write_queues(frame, technology));
}

Band sram_leakage_mw(const MachineResult& machine, const Technology& technology) {
  Band leakage;
  for (const SramUse& use : machine.sram_uses) leakage = leakage + technology.sram.leakage_mw(use);
  return leakage;
}

// Leakage lasts as long as power is on.
void add_leakage(CostResult& energy, const MachineResult& machine, double seconds,
                 const Technology& technology) {
  add(energy, "logic_leakage",
      kMw * seconds * (technology.die.logic_leakage_mw_mm2 * leaking_area(machine, technology)));
  add(energy, "sram_leakage", kMw * seconds * sram_leakage_mw(machine, technology));
}

// Power of PHY and controller that stand for a share of the time. High: they never stand.
Band interface_w(const FrameResult& frame, double stands, const Technology& technology) {
  const MemoryInterfaceCost& interface = technology.memory_interface;
  Band channel_mw =
      (1 - stands) * interface.mw + stands * (interface.mm2 * technology.die.logic_leakage_mw_mm2);
  channel_mw.high = std::max(channel_mw.high, interface.mw.high);
  return kMw * (priced_channels(frame, technology) * channel_mw +
                technology.sram.leakage_mw(write_queues(frame, technology)));
}

// Each burst of a write is put in and taken out.
Band write_queue_energy_j(const FrameResult& frame, const SramUse& queue, const SramModel& model) {
  std::uint64_t bytes = 0;
  for (const RegionTraffic& traffic : frame.memory.traffic) bytes += traffic.written_bytes;
  const auto bursts = static_cast<double>(sram_words(bytes, queue.shape));
  return bursts * kPj * (model.read_pj(queue) + model.write_pj(queue));
}

bool has_display(const FrameResult& frame) {
  return std::any_of(frame.memory.traffic.begin(), frame.memory.traffic.end(),
                     [](const RegionTraffic& of) { return of.requester == "display"; });
}

// A display wakes the memory for each row. PHY starts anew within a row's time at the low end
// alone.
Band memory_interface_j(const FrameResult& frame, const Technology& technology) {
  const double stands = frame.memory.time_in_s(kSelfRefreshState) / frame.time_s();
  Band watts = interface_w(frame, stands, technology);
  if (has_display(frame)) watts.middle = interface_w(frame, 0, technology).middle;
  return frame.time_s() * watts +
         write_queue_energy_j(frame, write_queues(frame, technology), technology.sram);
}

// Of machine and memory.
CostResult frame_energy(const FrameResult& frame, const Technology& technology) {
  const MachineResult& machine = frame.machine;
  CostResult energy;
  for (const Operations& work : machine.operations) {
    add(energy, work.component, work.count * kPj * technology.part(work.kind).pj);
  }
  for (const SramUse& use : machine.sram_uses)
    add(energy, component_of(use.name), access_energy_j(machine, use, technology.sram));
  add(energy, "clock", kPj * clock_pj(frame, technology));
  add_leakage(energy, machine, frame.time_s(), technology);
  if (const MemoryResult& dram = frame.memory; dram.energy_not_stated.empty())
    add(energy, "dram", {dram.energy_least_j, dram.energy_j, dram.energy_most_j});
  return energy;
}

CostResult rest_energy(const FrameResult& frame, const Rest& rest, double seconds,
                       const Technology& technology) {
  CostResult energy;
  add_leakage(energy, frame.machine, seconds, technology);
  if (const DramEnergyBand& dram = rest.energy; dram.not_stated.empty())
    add(energy, "dram", kPj * Band{dram.least_pj, dram.total_pj(), dram.most_pj});
  return energy;
}

}  // namespace

CostResult area_of(const FrameResult& frame, const Technology& technology) {
  return with_interface_if_counted(machine_area(frame.machine, technology),
                                   memory_interface_area(frame, technology), technology);
}

Totals area_totals(const FrameResult& frame, const Technology& technology) {
  return totals_of(machine_area(frame.machine, technology),
                   memory_interface_area(frame, technology));
}

CostResult area_by_owner(const FrameResult& frame, const Technology& technology) {
  CostResult area;
  for (const OwnerResult& owner : frame.machine.owners) {
    for (const Parts& part : owner.parts) {
      add(area, owner.owner, part.count * technology.mm2(part.kind));
    }
    add(area, owner.owner, sram_area(owner.sram_uses, technology));
  }
  add(area, kMemoryInterface, memory_interface_area(frame, technology));
  return area;
}

Band access_energy_j(const MachineResult& machine, const SramUse& use, const SramModel& model) {
  for (const SramAccesses& accesses : machine.sram_accesses) {
    if (accesses.use != use.name) continue;
    return kPj * (static_cast<double>(accesses.reads) * model.read_pj(use) +
                  static_cast<double>(accesses.writes) * model.write_pj(use));
  }
  return {};
}

CostResult energy_of(const FrameResult& frame, const Technology& technology) {
  return with_interface_if_counted(frame_energy(frame, technology),
                                   memory_interface_j(frame, technology), technology);
}

Totals energy_totals(const FrameResult& frame, const Technology& technology) {
  return totals_of(frame_energy(frame, technology), memory_interface_j(frame, technology));
}

CostResult energy_between(const FrameResult& from, const FrameResult& until,
                          const Technology& technology) {
  CostResult energy = energy_of(until, technology);
  for (const auto& [component, joules] : energy_of(from, technology).by_component) {
    add(energy, component, -1 * joules);
  }
  return energy;
}

Band resting_interface_w(const FrameResult& frame, const Rest& rest, const Technology& technology) {
  return interface_w(frame, rest.self_refresh(), technology);
}

CostResult rest_energy_of(const FrameResult& frame, const Rest& rest, double seconds,
                          const Technology& technology) {
  return with_interface_if_counted(rest_energy(frame, rest, seconds, technology),
                                   seconds * resting_interface_w(frame, rest, technology),
                                   technology);
}

Totals rest_energy_totals(const FrameResult& frame, const Rest& rest, double seconds,
                          const Technology& technology) {
  return totals_of(rest_energy(frame, rest, seconds, technology),
                   seconds * resting_interface_w(frame, rest, technology));
}

}  // namespace sgs
