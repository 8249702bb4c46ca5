// Counts of the filters as configuration.
#include "modules/streaminggs/filter_cost.h"

#include <fmt/format.h>

#include "algorithm/files/input_error.h"
#include "modules/streaminggs/hfu/filter_datapaths.h"

namespace sgs {
namespace {

void take_count(const char* key, std::uint32_t& macs, std::uint32_t counted) {
  if (macs != 0 && macs != counted) {
    throw InputError(
        fmt::format("{}: got {} with hfu.cost counted, expected 0 or the {} that are counted, or "
                    "hfu.cost paper",
                    key, macs, counted));
  }
  macs = counted;
}

}  // namespace

std::vector<AutoChoice> resolve_filter_cost(HfuConfig& hfu, const RecordSplit& split,
                                            int sh_degree) {
  if (hfu.cost == FilterCost::kPaper) {
    if (hfu.cfu_macs == 0) hfu.cfu_macs = kPaperCfuMacs;
    if (hfu.ffu_macs == 0) hfu.ffu_macs = kPaperFfuMacs;
    return {};
  }
  take_count("hfu.cfu_macs", hfu.cfu_macs, coarse_datapath(hfu, split.bound_by, 1).counted_macs);
  take_count("hfu.ffu_macs", hfu.ffu_macs,
             fine_datapath(hfu, split.fine_record(sh_degree)).counted_macs);
  return {{ChoiceKind::kDerived, "hfu.cfu_macs", static_cast<double>(hfu.cfu_macs),
           fmt::format("counted on the coarse filter; the paper says {}", kPaperCfuMacs)},
          {ChoiceKind::kDerived, "hfu.ffu_macs", static_cast<double>(hfu.ffu_macs),
           fmt::format("counted on the fine filter at SH degree {}; the paper says {}", sh_degree,
                       kPaperFfuMacs)}};
}

}  // namespace sgs
