// What a run of `simulate` knows before its first frame.
#pragma once

#include "testbench/cost/technology.h"
#include "testbench/streaminggs/frame_run.h"
#include "testbench/streaminggs/prepared_scene.h"
#include "testbench/streaminggs/run_config.h"
#include "testbench/streaminggs/run_report.h"

namespace sgs {

struct RunSetting {
  RunConfig config;  // resolved
  Technology technology;
  PreparedScene scene;
  RunOptions options;
  RunFacts facts;
};

}  // namespace sgs
