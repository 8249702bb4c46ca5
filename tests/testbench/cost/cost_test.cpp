// Joules and square millimetres: every kind of work and of part at its own price.
#include "testbench/cost/cost.h"

#include <catch2/catch.hpp>
#include <map>
#include <string>

#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

// Prices that no two sums have in common.
Technology priced() {
  Technology technology;
  technology.name = "test";
  technology.operations = {{"read_bit", {2, ""}}, {"write_bit", {300, ""}}, {"mac", {5000, ""}}};
  technology.parts = {{"lane", {0.25, 0, ""}}, {"kib", {0.01, 7, ""}}};
  return technology;
}

double of(const CostResult& cost, const std::string& component) {
  for (const auto& [name, amount] : cost.by_component) {
    if (name == component) return amount;
  }
  FAIL("no component " << component);
  return 0;
}

TEST_CASE("cost: each kind of work at its own price, summed by component") {
  FrameResult frame;
  frame.cycles = 2000;
  frame.clock_mhz = 1000;  // 2 us
  frame.machine.operations = {{"buffers", "read_bit", 10},
                              {"filter", "mac", 3},
                              {"buffers", "write_bit", 4},
                              {"idle", "mac", 0}};
  frame.machine.parts = {{"filter", "lane", 8}, {"sram", "kib", 100}};
  frame.memory.energy_j = 1e-6;
  const CostResult energy = energy_of(frame, priced());
  CHECK(of(energy, "buffers") == Approx((10 * 2 + 4 * 300) * 1e-12));
  CHECK(of(energy, "filter") == Approx(3 * 5000e-12));
  CHECK(of(energy, "idle") == 0);
  CHECK(of(energy, "sram_leakage") == Approx(100 * 7e-3 * 2e-6));
  CHECK(of(energy, "dram") == 1e-6);
  CHECK(energy.by_component.size() == 5);  // what does not leak has no line for it
  CHECK(energy.total == Approx((20 + 1200 + 15000) * 1e-12 + 100 * 7e-3 * 2e-6 + 1e-6));

  const CostResult area = area_of(frame.machine, priced());
  CHECK(of(area, "filter") == Approx(2));
  CHECK(of(area, "sram") == Approx(1));
  CHECK(area.total == Approx(3));
}

TEST_CASE("cost: leakage lasts as long as the frame") {
  FrameResult frame;
  frame.clock_mhz = 500;
  frame.cycles = 1000;
  frame.machine.parts = {{"sram", "kib", 1}};
  const double once = energy_of(frame, priced()).total;
  frame.cycles = 3000;
  CHECK(energy_of(frame, priced()).total == Approx(3 * once));
  CHECK(once == Approx(7e-3 * 2e-6));
}

TEST_CASE("cost: work and parts that the table does not have are refused by name") {
  FrameResult frame;
  frame.machine.operations = {{"filter", "divide", 1}};
  CHECK(input_error_of([&] { energy_of(frame, priced()); }).find("divide") != std::string::npos);
  frame.machine.parts = {{"filter", "divider", 1}};
  CHECK(input_error_of([&] { area_of(frame.machine, priced()); }).find("divider") !=
        std::string::npos);
}

TEST_CASE("cost: the shipped table says of each memory what its sources say") {
  const Technology technology = load_technology(SGS_TECHNOLOGY);
  // A write takes 1.1 of a read; the larger the array, the more a bit.
  double smaller = 0;
  for (const std::string size : {"small", "middle", "large"}) {
    INFO(size);
    const double read = technology.operation("sram_" + size + "_read_bit").pj;
    CHECK(technology.operation("sram_" + size + "_write_bit").pj == Approx(1.1 * read));
    CHECK(read > smaller);
    smaller = read;
  }
  CHECK(technology.operation("fp32_mac").pj == Approx(0.65 * (0.9 + 3.7)));
  CHECK(technology.operation("compare_exchange").pj == Approx(13.7 / 8 * 0.65 / 0.55));
  CHECK(technology.operation("pixel_blend").pj == Approx(250.0 / 64 * 0.65 / 0.55));
  CHECK(technology.part("mac_lane").mm2 == Approx(0.79 / 128));
  CHECK(technology.part("pixel_lane").mm2 == Approx(2.53 / 64));
  CHECK(technology.part("sorting_unit").mm2 == Approx(0.042 / 2));
}

}  // namespace
}  // namespace sgs::test
