// Division of the on-chip memory, where the configuration leaves it open: between parts sized by
// the frame's tiles and parts sized by the length of their lists.
#pragma once

#include <cstdint>
#include <vector>

#include "modules/auto_choice.h"
#include "modules/gscore/gscore_config.h"

namespace sgs::gscore {

// Whether any of the keys that choose_list_memory() fills in is left open.
bool lists_open(const GscoreConfig& config);

// Fills in `lists.tiles`, `lists.lines` and `sorting.list_entries` where they are 0, and says why.
// First as few passes over the scene as leave a pass's tiles enough lines to combine their entries
// in. Then as many lines, up to one a tile; then lists on chip as long as the rest allows. In a
// memory without a limit of its own: one pass and a line a tile. A choice that fits in no case
// stays so, for the sum to show. tiles: of the largest frame that is going to be drawn.
void choose_list_memory(GscoreConfig& config, std::uint32_t tiles, std::vector<AutoChoice>& chosen);

}  // namespace sgs::gscore
