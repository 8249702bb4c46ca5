// What a test of each filter executes, beside what the paper says and what the run was charged.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "modules/hfu/hfu_config.h"

namespace sgs {

// {coarse, fine}: counts by class, multiply-accumulates and interval counted, of the paper, used.
nlohmann::ordered_json datapath_of(const HfuConfig& config, int sh_degree);

// One line for the terminal.
void print_datapath(const nlohmann::ordered_json& report);

}  // namespace sgs
