// A unit against its clocked reference, workload by workload.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "testbench/units/case_runner.h"
#include "tests/modules/clocked/surroundings.h"

namespace sgs::test {

constexpr int kSeeds = 5;                     // of each workload
constexpr double kMostDifferencePercent = 2;  // in cycles, of one run

// What is said of a preset's machine that every unit is built with.
struct Preset {
  PixelSize group;
  MemoryPortConfig port;
};
PixelSize group_of_preset(const std::string& name);
// name: of the preset, whose machine has this configuration.
MemoryPortConfig port_of_preset(const std::string& name, MemoryPortConfig port);
template <class Config>
Preset preset_of(const std::string& name) {
  return {group_of_preset(name), port_of_preset(name, Config{}.memory_port)};
}

// What the unit hands out, simulated in a process of its own. Throws std::runtime_error where a
// check of its bench fails.
Takings takings_of_unit(std::uint64_t seed, const std::function<void(tb::Case&, Takings&)>& run);

// A configuration of which `change` has changed something.
template <class Config, class Change>
Config changed(Config config, const Change& change) {
  change(config);
  return config;
}

// Prints a line for each workload, and checks: the same things in the same order, each in the
// reference's cycle or as far from it, all together, as a workload is known for, and the last of
// them within kMostDifferencePercent of it.
class Comparison {
 public:
  explicit Comparison(std::string unit) : unit_(std::move(unit)) {}
  ~Comparison();  // a line over all workloads
  Comparison(const Comparison&) = delete;
  Comparison& operator=(const Comparison&) = delete;

  // load: with a name. run(test, taken, load, seed), reference(load, seed): what is taken.
  // known_apart: cycles, of all items and seeds.
  template <class Load, class Run, class Reference>
  void workload(const Load& load, const Run& run, const Reference& reference,
                std::uint64_t known_apart = 0) {
    compare(
        load.name,
        [&](tb::Case& test, Takings& taken, std::uint64_t seed) { run(test, taken, load, seed); },
        [&](std::uint64_t seed) { return reference(load, seed); }, known_apart);
  }

 private:
  void compare(const std::string& name,
               const std::function<void(tb::Case&, Takings&, std::uint64_t)>& run,
               const std::function<Takings(std::uint64_t)>& reference, std::uint64_t known_apart);

  const std::string unit_;
  double sum_ = 0, worst_ = 0;  // per cent
  int runs_ = 0;
};

}  // namespace sgs::test
