// A run of a rendering unit under test: its splats, and what must come of them.
#pragma once

#include <cstdint>
#include <vector>

#include "modules/streaminggs/rendering/rendering_unit.h"
#include "testbench/units/case_runner.h"
#include "testbench/units/unit_bench.h"

namespace sgs::tb {

// The inputs of a run: a configuration, a frame and the splats of each visit.
struct RenderingPlan {
  RenderingConfig config;
  StreamingJob job;
  PixelSize group;
  std::uint32_t inputs = 2;
  Arrival arrival = Arrival::kByVisit;
  std::uint32_t input_entries = 8;
  std::vector<std::vector<std::vector<Splat>>> groups;  // [group][visit] front to back
};

// Simulates the plan and checks the picture, bytes and accesses.
void run_plan(Case& test, const BenchConfig& bench_config, const RenderingPlan& plan);

}  // namespace sgs::tb
