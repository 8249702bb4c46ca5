// Joules and square millimetres: all that is done and all that stands there at its own price.
#include "testbench/cost/cost.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "testbench/cost/fixed_rate.h"
#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

using nlohmann::json;

constexpr Band same(double value) { return {value, value, value}; }

// Prices that no two sums have in common, and bounds at half and at three times of them.
Technology priced() {
  const auto around = [](double value) { return Band{value / 2, value, 3 * value}; };
  Technology technology;
  technology.name = "test";
  technology.parts = {{"lane", {around(0.25), around(5000), 64, ""}},
                      {"comparator", {around(0.01), around(300), 0, ""}},
                      {kRegisterClock, {same(0), around(11), 0, ""}},
                      {kClockGate, {same(0), around(17), 0, ""}}};
  technology.sram.um2_bit = 1e3;
  technology.sram.um2_register = same(1e6);
  technology.sram.pj_width = 2;
  technology.sram.second_port = technology.sram.macro = technology.sram.placed =
      technology.sram.access = same(1);
  technology.sram.write_of_read = same(1.5);
  technology.sram.leakage_mw_kib = same(7);
  technology.die.logic_leakage_mw_mm2 = around(13);
  technology.memory_interface.gb_s = 6.4;
  technology.memory_interface.mm2 = same(0.5);
  technology.memory_interface.mw = same(17);
  return technology;
}

Band of(const CostResult& cost, const std::string& component) {
  for (const auto& [name, amount] : cost.by_component) {
    if (name == component) return amount;
  }
  FAIL("no component " << component);
  return {};
}

// 8 lanes, 100 comparators, a memory of 2 x 1 KiB; 2 us.
FrameResult frame() {
  FrameResult frame;
  frame.cycles = 2000;
  frame.clock_mhz = 1000;
  frame.machine.parts = {{"filter", "lane", 8, 8}, {"heap", "comparator", 100, 100}};
  frame.machine.operations = {
      {"filter", "lane", 3}, {"heap", "comparator", 10}, {"idle", "lane", 0}};
  add(frame.machine.sram_uses, sram_use("first halves", "input", {{1024, "B"}}, {64}, kOneOfEach),
      2);
  frame.machine.sram_accesses = {{"first halves", 20, 6}};
  frame.memory.energy_j = 1e-6;
  frame.memory.energy_least_j = 0.75e-6;
  frame.memory.energy_most_j = 1.75e-6;
  frame.memory.channels = 4;
  frame.memory.write_queue_entries = 32;
  frame.memory.peak_gb_s = 25.6;
  return frame;
}

TEST_CASE("cost: each kind of work at its own price, summed by component") {
  const CostResult energy = energy_of(frame(), priced());
  CHECK(of(energy, "filter").middle == Approx(3 * 5000e-12));
  CHECK(of(energy, "heap").middle == Approx(10 * 300e-12));
  CHECK(of(energy, "idle").middle == 0);
  // 64 bits at 2 pJ; a write 1.5 of it.
  CHECK(of(energy, "first_halves").middle == Approx((20 + 6 * 1.5) * 128e-12));
  // 64 register bits of a lane by each of 3 operations; 16 gates of 32 bits each cycle.
  CHECK(of(energy, "clock").middle == Approx((3 * 64 * 11 + 2000 * 16 * 17) * 1e-12));
  CHECK(of(energy, "logic_leakage").middle == Approx(3.0 * 13e-3 * 2e-6));
  CHECK(of(energy, "sram_leakage").middle == Approx(2 * 7e-3 * 2e-6));
  CHECK(of(energy, "dram").middle == 1e-6);
  CHECK(energy.by_component.size() == 8);
  double sum = 0;
  for (const auto& [name, amount] : energy.by_component) sum += amount.middle;
  CHECK(energy.total.middle == Approx(sum));

  const CostResult area = area_of(frame(), priced());
  CHECK(of(area, "filter").middle == Approx(2));
  CHECK(of(area, "heap").middle == Approx(1));
  CHECK(of(area, "sram").middle == Approx(2 * 8192 * 1e3 * 1e-6));
  CHECK(area.total.middle == Approx(3 + 16.384));
}

