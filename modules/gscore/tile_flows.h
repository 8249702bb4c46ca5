// What projecting a Gaussian for lists of tiles executes, and testing a tile, recorded by running
// it. Values of the camera are constants, as in modules/datapath/filter_flows.h.
#pragma once

#include "algorithm/splat/tile_boxes.h"
#include "modules/datapath/lane_steps.h"

namespace sgs::gscore {

// What drops a Gaussian that cannot touch the frame, of one that may.
FlowPart cull_flow();

// From a record to the screen, boxes, colour; with half_records rounded to what its record and key
// hold. Of the longest way: a Gaussian whose box along its axes is asked.
FlowPart convert_flow(const TileRules& rules, int sh_degree, bool half_records);

// Of so many neighbours in a row of tiles, and where the next ones are, by a box along the
// ellipse's axes: the tester is the same where a Gaussian, or the machine, has none. What parts are
// tested by does not go along: it is read by the Gaussian's number.
FlowPart tile_test_flow(int tiles_at_once);

// Of the parts of one tile, two or four in a row, all of which are touched.
FlowPart part_test_flow(const TileRules& rules);

}  // namespace sgs::gscore
