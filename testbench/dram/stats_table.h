// A memory's counts as a table with units.
#pragma once

#include "modules/dram/dram_stats.h"

namespace sgs {

void print_stats(const DramStats& stats);

}  // namespace sgs
