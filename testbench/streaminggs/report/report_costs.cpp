// Sections of energy, area and the memory: its traffic, and what its interface rests on.

#include "testbench/streaminggs/report/report_sections.h"

namespace sgs {

namespace {

void visit_traffic(ReportVisitor& r, const MemoryResult& m) {
  r.object("bytes_by_region", [&] {
    r.each(m.traffic, [&](const RegionTraffic& t) {
      r.object({"REGION", t.region}, [&] {
        r.object({"REQUESTER", t.requester}, [&] {
          if (r.has(t.read_bytes > 0)) {
            r("read", "B", "Bytes requested by reads; none where it is 0.", t.read_bytes);
          }
          if (r.has(t.written_bytes > 0)) {
            r("write", "B", "Bytes requested by writes; none where it is 0.", t.written_bytes);
          }
        });
      });
    });
  });
  r.object("bus_bytes_by_region", [&] {
    r.each(m.bus_bytes_by_region, [&](const auto& region_and_bytes) {
      r({"REGION", region_and_bytes.first}, "B", "Bytes on the bus for this region.",
        region_and_bytes.second);
    });
  });
}

using Key = ReportVisitor::Key;

void visit_band(ReportVisitor& r, const Key& key, const char* unit, const Band& amount,
                const std::string& what = "The same") {
  const auto as = [&](const char* values) { return what + " as the " + values + " give it."; };
  r.object(key, [&] {
    r("low", unit, as("lowest values of the sources").c_str(), amount.low);
    r("middle", unit, as("middle values").c_str(), amount.middle);
    r("high", unit, as("highest values").c_str(), amount.high);
  });
}

// what: that is summed.
void visit_totals(ReportVisitor& r, const std::string& suffix, const char* unit,
                  const Totals& totals, const std::string& what) {
  const std::string interface = " PHY and controller of the memory";
  visit_band(r, Key(("without_memory_interface" + suffix).c_str()), unit,
             totals.without_memory_interface, what + " without" + interface);
  visit_band(r, Key(("with_memory_interface" + suffix).c_str()), unit, totals.with_memory_interface,
             what + " with" + interface);
}

// Middle values, and beside them what the sources allow.
void visit_costs(ReportVisitor& r, const CostResult& cost, const std::string& suffix,
                 const char* unit, const char* of_component, const char* of_total) {
  const Key total(("total" + suffix).c_str());
  const auto key_of = [&](const std::string& component) {
    return Key("COMPONENT" + suffix, component + suffix);
  };
  r.each(cost.by_component,
         [&](const auto& part) { r(key_of(part.first), unit, of_component, part.second.middle); });
  r(total, unit, of_total, cost.total.middle);
  r.object("bands", [&] {
    r.each(cost.by_component,
           [&](const auto& part) { visit_band(r, key_of(part.first), unit, part.second); });
    visit_band(r, total, unit, cost.total);
  });
}

}  // namespace

void visit_dram(ReportVisitor& r, const MemoryResult& m) {
  r("bytes", "B", "Bytes that units requested.", m.bytes);
  r("bus_bytes", "B",
    "Bytes on the bus, in whole bursts. Fewer than requested where the write queue answers reads.",
    m.bus_bytes);
  visit_traffic(r, m);
  r("transactions", "", "TLM-2.0 transactions of the units.", m.transactions);
  r("row_hits", "bursts", "Bursts that found their row open.", m.row_hits);
  r("row_misses", "bursts", "Bursts that found their bank closed.", m.row_misses);
  r("row_conflicts", "bursts", "Bursts that found another row open.", m.row_conflicts);
  r("refreshes", "commands", "Refresh commands, of all banks or of one.", m.refreshes);
  r("bandwidth_gb_s", "10^9 B/s", "`dram.bytes` over the frame time.", m.bandwidth_gb_s);
  r("busy_bandwidth_gb_s", "10^9 B/s",
    "`dram.bytes` over the time in which the controller has a request.", m.busy_bandwidth_gb_s);
  r("peak_gb_s", "10^9 B/s", "Width times data rate of all channels.", m.peak_gb_s);
  r("of_peak", "0..1", "`dram.bandwidth_gb_s` over `dram.peak_gb_s`.",
    m.bandwidth_gb_s / m.peak_gb_s);
  r("read_latency_mean_ns", "ns",
    "Mean time of a read, from its arrival at the controller to its last datum.",
    m.read_latency_mean_ns);
  r("read_latency_p50_ns", "ns", "Median of the same time.", m.read_latency_p50_ns);
  r("read_latency_p99_ns", "ns", "Time that 99 of 100 reads do not exceed.", m.read_latency_p99_ns);
}

void visit_memory_interface(ReportVisitor& r, const MemoryInterface& interface) {
  r("memspec", "", "Name of the memory: its memspec's.", interface.memspec);
  r("area_of", "",
    "Memory whose PHY and controller are counted: how the names of its memspecs begin.",
    interface.area_of);
  r("area_known", "bool", "That is this memory: area and power of its interface are known.",
    interface.area_known);
  r("area_source", "", "Source of area and power of PHY and controller, by the technology table.",
    interface.area_source);
  r("io_pj_per_bit", "pJ", "I/O energy of a transferred bit, part of `energy.dram_j`.",
    interface.io_pj_per_bit);
  r("io_pj_per_bit_low", "pJ", "Least that its source allows.", interface.io_pj_per_bit_low);
  r("io_pj_per_bit_high", "pJ", "Most that its source allows.", interface.io_pj_per_bit_high);
  r("io_source", "", "Source of that: the memspec's, or `dram.io_pj_per_bit` where that is given.",
    interface.io_source);
}

void visit_energy(ReportVisitor& r, const ViewResult& view) {
  visit_costs(r, view.energy_j, "_j", "J",
              "Middle energy of a component: logic, a use of on-chip memory, clock, leakage, DRAM.",
              "Middle energy of the frame.");
  visit_totals(r, "_j", "J", view.energy_totals_j, "Energy of the frame");
  r("mean_power_w", "W", "`energy.total_j` over the frame time.", view.mean_power_w());
  const bool known = view.run.memory.energy_not_stated.empty();
  r("memory_known", "bool",
    "The memspec states all that the memory's energy is made of. If not, this is without the "
    "memory, and no entry follows.",
    known);
  if (!r.has(known)) return;
  r.object("dram_by_current_set_j", [&] {
    r.each(view.run.memory.energy_by_current_set_j, [&](const auto& set) {
      r({"SET", set.first}, "J", "Energy of the memory by this published set of currents.",
        set.second);
    });
  });
  r.object("dram_by_region_j", [&] {
    r.each(view.run.memory.energy_by_region_j, [&](const auto& region) {
      r({"REGION", region.first}, "J",
        "Energy of the memory for this region. `standby_and_refresh` belongs to none.",
        region.second);
    });
  });
}

void visit_fixed_rate(ReportVisitor& r, const FixedRate& rate) {
  r("per_s", "1/s", "Frames that are begun in a second: `--frame-rate`.", rate.per_s);
  r("held", "bool", "The frame is done before the next one begins. If not, no entry follows.",
    rate.held);
  if (!r.has(rate.held)) return;
  r("memory_known", "bool",
    "As `energy.memory_known`, of the rest, too. If not, this is without the memory where it is "
    "not "
    "known.",
    rate.memory_not_stated.empty());
  visit_band(r, "energy_j", "J", rate.energy_j, "Energy of a frame and its rest");
  visit_band(r, "power_w", "W", rate.power_w(), "Power at this rate");
  visit_totals(r, "_w", "W", rate.totals_w(), "Power at this rate");
  r.object("rest", [&] {
    r("time_s", "s", "Time from the end of the frame until the next one begins.", rate.rest_s);
    r("power_down_s", "s", "Of it in power-down, mean of the memory's ranks.", rate.power_down_s);
    r("self_refresh_s", "s", "Of it in self-refresh, likewise.", rate.self_refresh_s);
    visit_costs(r, rate.rest_j, "_j", "J",
                "Middle energy of a component in the rest: leakage and DRAM.",
                "Middle energy of the rest.");
    visit_band(r, "memory_interface_w", "W", rate.memory_interface_w,
               "Power of PHY and controller, part of the rest where the technology counts them,");
  });
}

void visit_flow(ReportVisitor& r, const StreamFlow& flow) {
  r("time_s", "s",
    "From the first frame's picture to the last one's; where a frame misses, and without a "
    "display, that of all.",
    flow.time_s);
  r("frames", "", "Frames that are drawn in that time.", flow.frames);
  r("bytes", "B", "As `dram.bytes`, requested in that time.", flow.bytes);
  r("bus_bytes", "B", "As `dram.bus_bytes`.", flow.bus_bytes);
  r.object("energy", [&] {
    visit_costs(
        r, flow.energy_j, "_j", "J",
        "Middle energy of a component in that time, as in a frame. The clock stands while no "
        "frame is under way.",
        "Middle energy of that time.");
  });
  visit_band(r, "power_w", "W", flow.power_w(), "Joules a second");
  visit_totals(r, "_w", "W", flow.totals_w(), "Joules a second");
  r.object("memory", [&] {
    r.each(flow.states, [&](const MemoryState& state) {
      r.object({"STATE", state.name}, [&] {
        r("time_s", "s",
          "Time in state `active`, `precharged`, `power_down` or `self_refresh`, mean of the "
          "ranks.",
          state.time_s);
        r("energy_j", "J", "Energy that the state draws.", state.energy_j);
      });
    });
    r.each(flow.commands, [&](const auto& command) {
      r({"COMMAND_j", command.first + "_j"}, "J",
        "Energy of `activate`, `read`, `write` and `refresh` above their state's, and of `io`. "
        "With the "
        "states' it is `dram_j`.",
        command.second);
    });
  });
}

void visit_area(ReportVisitor& r, const ViewResult& view) {
  visit_costs(r, view.area_mm2, "", "mm2",
              "Middle area of a component; `sram` is all on-chip memory.",
              "Middle area of the machine.");
  visit_totals(r, "", "mm2", view.area_totals_mm2, "Area of the machine");
  if (r.has(view.stated_area_mm2 > 0)) {
    r("stated", "mm2", "Area that is published for the machine's units and on-chip memories.",
      view.stated_area_mm2);
  }
  r.object("by_owner", [&] {
    r.each(view.area_by_owner_mm2.by_component, [&](const auto& part) {
      r({"OWNER", part.first}, "mm2",
        "Middle area of a kind of unit with its on-chip memory, or of what no unit owns. They "
        "add up to `area_mm2.with_memory_interface`.",
        part.second.middle);
    });
  });
}

}  // namespace sgs