TEST_CASE("cost: each word of registers has a clock gate") {
  Technology technology = priced();
  technology.parts.at(kClockGate).mm2 = same(0.5);
  const CostResult area = area_of(frame(), technology), without = area_of(frame(), priced());
  CHECK(of(area, "filter").middle == Approx(of(without, "filter").middle + 8 * 2 * 0.5));
  CHECK(of(area, "heap").middle == of(without, "heap").middle);
  for (const char* row : {kRegisterClock, kClockGate}) {
    technology = priced();
    technology.parts.erase(row);
    CHECK(input_error_of([&] { energy_of(frame(), technology); }).find(row) != std::string::npos);
  }
}

TEST_CASE("cost: bounds follow their constants") {
  const CostResult area = area_of(frame(), priced()), energy = energy_of(frame(), priced());
  CHECK(of(area, "filter").low == Approx(1));
  CHECK(of(area, "filter").high == Approx(6));
  CHECK(area.total.low == Approx(1.5 + 16.384));
  CHECK(area.total.high == Approx(9 + 16.384));
  CHECK(of(energy, "heap").low == Approx(5 * 300e-12));
  CHECK(of(energy, "clock").low == Approx(of(energy, "clock").middle / 2));
  // Without gates 8 lanes are clocked in every cycle.
  CHECK(of(energy, "clock").high == Approx(2000 * 8 * 64 * 11e-12));
  // Lanes that always work take more than that at the high end of their constants.
  FrameResult busy = frame();
  busy.machine.operations.front().count = 2000 * 8;
  const Band clock = of(energy_of(busy, priced()), "clock");
  CHECK(clock.high == Approx(3 * clock.middle));
  CHECK(of(energy, "dram").low == 0.75e-6);
  CHECK(of(energy, "dram").high == 1.75e-6);
  for (double Band::*end : {&Band::low, &Band::middle, &Band::high}) {
    double sum = 0;
    for (const auto& [name, amount] : energy.by_component) sum += amount.*end;
    CHECK(energy.total.*end == Approx(sum));
  }
}

// A memory that spends three quarters of a rest in self-refresh.
Rest rest() {
  Rest rest;
  rest.cycles = 100;
  rest.ranks.resize(1);
  rest.ranks[0].self_refresh_cycles = 75;
  rest.energy.vdd2.self_refresh_pj = 2e6;
  rest.energy.least_pj = 1e6;
  rest.energy.most_pj = 5e6;
  return rest;
}

TEST_CASE("cost: between frames leakage goes on, the clock stands, the memory rests") {
  Technology technology = priced();
  const CostResult energy = rest_energy_of(frame(), rest(), 4e-6, technology);
  CHECK(energy.by_component.size() == 3);
  CHECK(of(energy, "logic_leakage").middle == Approx(3.0 * 13e-3 * 4e-6));
  CHECK(of(energy, "sram_leakage").middle == Approx(2 * 7e-3 * 4e-6));
  CHECK(of(energy, "dram").low == Approx(1e-6));
  CHECK(of(energy, "dram").middle == Approx(2e-6));
  CHECK(of(energy, "dram").high == Approx(5e-6));
  // A quarter of the time as in a frame, for the rest as 0.5 mm2 of logic leak; four channels.
  const double watts = 4 * (0.25 * 17e-3 + 0.75 * 0.5 * 13e-3);
  CHECK(resting_interface_w(frame(), rest(), technology).middle == Approx(watts));
  // High: as in a frame all the time, or as logic where that is more.
  technology.memory_interface.mw.high = 60;
  CHECK(resting_interface_w(frame(), rest(), technology).high == Approx(4 * 60e-3));
  technology.memory_interface.counted = true;
  const CostResult counted = rest_energy_of(frame(), rest(), 4e-6, technology);
  CHECK(of(counted, "memory_interface").middle == Approx(watts * 4e-6));
  CHECK(counted.total.middle == Approx(energy.total.middle + watts * 4e-6));
}

