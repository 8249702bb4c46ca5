// Counts of the filters as configuration.
#include "modules/filter_cost.h"

#include <fmt/format.h>

#include "algorithm/splat/filter_work.h"

namespace sgs {

std::vector<AutoChoice> resolve_filter_cost(AcceleratorConfig& config, int sh_degree) {
  HfuConfig& hfu = config.hfu;
  if (hfu.cost == FilterCost::kPaper) return {};
  hfu.cfu_macs = folded_macs(coarse_work(longest_case()));
  hfu.ffu_macs = folded_macs(fine_work(longest_case(), sh_degree).total());
  return {{"hfu.cfu_macs", hfu.cfu_macs,
           fmt::format("counted on the coarse filter; the paper says {}", kPaperCfuMacs)},
          {"hfu.ffu_macs", hfu.ffu_macs,
           fmt::format("counted on the fine filter at SH degree {}; the paper says {}", sh_degree,
                       kPaperFfuMacs)}};
}

}  // namespace sgs
