// What must hold of any report of the tile-centric machine.
#pragma once

#include <nlohmann/json.hpp>

namespace sgs::test {

// Of a view: what holds of any machine, bytes are counters times sizes, what one unit hands on the
// next receives, and no unit does more than its rate and the frame have time for.
void check_tile_machine(const nlohmann::json& view);

}  // namespace sgs::test
