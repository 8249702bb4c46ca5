// Simulates it in this process; looks values up.
#include "tests/testbench/ledger/simulated_frame.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>

#include "modules/machines.h"
#include "testbench/builtin/open_scene.h"
#include "testbench/command_line/config_source.h"
#include "testbench/result/ledger.h"

namespace sgs::test {

Frame simulated(const std::string& preset, const Settings& settings, const std::string& source) {
  Frame frame;
  frame.config = read_run_config(ConfigSource{preset, settings}.document(), machine_kinds());
  frame.config.storage.vq.iterations = 1;
  resolve(frame.config);
  Scene scene = open_scene(source);
  Camera camera = scaled_to(scene.cameras.front(), 72, 48);
  const bool two_eyes = std::find(settings.begin(), settings.end(), "eyes=2") != settings.end();
  if (two_eyes) camera.eyes_apart = 0.1;
  frame.scene.emplace(prepare(std::move(scene), frame.config, {camera}));
  frame.job = frame.config.design->job(frame.scene->stored, camera);
  frame.result =
      run_frame(*frame.config.design, frame.job, frame.scene->stored.image, frame.config.dram, {});
  return frame;
}

void check_paid(const Frame& frame) {
  for (const std::string& fault : ledger_faults(frame.result.machine, frame.result.cycles)) {
    FAIL_CHECK(fault);
  }
}

std::uint64_t items(const Frame& frame, const std::string& datapath) {
  for (const auto& [d, count, busiest] : frame.result.machine.datapaths) {
    if (d.name == datapath) return count;
  }
  FAIL("no datapath " << datapath);
  return 0;
}

SramAccesses accesses(const Frame& frame, const std::string& use) {
  for (const SramAccesses& a : frame.result.machine.sram_accesses) {
    if (a.use == use) return a;
  }
  FAIL("no accesses of " << use);
  return {};
}

std::uint64_t counter(const Frame& frame, const std::string& name) {
  std::uint64_t sum = 0;
  for (const UnitResult& unit : frame.result.machine.units) {
    for (const CounterResult& c : unit.counters) sum += c.name == name ? c.value : 0;
  }
  return sum;
}

}  // namespace sgs::test
