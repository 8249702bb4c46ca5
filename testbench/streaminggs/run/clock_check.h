// Whether costs and depths of pipelines stand for the clock.
#pragma once

#include <string>

#include "testbench/cost/technology.h"
#include "testbench/streaminggs/run/run_config.h"

namespace sgs {

// A line that doubts results above the technology's clock; empty elsewhere, and where the table
// tells none.
std::string doubt_about_clock(RunConfig& config, const Technology& technology);

}  // namespace sgs