TEST_CASE("cost: at a fixed rate a frame and its rest, or that the rate is not held") {
  const Technology technology = priced();
  const Band frame_j = energy_of(frame(), technology).total;
  const FixedRate rate = at_rate(100, frame(), DramConfig(), technology);
  REQUIRE(rate.held);
  CHECK(rate.rest_s == Approx(0.01 - 2e-6));
  CHECK(rate.self_refresh_s == Approx(rate.rest_s).epsilon(1e-3));
  CHECK(rate.power_down_s == 0);
  for (double Band::*end : {&Band::low, &Band::middle, &Band::high}) {
    CHECK(rate.energy_j.*end == Approx(frame_j.*end + rate.rest_j.total.*end));
    CHECK(rate.power_w().*end == Approx(100 * rate.energy_j.*end));
  }
  CHECK(of(rate.rest_j, "logic_leakage").middle == Approx(3.0 * 13e-3 * (0.01 - 2e-6)));
  DramConfig awake;
  awake.between_frames = BetweenFrames::kByIdleCycles;
  CHECK(of(at_rate(100, frame(), awake, technology).rest_j, "dram").middle >
        10 * of(rate.rest_j, "dram").middle);
  CHECK(at_rate(5e5, frame(), DramConfig(), technology).held);
  const FixedRate late = at_rate(5.01e5, frame(), DramConfig(), technology);
  CHECK_FALSE(late.held);
  CHECK(late.rest_j.by_component.empty());
}

TEST_CASE("cost: at a fixed rate the band ends where the memory may not refresh itself") {
  const auto memory = [](const char* memspec, BetweenFrames between) {
    DramConfig dram;
    dram.memspec = memspec;
    dram.between_frames = between;
    return of(at_rate(100, frame(), dram, priced()).rest_j, "dram");
  };
  for (const char* memspec : {"lpddr3_1600_4gb", "lpddr5_6400_8gb"}) {
    INFO(memspec);
    const Band asleep = memory(memspec, BetweenFrames::kSelfRefresh);
    const Band down = memory(memspec, BetweenFrames::kPowerDown);
    CHECK(down.low > asleep.low);
    CHECK(down.middle > asleep.middle);
    CHECK(asleep.high == down.high);
    const Band standby = memory(memspec, BetweenFrames::kByIdleCycles);
    CHECK(standby.high > down.high);
  }
}

TEST_CASE("cost: between rows of a display the memory's interface stands at the low end alone") {
  Technology technology = priced();
  technology.memory_interface.mw = {9, 17, 60};
  for (const bool display : {false, true}) {
    FrameResult shown = frame();
    shown.memory.states = {{kSelfRefreshState, shown.time_s() / 2, 0}};
    if (display) shown.memory.traffic.push_back({"frame_buffer", "display", 64, 0});
    const double moved = energy_totals(frame(), technology).memory_interface.middle;
    const Band stands = energy_totals(shown, technology).memory_interface;
    INFO(display);
    CHECK(stands.low < energy_totals(frame(), technology).memory_interface.low);
    CHECK((stands.middle == Approx(moved)) == display);
  }
}

TEST_CASE("cost: joules with and without the memory's interface, whatever the table counts") {
  Technology technology = priced();
  technology.memory_interface.mw = {9, 17, 60};
  for (const bool counted : {false, true}) {
    technology.memory_interface.counted = counted;
    const Totals frame_j = energy_totals(frame(), technology);
    const FixedRate rate = at_rate(100, frame(), DramConfig(), technology);
    for (double Band::*end : {&Band::low, &Band::middle, &Band::high}) {
      CHECK(frame_j.without_memory_interface.*end == energy_of(frame(), priced()).total.*end);
      const double interface = 4e-3 * technology.memory_interface.mw.*end;  // W of four channels
      CHECK(frame_j.with_memory_interface.*end ==
            Approx(frame_j.without_memory_interface.*end + 2e-6 * interface));
      CHECK((counted ? frame_j.with_memory_interface : frame_j.without_memory_interface).*end ==
            Approx(energy_of(frame(), technology).total.*end));
      const Totals watts = rate.totals_w();
      CHECK(watts.with_memory_interface.*end ==
            Approx(watts.without_memory_interface.*end +
                   100 * (2e-6 * interface + rate.rest_s * rate.memory_interface_w.*end)));
      CHECK((counted ? watts.with_memory_interface : watts.without_memory_interface).*end ==
            Approx(rate.power_w().*end));
    }
  }
}

