// What a frame did not need and therefore did not cost.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "testbench/streaminggs/report.h"

namespace sgs {

// [{what, why, count, saves}]; measured: the sections of measurements.h.
nlohmann::ordered_json left_out(const ViewFacts& facts, const AcceleratorConfig& config,
                                const nlohmann::ordered_json& measured);

}  // namespace sgs
