// The lanes of the tile-centric machine, counted by running the code and scheduled.
#pragma once

#include <cstdint>
#include <optional>

#include "modules/gscore/gscore_config.h"
#include "tlm/datapath.h"

namespace sgs::gscore {

// Datapath of the culler, an item a child of a node.
Datapath chunk_test_pipeline(const GscoreConfig& config);
// Datapaths of one CCU. convert: built for every SH degree, items of this one, as raw records are.
Datapath cull_pipeline(const GscoreConfig& config);
Datapath convert_pipeline(const GscoreConfig& config, int sh_degree);
// Datapaths of all CCUs, before the lists: they test neighbours in a row of tiles, and the parts of
// a touched tile where tiles have parts.
Datapath tile_test_pipeline(const GscoreConfig& config);
Datapath part_test_pipeline(const GscoreConfig& config);

// Datapaths of the VRUs of one core.
// conic: log2(e) into a splat's conic, and its square completed for blending in half, once a splat;
// none where a record in half holds these already (the CCU has made them).
// corner: a splat whose centre is beside a block of 16 pixels; like conic in single precision
// whatever follows.
// blend: the block, a pixel for each VRU. drain: finished pixels to the frame's format.
std::optional<Datapath> conic_pipeline(const GscoreConfig& config);
Datapath corner_pipeline(const GscoreConfig& config);
Datapath blend_pipeline(const GscoreConfig& config);
Datapath drain_pipeline(const GscoreConfig& config);

// Cycles of a turn: from the beginning of one block of pixels to that of the next.
std::uint64_t blend_interval(const GscoreConfig& config);
// Where a turn has several cycles, blends read in one of them and write in one. In another one each
// the tile before is read and cleared: its pixels lie in the same memories, of two ports. With one
// buffer nothing is drained meanwhile: one port does, in different cycles, and the lanes of
// blending convert finished pixels, in single precision.
bool shares_pixel_memories(const GscoreConfig& config);
SramPorts ports_of_pixels(const GscoreConfig& config);
bool drains_on_lanes(const GscoreConfig& config);
// Cycles from a row of so many finished pixels of a tile to the next. A row lies in four memories.
std::uint64_t drain_row_cycles(const GscoreConfig& config, std::uint32_t px);

}  // namespace sgs::gscore