TEST_CASE("cost: what of the memory is not known is no part of a frame's joules, or of a rest's") {
  const Technology technology = priced();
  FrameResult unknown = frame();
  unknown.memory.energy_not_stated = "currents";
  const CostResult with = energy_of(frame(), technology), without = energy_of(unknown, technology);
  CHECK(without.by_component.size() == with.by_component.size() - 1);
  CHECK(without.total.middle == Approx(with.total.middle - 1e-6));
  Rest resting = rest();
  resting.energy.not_stated = "idd6";
  CHECK(rest_energy_of(frame(), resting, 4e-6, technology).by_component.size() == 2);
  CHECK(at_rate(100, frame(), DramConfig(), technology).memory_not_stated.empty());
  CHECK(at_rate(100, unknown, DramConfig(), technology).memory_not_stated == "currents");
}

TEST_CASE("cost: leakage lasts as long as the frame") {
  FrameResult once = frame();
  FrameResult longer = frame();
  once.clock_mhz = longer.clock_mhz = 500;
  longer.cycles = 3 * once.cycles;
  for (const char* leakage : {"sram_leakage", "logic_leakage"}) {
    CHECK(of(energy_of(longer, priced()), leakage).middle ==
          Approx(3 * of(energy_of(once, priced()), leakage).middle));
  }
}

TEST_CASE("cost: the memory's interface counts where the table says so") {
  Technology technology = priced();
  const double without = area_of(frame(), technology).total.middle;
  technology.memory_interface.counted = true;
  CHECK(area_of(frame(), technology).total.middle == Approx(without + 4 * 0.5));
  CHECK(of(energy_of(frame(), technology), "memory_interface").middle == Approx(4 * 17e-3 * 2e-6));
  // With a queue of writes in each of four channels, 256 bits wide; 1,000 bytes are 32 bursts.
  technology.memory_interface.write_queue_bytes = 8192;
  FrameResult writing = frame();
  writing.memory.traffic = {{"frame", "rendering", 7, 1000}};
  CHECK(area_of(writing, technology).total.middle ==
        Approx(without + 4 * 0.5 + 4 * 65536 * 1e3 * 1e-6));
  CHECK(of(energy_of(writing, technology), "memory_interface").middle ==
        Approx((4 * 17e-3 + 4 * 8 * 7e-3) * 2e-6 + 32 * (1 + 1.5) * 512e-12));
  writing.memory.write_queue_entries = 96;
  CHECK(area_of(writing, technology).total.middle ==
        Approx(without + 4 * 0.5 + 3 * 4 * 65536 * 1e3 * 1e-6));
}

TEST_CASE("cost: area with and without the memory's interface, whatever the table counts") {
  Technology technology = priced();
  technology.memory_interface.mm2 = {0.25, 0.5, 1};
  for (const bool counted : {false, true}) {
    technology.memory_interface.counted = counted;
    const Totals totals = area_totals(frame(), technology);
    CHECK(totals.without_memory_interface.middle == area_of(frame(), priced()).total.middle);
    CHECK(totals.with_memory_interface.low == Approx(1.5 + 16.384 + 4 * 0.25));
    CHECK(totals.with_memory_interface.middle == Approx(3 + 16.384 + 4 * 0.5));
    CHECK(totals.with_memory_interface.high == Approx(9 + 16.384 + 4 * 1));
    CHECK(totals.memory_interface.high == Approx(4 * 1));
    CHECK((counted ? totals.with_memory_interface : totals.without_memory_interface).middle ==
          area_of(frame(), technology).total.middle);
  }
  FrameResult doubled = frame();
  doubled.memory.peak_gb_s *= 2;  // by channels, or by a faster memory
  CHECK(area_totals(doubled, technology).with_memory_interface.middle ==
        Approx(3 + 16.384 + 8 * 0.5));
  technology.memory_interface.counted = true;
  CHECK(of(energy_of(doubled, technology), "memory_interface").middle == Approx(8 * 17e-3 * 2e-6));
}

