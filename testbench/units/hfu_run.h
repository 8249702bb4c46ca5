// Runs of an HFU under test, with everything around it.
#pragma once

#include <memory>

#include "modules/streaminggs/hfu/codebook_buffer.h"
#include "modules/streaminggs/hfu/hfu.h"
#include "testbench/units/case_runner.h"
#include "testbench/units/hfu_plan.h"
#include "testbench/units/unit_bench.h"

namespace sgs::tb {

// An HFU of paper order: its coarse filter feeds its fine one. codebooks: null where the scene has
// none.
std::unique_ptr<Hfu> bound_hfu(UnitBench& bench, const HfuPlan& plan, FinishedGroups& finished,
                               TimedFifo<VisitShare>& shares, const Fifos<SplatToken>& splats,
                               CodebookBuffer* codebooks);

// Simulates the plan and checks what comes out.
void run_hfu(Case& test, const BenchConfig& config, const HfuPlan& plan);

}  // namespace sgs::tb
