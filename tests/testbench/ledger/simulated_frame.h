// A frame of a machine for tests of its ledger, and what the data sheets say of it by name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "testbench/streaminggs/run/frame_run.h"
#include "testbench/streaminggs/run/prepared_scene.h"

namespace sgs::test {

using Settings = std::vector<std::string>;

// A frame of a machine, and the scene that it was given.
struct Frame {
  RunConfig config;
  std::optional<PreparedScene> scene;
  FrameJob job;
  FrameResult result;
};

// 72 x 48 px of the scene's first camera, or of two eyes where the settings have eyes=2.
Frame simulated(const std::string& preset, const Settings& settings, const std::string& source);

// The ledger has no fault.
void check_paid(const Frame& frame);

// What is not there fails the test; counters are added up over the units.
std::uint64_t items(const Frame& frame, const std::string& datapath);
SramAccesses accesses(const Frame& frame, const std::string& use);
std::uint64_t counter(const Frame& frame, const std::string& name);

}  // namespace sgs::test
