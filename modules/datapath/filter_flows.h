// Operations of one test of the coarse and of the fine filter, recorded by running it. Values of
// the camera and of the group are constants: results that depend on them alone are computed once a
// frame or a group and kept. The decoding of records is left out, but for that of a quaternion.
#pragma once

#include <array>
#include <cstdint>

#include "algorithm/memory/record_split.h"
#include "algorithm/scene/camera.h"
#include "algorithm/splat/counting.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/rects.h"
#include "modules/datapath/lane_steps.h"

namespace sgs {

// A Gaussian, and the view and group it is tested against.
struct FilterCase {
  Camera camera;
  Gaussian<float> gaussian;
  PixelRect group;
};

// A case that passes every test of both filters and takes the longest way: its centre lies off a
// corner of the group, so that two edges are to be looked at. A unit that starts a test at fixed
// intervals has to be built for this.
// eyes: 2 for the left one of two.
FilterCase longest_case(std::uint32_t eyes = 1);

// Operations of the coarse test, up to where it fails or to its end: a bound, and whether it
// touches the group, or each of across x across parts of it; with the values that a candidate
// carries on. Of two eyes, for each: what both compute alike is computed once.
FlowPart coarse_flow(CoarseBoundBy bound_by, const FilterCase& tested, std::uint32_t across = 1);

// Operations of the fine test, up to where it fails or to its end. An operation that two parts need
// counts with the first. Of two eyes those of the right one, which takes more.
struct FineFlow {
  FlowPart all;
  FlowPart decode;      // the quaternion's largest component, where it is not stored
  FlowPart geometry;    // to the screen, footprint
  FlowPart group_test;  // visible ellipse against the group
  FlowPart colour;      // spherical harmonics
};
FineFlow fine_flow(const FilterCase& tested, const FineRecord& record);

// The largest component of a quaternion that is stored without it, from the other three.
void restore_largest(DataFlow& flow, std::array<Counting, 4>& quat);

// Rounding of a splat behind the fine filter to the halves of its entry (splat_record.h): the
// conic's square completed, in units of its own.
FlowPart rounding_flow();

}  // namespace sgs