TEST_CASE("cost: area by owner is each unit's parts with its on-chip memory") {
  const Technology technology = priced();
  FrameResult owned = frame();
  const MachineResult& machine = owned.machine;
  owned.machine.owners = {{"hfu", {machine.parts[0]}, machine.sram_uses},
                          {"merge", {machine.parts[1]}, {}}};
  const CostResult area = area_by_owner(owned, technology);
  CHECK(of(area, "hfu").middle == Approx(2 + 16.384));
  CHECK(of(area, "merge").middle == Approx(1));
  CHECK(of(area, "memory_interface").middle == Approx(4 * 0.5));
  CHECK(area.total.middle == Approx(area_totals(owned, technology).with_memory_interface.middle));
}

TEST_CASE("cost: parts that the table does not have are refused by name") {
  FrameResult other = frame();
  other.machine.parts.push_back({"filter", "divider", 1, 1});
  for (const auto& cost : {area_of, energy_of}) {
    CHECK(input_error_of([&] { cost(other, priced()); }).find("divider") != std::string::npos);
  }
}

TEST_CASE("cost: tables that say less than they must, or bands out of order, are refused by file") {
  const ScratchFolder scratch;
  const std::string path = scratch.path("table.json");
  // The shipped table with one value changed, or without it.
  const auto changed = [&](const std::string& place, const json& value) {
    json table = json::parse(bytes_of(SGS_TECHNOLOGY));
    const json::json_pointer at(place);
    if (value.is_null()) {
      table[at.parent_pointer()].erase(at.back());
    } else {
      table[at] = value;
    }
    scratch.write("table.json", table.dump());
  };
  struct Row {
    const char* place;
    json value;
    const char* expected;
  };
  const json part = json::parse(bytes_of(SGS_TECHNOLOGY))["parts"]["adder"];
  for (const Row& row : std::vector<Row>{
           {"/name", "", ": name: got none, expected that of the node"},
           {"/parts/fp32_chaining_lane/pj/low", 99,
            ": parts.fp32_chaining_lane.pj: got low 99, middle 2.99, high"},
           {"/parts/fp32_lane/pj", {}, ": parts.fp32_lane.pj.low: got nothing, expected it"},
           {"/sram/macro/high", {}, ": sram.macro.high: got nothing"},
           {"/sram/second_port", 1.9, ": sram.second_port: got 1.9"},
           {"/sram/second_port/low", 3, ": sram.second_port: got low 3"},
           {"/die", {}, ": die.logic_leakage_mw_mm2.low: got nothing"},
           {"/parts/fp32_lane/register_bits", {}, ": parts.fp32_lane.register_bits: got nothing"},
           {"/memory_interface/gb_s", {}, ": memory_interface.gb_s: got nothing"},
           {"/memory_interface/counted", {}, ": memory_interface.counted: got nothing"},
           {"/parts/fp32_lane/source", {}, ": parts.fp32_lane.source: got nothing"},
           {"/die/source", "", ": die.source: got nothing"},
           {"/published/comparator/source", {}, ": published.comparator.source: got nothing"},
           {"/parts/adder", {}, ": parts: got no row \"adder\""},
           {"/parts/addder", part, ": parts.addder: no kind of part; did you mean adder?"},
           {"/parts/divider", part,
            ": parts.divider: no kind of part, expected one of fp32_lane"}}) {
    changed(row.place, row.value);
    const std::string said = input_error_of([&] { load_technology(path); });
    INFO(said);
    CHECK(said.find(path + row.expected) == 0);
  }
  // What no cost is made of may be left out.
  CHECK(load_technology(SGS_TECHNOLOGY).clock_mhz == 1000);
  changed("/clock_mhz", {});
  CHECK(load_technology(path).clock_mhz == 0);
  changed("/sram/points", {});
  CHECK(load_technology(path).sram.points.empty());
  changed("/sram/pairs", {});
  CHECK(load_technology(path).sram.pairs.empty());
  changed("/published", {});
  CHECK(load_technology(path).published.empty());
  // What is changed of it has no effect, and that is said.
  CHECK(load_technology(SGS_TECHNOLOGY).note.empty());
  changed("/published/comparator/mm2/middle", 0.00012);
  CHECK(load_technology(path).note == path + ": published.comparator: no cost is made of it");
  changed("/sram/pairs/ihp130_512x32/one_um2", 1e5);
  CHECK(load_technology(path).note == path + ": sram.pairs.ihp130_512x32: no cost is made of it");
  Technology without_parts = load_technology(path);
  without_parts.parts.clear();
  CHECK(input_error_of([&] { area_of(frame(), without_parts); }).find(path) == 0);
}

