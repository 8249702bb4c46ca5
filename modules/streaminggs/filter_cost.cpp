// Counts of the filters as configuration and as data sheet.
#include "modules/streaminggs/filter_cost.h"

#include <fmt/format.h>

#include "algorithm/splat/filter_work.h"
#include "algorithm/splat/lane_macs.h"

namespace sgs {
namespace {

Datapath datapath(const char* name, const OperationCounts& c, std::uint32_t paper_macs,
                  std::uint32_t used_macs, std::uint32_t lanes) {
  return {name,
          {{"multiplies", c.multiplies},
           {"adds", c.adds},
           {"fused", c.fused},
           {"divisions", c.divisions},
           {"divisors", c.divisors},
           {"square_roots", c.square_roots},
           {"logarithms", c.logarithms},
           {"exponentials", c.exponentials},
           {"comparisons", c.comparisons},
           {"roundings", c.roundings}},
          folded_macs(c),
          paper_macs,
          used_macs,
          lanes};
}

}  // namespace

std::vector<AutoChoice> resolve_filter_cost(HfuConfig& hfu, CoarseBoundBy bound_by, int sh_degree) {
  if (hfu.cost == FilterCost::kPaper) return {};
  hfu.cfu_macs = folded_macs(coarse_work(bound_by, longest_case()));
  hfu.ffu_macs = folded_macs(fine_work(longest_case(), sh_degree).total());
  return {{"hfu.cfu_macs", static_cast<double>(hfu.cfu_macs),
           fmt::format("counted on the coarse filter; the paper says {}", kPaperCfuMacs)},
          {"hfu.ffu_macs", static_cast<double>(hfu.ffu_macs),
           fmt::format("counted on the fine filter at SH degree {}; the paper says {}", sh_degree,
                       kPaperFfuMacs)}};
}

void publish_filters(DataSheet& sheet, const HfuConfig& config, CoarseBoundBy bound_by,
                     int sh_degree) {
  sheet.datapath(datapath("coarse", coarse_work(bound_by, longest_case()), kPaperCfuMacs,
                          config.cfu_macs, config.cfu_lanes));
  sheet.datapath(datapath("fine", fine_work(longest_case(), sh_degree).total(), kPaperFfuMacs,
                          config.ffu_macs, config.ffu_lanes));
}

}  // namespace sgs
