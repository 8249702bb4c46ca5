// The lanes of the tile-centric machine, counted by running the code and scheduled.
#pragma once

#include <optional>

#include "modules/gscore/gscore_config.h"
#include "tlm/datapath.h"

namespace sgs::gscore {

// Of one CCU. convert: built for every SH degree, items of this one.
Datapath cull_pipeline(const GscoreConfig& config);
Datapath convert_pipeline(const GscoreConfig& config, int sh_degree);
// Of all CCUs, before the lists: neighbours in a row of tiles; the parts of one that is touched,
// where tiles have parts.
Datapath tile_test_pipeline(const GscoreConfig& config);
Datapath part_test_pipeline(const GscoreConfig& config);

// Of the VRUs of one core: log2(e) into a splat's conic, and its square completed for blending in
// half, once a splat, none where the record in half holds what blending in half takes (the CCU has
// made it); where its centre is beside a block of 16 pixels; both in single precision whatever
// follows; the block, a pixel for each VRU; finished pixels to the frame's format.
std::optional<Datapath> conic_pipeline(const GscoreConfig& config);
Datapath corner_pipeline(const GscoreConfig& config);
Datapath blend_pipeline(const GscoreConfig& config);
Datapath drain_pipeline(const GscoreConfig& config);

}  // namespace sgs::gscore