TEST_CASE("cost: components are written in snake case") {
  FrameResult other = frame();
  other.machine.sram_uses[0].name = other.machine.sram_accesses[0].use = "finished Sub-tiles";
  CHECK(of(energy_of(other, priced()), "finished_sub_tiles").middle > 0);
}

TEST_CASE("cost: the shipped table says what its sources say") {
  const Technology technology = load_technology(SGS_TECHNOLOGY);
  const auto& published = technology.published;
  const PartCost& lane = published.at("fp32_lane");
  CHECK(lane.pj.middle == Approx(0.65 * (0.9 + 3.7)));
  const double to_32nm = 32.0 * 32 / (45 * 45);
  CHECK(lane.mm2.low == Approx((4184 + 7700) * to_32nm * 1e-6).epsilon(1e-5));
  CHECK(lane.mm2.high == Approx((4360 + 8970) * 0.8 * 0.8 * 1e-6).epsilon(1e-5));
  CHECK(lane.mm2.middle == Approx(std::sqrt(lane.mm2.low * lane.mm2.high)).epsilon(1e-5));
  const PartCost& half = published.at("fp16_lane");
  CHECK(half.mm2.middle == Approx(lane.mm2.middle * 3000 / 11884).epsilon(1e-5));
  CHECK(half.pj.middle == Approx(0.65 * (0.4 + 1.1)));
  // Gates say what else a lane takes; one that only chains has the published energy.
  const PartCost& chaining = technology.part("fp32_chaining_lane");
  CHECK(chaining.pj.middle == Approx(lane.pj.middle));
  CHECK(chaining.mm2.middle < technology.part("fp32_lane").mm2.middle);
  // A compare-exchange of 16 bits compared, 32 moved.
  const PartCost& compare = published.at("comparator");
  const PartCost& bit = published.at("exchange_bit");
  CHECK(compare.mm2.middle / 2 + 32 * bit.mm2.middle == Approx(0.042 / 2 / 80).epsilon(1e-5));
  CHECK(compare.pj.middle / 2 + 32 * bit.pj.middle ==
        Approx(13.7 / 80 * 0.65 / 0.55).epsilon(1e-5));
  for (const auto* table : {&technology.parts, &published}) {
    for (const auto& [kind, part] : *table) {
      INFO(kind);
      for (const Band& band : {part.mm2, part.pj}) {
        CHECK((band.low > 0 || kind == kRegisterClock));
        CHECK(band.low <= band.middle);
        CHECK(band.middle <= band.high);
      }
      CHECK(part.source.size() > 20);
    }
  }
}

// Squares of the residuals' logarithms, of area with one port and of energy.
struct Misfit {
  double area = 0, energy = 0;
};
Misfit misfit_of(const SramModel& model) {
  Misfit sum;
  for (const auto& [name, p] : model.points) {
    if (p.um2 > 0 && p.ports == 1) {
      const double off =
          std::log(model.bare_um2(p.bits, p.width_bits, 1).middle / (p.um2 * p.um2_scale));
      sum.area += off * off;
    }
    if (p.pj > 0) {
      const double off = std::log(model.bare_read_pj(p.bits, p.width_bits) / (p.pj * p.pj_scale));
      sum.energy += off * off;
    }
  }
  return sum;
}

// Whether narrower ones of the points, as long, do the same side by side in a third of the area.
bool is_replaced(const SramModel& model, const SramPoint& wide) {
  return std::any_of(model.points.begin(), model.points.end(), [&](const auto& named) {
    const SramPoint& p = named.second;
    return p.um2 > 0 && p.ports == wide.ports && p.um2_scale == wide.um2_scale &&
           p.bits / p.width_bits == wide.bits / wide.width_bits &&
           std::ceil(wide.width_bits / p.width_bits) * p.um2 < wide.um2 / 3;
  });
}

