// Sections of units, on-chip memories and datapaths, and of what holds the frame.
#include "testbench/result/ledger.h"
#include "testbench/streaminggs/report/report_sections.h"

namespace sgs {
namespace {

void visit_remedy(ReportVisitor& r, const Remedy& remedy) {
  if (!r.has(remedy.known())) return;
  r("key", "", "Configuration key to change for fewer of these cycles, where one is known.",
    remedy.key);
  r("turn", "", "How to change that key: `up` or `down`.",
    remedy.turn == Turn::kUp ? "up" : "down");
}

const char* meaning_of(WaitFor what) {
  switch (what) {
    case WaitFor::kIdle:
      return "Cycles with nothing to do.";
    case WaitFor::kInput:
      return "Cycles of waiting for an entry of a FIFO.";
    case WaitFor::kReads:
      return "Cycles of waiting for answers to its reads.";
    case WaitFor::kWrites:
      return "Cycles of waiting for answers to its writes.";
    case WaitFor::kRoom:
      return "Cycles of waiting for a free entry of a FIFO or a buffer.";
    case WaitFor::kPort:
      return "Cycles of waiting for a free transaction of its port, or for the memory to take one.";
    case WaitFor::kLoading:
      return "Cycles of waiting for an on-chip memory to be loaded.";
    case WaitFor::kPhase:
      return "Cycles of waiting for its phase of the frame, while other units prepare memory.";
  }
  return "";
}

void visit_activity(ReportVisitor& r, const ActivityResult& activity) {
  r("resource", "", "Resource that it keeps busy.", activity.resource);
  r("busy_cycles", "cycles",
    "Cycles in which it worked. With all cycles of waiting they add up to the frame.",
    activity.busy_cycles);
  r.object("waited_cycles", [&] {
    for (std::size_t k = 0; k < kWaitForCount; ++k) {
      const auto what = static_cast<WaitFor>(k);
      r(name_of(what), "cycles", meaning_of(what), activity.waited_for(what));
    }
  });
  r.list("waits", activity.waits, [&](const WaitResult& wait) {
    r("for", "", "What it waited for: a key of `waited_cycles`.", name_of(wait.what));
    r("cycles", "cycles", "Cycles of waiting at this place.", wait.cycles);
    if (r.has(!wait.at.empty())) {
      r("on", "", "Path of the FIFO, port or unit; none for `idle` and `phase`.", wait.at);
    }
    if (r.has(!wait.other.empty())) {
      r("other_end", "", "Activity at the other end of that FIFO.", wait.other);
    }
    visit_remedy(r, wait.remedy);
  });
  visit_remedy(r, activity.remedy);
}

}  // namespace

void visit_unit(ReportVisitor& r, const UnitResult& unit) {
  r.object("activities", [&] {
    r.each(unit.activities, [&](const ActivityResult& activity) {
      r.object({"ACTIVITY", activity.name}, [&] { visit_activity(r, activity); });
    });
  });
  r.object("counters", [&] {
    r.each(unit.counters, [&](const CounterResult& counter) {
      r({"COUNTER", counter.name}, "", "A count of this unit, with the unit's own meaning.",
        counter.value);
    });
  });
}

void visit_binding(ReportVisitor& r, const Binding& binding) {
  r("unit", "", "The busiest resource. `dram` is the data bus of the busiest channel.",
    binding.unit);
  r("utilisation", "0..1", "Its share of the frame.", binding.utilisation);
  r("next", "", "The second busiest resource.", binding.next);
  r("next_utilisation", "0..1", "The second one's share of the frame.", binding.next_utilisation);
  r("holds", "",
    "The bottleneck: the busiest resource, or, where none is busy enough, the cause of its "
    "waiting.",
    binding.holds);
  r("explanation", "", "A sentence with the way to the bottleneck, its numbers and advice.",
    binding.sentence());
  visit_remedy(r, binding.remedy);
}

void visit_sram(ReportVisitor& r, const MachineResult& machine, const SramModel& model) {
  r.each(machine.sram_available, [&](const auto& memory_and_bytes) {
    const auto& [memory, available] = memory_and_bytes;
    r({"MEMORY_bytes", memory + "_bytes"}, "B", "Bytes that this on-chip memory needs.",
      sram_bytes(machine.sram_uses, memory));
    r({"MEMORY_available_bytes", memory + "_available_bytes"}, "B",
      "Bytes that the configuration gives it.", available);
  });
  r.list("uses", machine.sram_uses, [&](const SramUse& use) {
    r("name", "", "Name of this use of on-chip memory.", use.name);
    r("memory", "", "Which memory it takes its bytes from.", use.memory);
    r("bytes", "B", "Bytes of all of its memories.", use.total_bytes());
    r("built_as", "", "`sram`, or `registers`, which are in no sum of bytes.",
      use.in_registers() ? "registers" : "sram");
    r("arithmetic", "", "The product that the bytes come from.", use.product());
    r("memories", "", "Banks of this use.", use.count * use.shape.banks);
    r("width_bits", "bit", "Width of an access.", use.shape.width_bits);
    r("mm2", "mm2", "Middle area of this use.", [&] { return model.mm2(use).middle; });
    r.each(machine.sram_accesses, [&](const SramAccesses& a) {
      if (!r.has(a.use == use.name)) return;
      r("reads", "accesses", "Reads in this frame.", a.reads);
      r("writes", "accesses", "Writes in this frame.", a.writes);
      r("energy_j", "J", "Middle energy of these accesses.",
        [&] { return access_energy_j(machine, use, model).middle; });
    });
  });
}

void visit_datapath(ReportVisitor& r, const DatapathResult& result) {
  const Datapath& d = result.datapath;
  const auto cost = [&](const char* key, const char* macs_meaning, std::uint32_t macs) {
    r.object(key, [&] {
      r("macs", "", macs_meaning, macs);
      r("interval_cycles", "cycles", "Cycles that these take on the lanes of one copy.",
        (macs + d.lanes - 1) / d.lanes);
    });
  };
  r("lane", "", "Kind of its lanes: a row of the technology table.", d.lane);
  r("lanes", "", "Lanes of all copies.", d.all_lanes());
  if (r.has(!d.lanes_of.empty())) {
    r("lanes_of", "", "Datapath whose lanes these are, which is idle meanwhile.", d.lanes_of);
  }
  r("items", "", "Items that passed them in this frame.", result.items);
  r.object("counts", [&] {
    r.each(d.counts, [&](const auto& count) {
      r({"CLASS", count.first}, "", "Operations of this class that one item takes.", count.second);
    });
  });
  cost("counted", "Multiply-accumulates of an item, counted by running its code.", d.counted_macs);
  if (r.has(d.published_macs > 0)) {
    cost("paper", "Multiply-accumulates of an item that the paper states.", d.published_macs);
  }
  cost("used", "Multiply-accumulates of an item that this run charges.", d.used_macs);
  const auto beside = [&](const std::string& kind, std::uint32_t operations, const auto& parts) {
    r.object("beside", [&] {
      r.object({"KIND", kind}, [&] {
        r("operations", "", "Operations of an item that parts of this kind do beside the lanes.",
          operations);
        r("parts", "", "Parts of this kind in all copies.", parts);
      });
    });
  };
  r.each(d.beside, [&](const BesideLanes& part) {
    beside(part.kind, part.operations, [&] { return d.parts(part); });
  });
  const auto between = [&](const char* kind, std::uint32_t bits, std::uint32_t of_item) {
    if (bits > 0) beside(kind, of_item, [&] { return std::uint64_t{d.copies} * bits; });
  };
  between("register_bit", d.between.registers, d.between.written);
  between("select_bit", d.between.multiplexers, d.between.selected);
  r("depth_cycles", "cycles", "Latency of an item by the schedule of its steps on these lanes.",
    d.depth_cycles);
}

void visit_ledger(ReportVisitor& r, const FrameResult& run) {
  r.list("lines", ledger_of(run.machine), [&](const LedgerLine& line) {
    r("what", "", "A component's parts, a datapath's busiest unit or a memory's accesses.",
      line.what);
    r("done", "", "Operations or accesses that it did.", line.done);
    r("per_cycle", "1/cycle", "Operations or accesses that it could do in a cycle.",
      line.per_cycle);
    r("utilisation", "0..1", "What it did over what it could do in the frame.",
      line.utilisation(run.cycles));
  });
  r("faults", "", "Work that nothing does or pays for, in words: an empty list.",
    ledger_faults(run.machine, run.cycles));
}

}  // namespace sgs
