// What a test of the filters costs: by the paper, or as counted on our filters.
#pragma once

#include <vector>

#include "algorithm/splat/coarse_bound_by.h"
#include "modules/auto_choice.h"
#include "modules/streaminggs/hfu/hfu_config.h"

namespace sgs {

// With hfu.cost counted, replaces hfu.cfu_macs and hfu.ffu_macs by what the filters execute on a
// scene of this SH degree (algorithm/splat/filter_work.h), and says so; with paper does nothing.
std::vector<AutoChoice> resolve_filter_cost(HfuConfig& config, CoarseBoundBy bound_by,
                                            int sh_degree);

}  // namespace sgs
