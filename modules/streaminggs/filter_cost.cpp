// Counts of the filters as configuration.
#include "modules/streaminggs/filter_cost.h"

#include <fmt/format.h>

#include "modules/streaminggs/hfu/filter_datapaths.h"

namespace sgs {
std::vector<AutoChoice> resolve_filter_cost(HfuConfig& hfu, CoarseBoundBy bound_by, int sh_degree) {
  if (hfu.cost == FilterCost::kPaper) return {};
  hfu.cfu_macs = coarse_datapath(hfu, bound_by, 1).counted_macs;
  hfu.ffu_macs = fine_datapath(hfu, sh_degree).counted_macs;
  return {{"hfu.cfu_macs", static_cast<double>(hfu.cfu_macs),
           fmt::format("counted on the coarse filter; the paper says {}", kPaperCfuMacs)},
          {"hfu.ffu_macs", static_cast<double>(hfu.ffu_macs),
           fmt::format("counted on the fine filter at SH degree {}; the paper says {}", sh_degree,
                       kPaperFfuMacs)}};
}

}  // namespace sgs
