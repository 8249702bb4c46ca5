// Operations of projecting a Gaussian for lists of tiles and of testing a tile, recorded by running
// them. Values of the camera are constants, as in modules/datapath/filter_flows.h.
#pragma once

#include "algorithm/memory/record_split.h"
#include "algorithm/splat/tile_boxes.h"
#include "modules/datapath/lane_steps.h"

namespace sgs::gscore {

// Operations that drop a Gaussian that cannot touch the frame, counted for one that may; of two
// eyes the frame of either.
FlowPart cull_flow(std::uint32_t eyes = 1);

// From a stored record to the screen, boxes, colour; with half_records rounded to the formats of
// its projected record and key. Counts the longest way: a Gaussian whose box along its axes is
// asked. Of two eyes for both: what they compute alike is computed once.
FlowPart convert_flow(const TileRules& rules, const FineRecord& stored, bool half_records,
                      std::uint32_t eyes = 1);

// Tests so many neighbours in a row of tiles, and finds the next ones, by a box along the ellipse's
// axes. The tester is the same where a Gaussian, or the machine, has no such box. Numbers for the
// test of parts do not go along: they are read by the Gaussian's number.
FlowPart tile_test_flow(int tiles_at_once);

// Tests the parts of one tile, two or four in a row, all of which are touched.
FlowPart part_test_flow(const TileRules& rules);

}  // namespace sgs::gscore
