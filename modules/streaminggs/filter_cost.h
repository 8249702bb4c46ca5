// Multiply-accumulates of a test of the filters: as the paper states them, or as counted on our
// filters.
#pragma once

#include <vector>

#include "algorithm/memory/record_split.h"
#include "modules/auto_choice.h"
#include "modules/streaminggs/hfu/hfu_config.h"

namespace sgs {

// Fills in hfu.cfu_macs and hfu.ffu_macs where they are 0. With hfu.cost paper they become the
// numbers that the paper states. With counted they become the operations that the filters execute
// on records of this split and SH degree (modules/datapath/filter_flows.h), and the choice is
// returned. Throws InputError where they are counted and the configuration gives other numbers:
// those would have no effect.
std::vector<AutoChoice> resolve_filter_cost(HfuConfig& config, const RecordSplit& split,
                                            int sh_degree);

}  // namespace sgs
