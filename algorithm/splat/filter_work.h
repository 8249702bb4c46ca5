// What one test of the coarse and of the fine filter executes, counted by running it.
// Values of the camera and of the group are constants: what depends on them alone is computed once
// a frame or a group and kept. Of the decoding of records only that of a quaternion is included.
#pragma once

#include <cstddef>
#include <cstdint>

#include "algorithm/scene/camera.h"
#include "algorithm/splat/coarse_bound_by.h"
#include "algorithm/splat/data_flow.h"
#include "algorithm/splat/fine_record.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/lane_steps.h"
#include "algorithm/splat/longest_path.h"
#include "algorithm/splat/operation_counts.h"
#include "algorithm/splat/rects.h"

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
FilterCase longest_case();

// Of the coarse test, up to where it fails or to its end: a bound, and whether it touches the
// group, or each of across x across parts of it.
OperationCounts coarse_work(CoarseBoundBy bound_by, const FilterCase& tested,
                            std::uint32_t across = 1);
LongestPath coarse_path(CoarseBoundBy bound_by, const FilterCase& tested, std::uint32_t across,
                        const OperationLatencies& latencies);
// With what a candidate carries on.
std::vector<LaneStep> coarse_steps(CoarseBoundBy bound_by, const FilterCase& tested,
                                   std::uint32_t across, const OperationLatencies& latencies);

// Of the fine test, up to where it fails or to its end. An operation that two parts need counts
// with the first.
struct FineWork {
  OperationCounts decode;      // the quaternion's largest component, where it is not stored
  OperationCounts geometry;    // to the screen, footprint
  OperationCounts group_test;  // visible ellipse against the group
  OperationCounts colour;      // spherical harmonics
  OperationCounts total() const;
};
FineWork fine_work(const FilterCase& tested, const FineRecord& record);
LongestPath fine_path(const FilterCase& tested, const FineRecord& record,
                      const OperationLatencies& latencies);
std::vector<LaneStep> fine_steps(const FilterCase& tested, const FineRecord& record,
                                 const OperationLatencies& latencies);

// Its graph, with where its first parts end.
struct FineFlow {
  DataFlow flow;
  std::size_t decoded = 0, geometry_end = 0, test_end = 0;
};
FineFlow fine_flow(const FilterCase& tested, const FineRecord& record);

}  // namespace sgs
