// Lines and faults.
#include "testbench/result/ledger.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace sgs {
namespace {

void add_ports(const MachineResult& machine, std::vector<LedgerLine>& lines) {
  for (const SramUse& use : machine.sram_uses) {
    const auto at = std::find_if(machine.sram_accesses.begin(), machine.sram_accesses.end(),
                                 [&](const SramAccesses& a) { return a.use == use.name; });
    if (at == machine.sram_accesses.end()) continue;
    const auto reads = static_cast<double>(at->reads), writes = static_cast<double>(at->writes);
    const double banks = static_cast<double>(use.count) * use.shape.banks;
    if (use.shape.ports == SramPorts::kOne) {
      lines.push_back({use.name + ": accesses", reads + writes, banks});
    } else {
      lines.push_back({use.name + ": reads", reads, banks});
      lines.push_back({use.name + ": writes", writes, banks});
    }
  }
}

// Adds, for each datapath, the unit with the most to do: a busy one does not hide behind another
// that has lanes of the same kind.
void add_datapaths(const MachineResult& machine, std::vector<LedgerLine>& lines) {
  for (const DatapathResult& d : machine.datapaths) {
    lines.push_back({d.datapath.name + ": busiest", static_cast<double>(d.busiest_cycles), 1});
  }
}

void find_unpaid_memories(const MachineResult& machine, std::vector<std::string>& faults) {
  std::set<std::string> uses, accessed;
  for (const SramAccesses& a : machine.sram_accesses) accessed.insert(a.use);
  for (const SramUse& use : machine.sram_uses) {
    if (!uses.insert(use.name).second) {
      faults.push_back(
          fmt::format("two different uses of on-chip memory are named \"{}\"", use.name));
    }
    if (accessed.count(use.name) == 0) {
      faults.push_back(fmt::format("nobody says the accesses of \"{}\"", use.name));
    }
  }
  for (const std::string& use : accessed) {
    if (uses.count(use) == 0) {
      faults.push_back(fmt::format("accesses of \"{}\", which is no use of on-chip memory", use));
    }
  }
}

// Finds memories asked for more in one cycle than they can do, as their unit says it or their
// queues saw it. Also finds accesses that do not fit a bank.
void find_impossible_memories(const MachineResult& machine, std::vector<std::string>& faults) {
  for (const SramUse& use : machine.sram_uses) {
    const SramShape& shape = use.shape;
    if (8 * use.bytes < std::uint64_t{shape.width_bits} * shape.banks && use.bytes > 0) {
      faults.push_back(fmt::format("{}: {} B in {} banks of {} bits: a bank does not hold a word",
                                   use.name, use.bytes, shape.banks, shape.width_bits));
    }
    const std::uint32_t of_a_port = shape.ports == SramPorts::kOne
                                        ? use.peak.reads + use.peak.writes
                                        : std::max(use.peak.reads, use.peak.writes);
    if (of_a_port > shape.banks) {
      faults.push_back(fmt::format("{}: {} reads and {} writes in a cycle, {} banks of {}",
                                   use.name, use.peak.reads, use.peak.writes, shape.banks,
                                   shape.ports == SramPorts::kOne ? "a port" : "a port for each"));
    }
    for (const SramAccesses& a : machine.sram_accesses) {
      if (a.use != use.name) continue;
      if (a.seen.reads <= use.peak.reads && a.seen.writes <= use.peak.writes) continue;
      faults.push_back(fmt::format("{}: {} reads and {} writes seen in a cycle, {} and {} are said",
                                   use.name, a.seen.reads, a.seen.writes, use.peak.reads,
                                   use.peak.writes));
    }
  }
}

void find_unpaid_units(const MachineResult& machine, std::vector<std::string>& faults) {
  for (const UnitResult& unit : machine.units) {
    std::uint64_t busy = 0;
    for (const ActivityResult& activity : unit.activities) busy += activity.busy_cycles;
    if (busy == 0 || unit.charged) continue;
    faults.push_back(fmt::format("{} was busy for {} cycles and charged nothing", unit.name, busy));
  }
}

}  // namespace

double LedgerLine::utilisation(std::uint64_t cycles) const {
  return done == 0 ? 0 : done / (per_cycle * static_cast<double>(cycles));
}

std::vector<LedgerLine> ledger_of(const MachineResult& machine) {
  std::vector<LedgerLine> lines;
  for (const Operations& work : machine.operations) {
    LedgerLine line{work.component + ": " + work.kind, work.count, 0};
    for (const Parts& part : machine.parts) {
      if (part.component == work.component && part.kind == work.kind) {
        line.per_cycle = part.per_cycle;
      }
    }
    lines.push_back(line);
  }
  add_datapaths(machine, lines);
  add_ports(machine, lines);
  return lines;
}

std::vector<std::string> ledger_faults(const MachineResult& machine, std::uint64_t cycles) {
  std::vector<std::string> faults;
  find_unpaid_memories(machine, faults);
  find_impossible_memories(machine, faults);
  find_unpaid_units(machine, faults);
  for (const LedgerLine& line : ledger_of(machine)) {
    if (line.done > 0 && line.per_cycle == 0) {
      faults.push_back(fmt::format("{}: {:g} done, and nothing stands there that does them",
                                   line.what, line.done));
    } else if (line.done > line.per_cycle * static_cast<double>(cycles)) {
      faults.push_back(fmt::format("{}: {:g} done, {:g} a cycle can be, in {} cycles", line.what,
                                   line.done, line.per_cycle, cycles));
    }
  }
  return faults;
}

}  // namespace sgs