TEST_CASE("cost: on-chip memory is fitted to its published points, and as near as it says") {
  const SramModel model = load_technology(SGS_TECHNOLOGY).sram;
  REQUIRE(model.points.size() >= 20);
  double least = 1, most = 1;
  for (const auto& [name, p] : model.points) {
    INFO(name);
    CHECK(p.source.size() > 20);
    CHECK(p.bits / p.width_bits >= model.least_rows);
    if (p.um2 > 0 && !is_replaced(model, p)) {
      // The bounds of a macro are the extreme residuals of what somebody would build.
      const double of_model =
          p.um2 * p.um2_scale / model.bare_um2(p.bits, p.width_bits, p.ports).middle;
      CHECK(of_model >= Approx(model.macro.low).epsilon(0.01));
      CHECK(of_model <= Approx(model.macro.high).epsilon(0.01));
      least = std::min(least, of_model);
      most = std::max(most, of_model);
    }
    if (p.pj > 0) {
      // The bounds of an access are the extreme residuals.
      const double of_model = p.pj * p.pj_scale / model.bare_read_pj(p.bits, p.width_bits);
      CHECK(of_model >= Approx(model.access.low).epsilon(0.01));
      CHECK(of_model <= Approx(model.access.high).epsilon(0.01));
    }
  }
  CHECK(least == Approx(model.macro.low).epsilon(0.01));
  CHECK(most == Approx(model.macro.high).epsilon(0.01));
  // No coefficient can be moved without making it worse.
  const Misfit best = misfit_of(model);
  for (double SramModel::*coefficient :
       {&SramModel::um2_bit, &SramModel::um2_width, &SramModel::pj_width, &SramModel::pj_cell,
        &SramModel::pj_decode}) {
    for (const double factor : {0.99, 1.01}) {
      SramModel moved = model;
      moved.*coefficient *= factor;
      const Misfit other = misfit_of(moved);
      CHECK(other.area + other.energy > best.area + best.energy);
    }
  }
}

TEST_CASE("cost: a second port takes what published pairs with a read and a write port say") {
  const SramModel model = load_technology(SGS_TECHNOLOGY).sram;
  const std::string modelled = "one that reads and one that writes";
  double low = 1e9, high = 0, logarithms = 0, of_both = 0;
  for (const auto& [name, pair] : model.pairs) {
    INFO(name);
    CHECK(pair.source.size() > 20);
    const double port = pair.two_um2 / pair.one_um2;
    low = std::min(low, port);
    high = std::max(high, port);
    if (pair.source.find(modelled) == std::string::npos) continue;
    logarithms += std::log(port);
    ++of_both;
  }
  REQUIRE(of_both >= 2);
  CHECK(model.second_port.low == Approx(low).epsilon(1e-4));
  CHECK(model.second_port.middle == Approx(std::exp(logarithms / of_both)).epsilon(1e-4));
  CHECK(model.second_port.high == Approx(high).epsilon(1e-4));
}

TEST_CASE("cost: the band of a second port is part of the area of memories that have one") {
  const SramModel model = load_technology(SGS_TECHNOLOGY).sram;
  SramModel certain = model;
  certain.second_port = same(model.second_port.middle);
  const SramUse two = sram_use("pixels", "shared", {{65536, "B"}}, {256}, kOneOfEach);
  SramUse one = two;
  one.shape.ports = SramPorts::kOne;
  CHECK(model.mm2(two).low < certain.mm2(two).low);
  CHECK(model.mm2(two).middle == certain.mm2(two).middle);
  CHECK(model.mm2(two).high > certain.mm2(two).high);
  CHECK(model.mm2(one).low == certain.mm2(one).low);
  CHECK(model.mm2(one).high == certain.mm2(one).high);
}

