// Sections of energy and area.
#include "testbench/streaminggs/report/report_sections.h"

namespace sgs {
namespace {

using Key = ReportVisitor::Key;

void visit_band(ReportVisitor& r, const Key& key, const char* unit, const Band& amount) {
  r.object(key, [&] {
    r("low", unit, "The same as the lowest values of the technology table give it.", amount.low);
    r("middle", unit, "The same as the middle values give it.", amount.middle);
    r("high", unit, "The same as the highest values give it.", amount.high);
  });
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

void visit_energy(ReportVisitor& r, const ViewResult& view) {
  visit_costs(r, view.energy_j, "_j", "J",
              "Middle energy of a component: logic, a use of on-chip memory, clock, leakage, DRAM.",
              "Middle energy of the frame.");
  r("mean_power_w", "W", "`energy.total_j` over the frame time.", view.mean_power_w());
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

void visit_area(ReportVisitor& r, const ViewResult& view) {
  visit_costs(r, view.area_mm2, "", "mm2",
              "Middle area of a component; `sram` is all on-chip memory.",
              "Middle area of the machine.");
  visit_band(r, "without_memory_interface", "mm2", view.area_totals_mm2.without_memory_interface);
  visit_band(r, "with_memory_interface", "mm2", view.area_totals_mm2.with_memory_interface);
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
