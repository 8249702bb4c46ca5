// Processes, per cents and the table.
#include "tests/modules/clocked/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "modules/config/strict_json.h"
#include "testbench/process/child_process.h"
#include "tlm/time_resolution.h"

namespace sgs::test {

namespace {
std::string file_of_preset(const std::string& name) {
  return SGS_SOURCE_DIR "/testbench/configs/" + name + ".json";
}
}  // namespace

PixelSize group_of_preset(const std::string& name) {
  const nlohmann::json preset = nlohmann::json::parse(std::ifstream(file_of_preset(name)));
  return {preset.at("group_width_px"), preset.at("group_height_px")};
}

MemoryPortConfig port_of_preset(const std::string& name, MemoryPortConfig port) {
  ConfigDocument preset;
  preset.add_file(file_of_preset(name));
  preset.read_section_into("memory_port", port);
  return port;
}

Takings takings_of_unit(std::uint64_t seed, const std::function<void(tb::Case&, Takings&)>& run) {
  const std::string bytes = in_child([&] {
    use_femtosecond_resolution();
    sc_core::sc_report_handler::set_actions(sc_core::SC_INFO, sc_core::SC_DO_NOTHING);
    tb::Checks checks;
    tb::Case test{checks, nullptr, std::mt19937_64(seed)};
    Takings taken;
    run(test, taken);
    if (checks.failed() > 0) throw std::runtime_error("a check of the unit's bench failed");
    return std::string(reinterpret_cast<const char*>(taken.data()), taken.size() * sizeof(Taken));
  });
  Takings taken(bytes.size() / sizeof(Taken));
  std::memcpy(taken.data(), bytes.data(), bytes.size());
  return taken;
}

void Comparison::compare(const std::string& name,
                         const std::function<void(tb::Case&, Takings&, std::uint64_t)>& run,
                         const std::function<Takings(std::uint64_t)>& reference,
                         std::uint64_t known_apart) {
  double sum = 0, worst = 0;
  std::uint64_t cycles = 0, clocked = 0, apart = 0;
  std::size_t items = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    INFO(unit_ << ", " << name << ", seed " << seed);
    const Takings unit =
        takings_of_unit(seed, [&](tb::Case& test, Takings& taken) { run(test, taken, seed); });
    const Takings expected = reference(seed);
    REQUIRE(!expected.empty());
    REQUIRE(unit.size() == expected.size());
    for (std::size_t i = 0; i < unit.size(); ++i) {
      REQUIRE(unit[i].what == expected[i].what);
      const auto [first, last] = std::minmax(unit[i].cycle, expected[i].cycle);
      apart += last - first;
    }
    const auto got = static_cast<double>(unit.back().cycle);
    const auto should = static_cast<double>(expected.back().cycle);
    const double percent = 100 * std::abs(got - should) / should;
    CHECK(percent <= kMostDifferencePercent);
    items += unit.size();
    cycles += unit.back().cycle;
    clocked += expected.back().cycle;
    sum += percent;
    worst = std::max(worst, percent);
  }
  INFO(unit_ << ", " << name);
  CHECK(apart == known_apart);
  fmt::print("{:18} {:34} {:8} {:9} {:9} {:7} {:6.2f} {:6.2f}\n", unit_, name, items, cycles,
             clocked, apart, sum / kSeeds, worst);
  sum_ += sum;
  runs_ += kSeeds;
  worst_ = std::max(worst_, worst);
}

Comparison::~Comparison() {
  fmt::print("{:18} all: {} runs, mean difference {:.2f} %, worst {:.2f} %\n", unit_, runs_,
             runs_ > 0 ? sum_ / runs_ : 0, worst_);
}

}  // namespace sgs::test