TEST_CASE("cost: banks make accesses cheaper and area larger, a second port only area") {
  const SramModel model = load_technology(SGS_TECHNOLOGY).sram;
  const SramUse one = sram_use("pixels", "shared", {{65536, "B"}}, {256}, kOneOfEach);
  SramUse banked = one, single = one;
  banked.shape.banks = 16;
  single.shape.ports = SramPorts::kOne;
  CHECK(model.read_pj(banked).middle < 0.5 * model.read_pj(one).middle);
  CHECK(model.mm2(banked).middle > model.mm2(one).middle);
  CHECK(model.mm2(single).middle < 0.7 * model.mm2(one).middle);
  CHECK(model.read_pj(single).middle == model.read_pj(one).middle);
  CHECK(model.leakage_mw(banked).middle == model.leakage_mw(one).middle);
  CHECK(model.write_pj(one).middle == Approx(1.1 * model.read_pj(one).middle));
  // A wide bank is macros of 256 bits side by side.
  const SramUse quarter = sram_use("pixels", "shared", {{16384, "B"}}, {256}, kOneOfEach);
  const SramUse wide = sram_use("pixels", "shared", {{4 * 16384, "B"}}, {1024}, kOneOfEach);
  CHECK(model.read_pj(wide).high == Approx(4 * model.read_pj(quarter).high));
  CHECK(model.mm2(wide).high == Approx(4 * model.mm2(quarter).high));
  // 16 KiB with two ports comes out as StreamingGS's 0.0055 mm2 a KB.
  const SramUse buffer = sram_use("buffer", "shared", {{16384, "B"}}, {128}, kOneOfEach);
  CHECK(model.mm2(buffer).middle / 16 == Approx(0.0055).epsilon(0.01));
}

TEST_CASE("cost: a short memory is a macro with rows to spare, or registers if they are smaller") {
  const SramModel model = load_technology(SGS_TECHNOLOGY).sram;
  for (const SramPorts ports : {SramPorts::kOne, SramPorts::kReadAndWrite}) {
    for (const std::uint32_t width : {16U, 128U, 512U}) {
      const auto rows = [&](std::uint64_t count) {
        return sram_use("heap", "shared", {{count, "rows"}, {width / 8, "B"}}, {width, ports},
                        kOneOfEach);
      };
      const double macro = model.mm2(rows(32)).middle;
      for (std::uint64_t count = 1; count <= 32; ++count) {
        INFO(width << " bits, " << count << " rows");
        const double as_registers =
            1e-6 * width * static_cast<double>(count) * model.um2_register.middle;
        // The rule of shape picks what this table makes the smaller.
        CHECK(rows(count).in_registers() == (as_registers < macro));
        CHECK(model.mm2(rows(count)).middle == Approx(std::min(as_registers, macro)));
        CHECK(model.leakage_mw(rows(count)).middle ==
              (rows(count).in_registers() ? 0 : model.leakage_mw(rows(32)).middle));
        CHECK(model.read_pj(rows(count)).middle == Approx(model.read_pj(rows(32)).middle));
      }
    }
  }
}

TEST_CASE("cost: memories in registers have a clock and leak as logic does") {
  FrameResult with = frame();
  add(with.machine.sram_uses, sram_use("queue", "shared", {{8, "B"}}, {64}, kOneOfEach), 3);
  with.machine.sram_accesses.push_back({"queue", 4, 5});
  const CostResult energy = energy_of(with, priced()), without = energy_of(frame(), priced());
  const double mm2 = 3 * 64 * 1e6 * 1e-6;
  CHECK(of(area_of(with, priced()), "sram").middle ==
        Approx(of(area_of(frame(), priced()), "sram").middle + mm2));
  // 5 writes of 64 bits, and two gates of each of 3 queues.
  CHECK(of(energy, "clock").middle ==
        Approx(of(without, "clock").middle + (5 * 64 * 11 + 2000 * 6 * 17) * 1e-12));
  CHECK(of(energy, "clock").high == Approx(of(without, "clock").high + 2000 * 3 * 64 * 11e-12));
  CHECK(of(energy, "logic_leakage").middle ==
        Approx(of(without, "logic_leakage").middle * (1 + mm2 / 3)));  // of 3 mm2 of parts
  CHECK(of(energy, "sram_leakage").middle == of(without, "sram_leakage").middle);
}

}  // namespace
}  // namespace sgs::test
