// The facts that a run of `simulate` knows before its first frame.
#pragma once

#include "testbench/cost/technology.h"
#include "testbench/streaminggs/report/run_report.h"
#include "testbench/streaminggs/run/frame_run.h"
#include "testbench/streaminggs/run/prepared_scene.h"
#include "testbench/streaminggs/run/run_config.h"

namespace sgs {

// How much the terminal shows.
enum class Detail { kShort, kAll };

struct RunSetting {
  RunConfig config;  // resolved
  Technology technology;
  PreparedScene scene;
  RunOptions options;
  RunFacts facts;
  Detail detail = Detail::kShort;
};

}  // namespace sgs
