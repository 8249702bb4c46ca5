// Multiply-accumulates of a test of the filters: as the paper states them, or as counted on our
// filters.
#pragma once

#include <vector>

#include "algorithm/memory/record_split.h"
#include "modules/auto_choice.h"
#include "modules/streaminggs/hfu/hfu_config.h"

namespace sgs {

// Makes hfu.cfu_macs and hfu.ffu_macs, where they are 0, what a test costs. With hfu.cost counted
// that is what the filters execute on records of this split and SH degree
// (modules/datapath/filter_flows.h), and is said; with paper what the paper states. Throws
// InputError where they are counted and the configuration says other numbers: nothing would come of
// those.
std::vector<AutoChoice> resolve_filter_cost(HfuConfig& config, const RecordSplit& split,
                                            int sh_degree);

}  // namespace sgs
