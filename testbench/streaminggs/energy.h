// Joules and square millimetres: counts times published constants.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace sgs {

class Accelerator;

// {component: joules, ..., total_j, mean_power_w}: each a count of the finished run times a
// constant of energy_constants.h; the memory's by its own currents, with the band between published
// sets.
nlohmann::ordered_json energy_of(Accelerator& accelerator);

// {component: mm2, ..., total_mm2} at 32 nm, scaled from the paper's Table 1 by lanes and bytes.
nlohmann::ordered_json area_of(const Accelerator& accelerator);

}  // namespace sgs
