// Counts of the filters, run once.
#include "modules/streaminggs/hfu/filter_datapaths.h"

#include "algorithm/splat/filter_work.h"
#include "modules/streaminggs/counted_datapath.h"

namespace sgs {

Datapath coarse_datapath(const HfuConfig& config, CoarseBoundBy bound_by) {
  Datapath path = counted_datapath("coarse", "coarse", coarse_work(bound_by, longest_case()));
  path.lanes = config.cfu_lanes;
  path.copies = config.cfus;
  path.used_macs = config.cfu_macs;
  path.published_macs = kPaperCfuMacs;
  return path;
}

Datapath fine_datapath(const HfuConfig& config, int sh_degree) {
  Datapath path = counted_datapath("fine", "fine", fine_work(longest_case(), sh_degree).total());
  path.lanes = config.ffu_lanes;
  path.used_macs = config.ffu_macs;
  path.published_macs = kPaperFfuMacs;
  return path;
}

}  // namespace sgs
