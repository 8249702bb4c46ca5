// A memory's counts as a table with units.
#pragma once

#include <string>

#include "modules/dram/dram_stats.h"

namespace sgs {

std::string stats_table(const DramStats& stats);

}  // namespace sgs
