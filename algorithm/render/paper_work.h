// What paper order does for a frame, visit by visit: all that the time of a machine follows from
// beside its own configuration and the voxels' order. Counted by the streaming renderer
// (paper_renderer.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/render/blend_record.h"

namespace sgs {

// A Gaussian that passes the coarse filter, for one part of the group or more.
struct CandidateWork {
  std::uint32_t slot = 0;
  std::uint32_t first_splat = 0;  // place of its splats in the group's list of them
  std::uint16_t parts = 0;        // that it may touch, a bit each
  std::uint16_t splats = 0;       // of these, in which it is a splat
};

// A voxel or a piece of one, in the order of the visits.
struct PieceWork {
  std::uint32_t first = 0, count = 0;  // storage slots
  std::uint32_t candidates = 0;        // of the group, up to the end of this visit's
};

struct PaperGroupWork {
  // Behind those that the picture needs come some that a machine may have begun before it knows
  // that the group is finished.
  std::vector<PieceWork> visits;
  std::vector<CandidateWork> candidates;  // by visit, then slot
  // [candidate, part] places in that part's `blends`; of the splats of a visit these are in order.
  std::vector<std::uint32_t> splats;
  std::vector<BlendRecord> blends;          // [part]
  std::vector<std::uint64_t> contributors;  // [part] (splat, pixel) blends
};

struct PaperWork {
  std::vector<PaperGroupWork> groups;  // row by row

  std::size_t size_bytes() const {
    std::size_t sum = 0;
    for (const PaperGroupWork& group : groups) {
      sum += group.visits.capacity() * sizeof(PieceWork) +
             group.candidates.capacity() * sizeof(CandidateWork) +
             group.splats.capacity() * sizeof(std::uint32_t);
      for (const BlendRecord& blends : group.blends) sum += blends.size_bytes();
    }
    return sum;
  }
};

}  // namespace sgs
