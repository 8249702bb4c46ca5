// Comparison of two clocks.
#include "testbench/streaminggs/run/clock_check.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "algorithm/files/input_json.h"

namespace sgs {

std::string doubt_about_clock(RunConfig& config, const Technology& technology) {
  const auto document = parse_json(to_json(config), "the configuration");
  const double clock_mhz = document.value("clock_mhz", 0.0);
  if (technology.clock_mhz == 0 || clock_mhz <= technology.clock_mhz) return "";
  return fmt::format(
      "clock_mhz {:g}: depths of pipelines, areas and energies at {} stand for {:g} MHz or less; "
      "what a faster clock needs is not counted",
      clock_mhz, technology.name, technology.clock_mhz);
}

}  // namespace sgs
