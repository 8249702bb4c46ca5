// The table of a memory's counts says what the counts are.
#include "testbench/dram/stats_table.h"

#include <catch2/catch.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace sgs {
namespace {

// Both rails of a part, in microjoules, are told apart from either and from other parts.
EnergyParts rail(double uj) {
  EnergyParts parts;
  double* const of[] = {
      &parts.activate_pj,   &parts.read_pj,           &parts.write_pj,
      &parts.refresh_pj,    &parts.active_standby_pj, &parts.precharged_standby_pj,
      &parts.power_down_pj, &parts.self_refresh_pj,   &parts.io_pj};
  double times = 1e6;
  for (double* part : of) {
    *part = uj * times;
    times *= 2;
  }
  return parts;
}

// Value and unit of the line of this name, which is padded to 24 columns.
std::string line(const std::string& table, const std::string& name) {
  std::istringstream lines(table);
  for (std::string text; std::getline(lines, text);) {
    if (text.substr(0, text.find_last_not_of(' ', 23) + 1) != name) continue;
    const std::size_t value = text.find_first_not_of(' ', 24);
    return text.substr(value);
  }
  return "no such line";
}

TEST_CASE("table of counts: energies are of both rails, each bus has its share of the time") {
  DramStats stats;
  stats.clock_period_ns = 2;
  stats.elapsed_cycles = 1000;
  stats.channels.resize(2);
  stats.channels[0].busy_cycles = 250;
  stats.channels[1].busy_cycles = 500;
  stats.energy.vdd1 = rail(1);
  stats.energy.vdd2 = rail(100);
  stats.energy.by_current_set_pj["least"] = 7e6;
  const std::string table = stats_table(stats);
  INFO(table);
  const std::vector<std::pair<const char*, const char*>> wanted = {
      {"time", "1000  clock cycles"},
      {"data bus 0 busy", "25.0  % of time"},
      {"data bus 1 busy", "50.0  % of time"},
      {"energy", "51611.000  uJ"},
      {"  activate, precharge", "101.000  uJ"},
      {"  read", "202.000  uJ"},
      {"  write", "404.000  uJ"},
      {"  refresh", "808.000  uJ"},
      {"  active standby", "1616.000  uJ"},
      {"  precharged standby", "3232.000  uJ"},
      {"  power-down", "6464.000  uJ"},
      {"  self-refresh", "12928.000  uJ"},
      {"  I/O (stated adder)", "25856.000  uJ"},
      {"energy by least", "7.000  uJ"}};
  for (const auto& [name, value] : wanted) {
    INFO(name);
    CHECK(line(table, name) == value);
  }
  stats.energy.not_stated = "idd6";
  CHECK(line(stats_table(stats), "energy") == "not known: the memspec does not state idd6");
  CHECK(line(stats_table(stats), "  read") == "no such line");
}

}  // namespace
}  // namespace sgs
