// The lanes of the coarse and of the fine filter of one HFU, and what a test takes of them.
#pragma once

#include "modules/streaminggs/hfu/hfu_config.h"
#include "tlm/datapath.h"

namespace sgs {

Datapath coarse_datapath(const HfuConfig& config);
Datapath fine_datapath(const HfuConfig& config, int sh_degree);

}  // namespace sgs
