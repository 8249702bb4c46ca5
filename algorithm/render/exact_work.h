// What exact order does for a frame, visit by visit: all that the time of a machine follows from
// beside its own configuration. Counted by the streaming renderer (exact_renderer.h).
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/order/walk_queue.h"
#include "algorithm/render/blend_record.h"

namespace sgs {

// A node of the chunk tree, in the order in which the walk opens them.
struct NodeWork {
  static constexpr std::uint32_t kRoot = UINT32_MAX;
  std::uint32_t at = 0;            // in the table
  std::uint32_t parent = kRoot;    // its place in this order
  std::uint32_t chunks_known = 0;  // chunks that have come into their queue when it is open
  std::uint8_t children = 0;       // tested
  std::uint8_t entered = 0;        // of these, into the queues
  GroupReach reach{};
};

// A chunk, in the order in which the walk gives them.
struct VisitWork {
  std::uint32_t first = 0, count = 0;  // storage slots
  float nearest = 0;                   // nothing behind it is nearer
  std::uint32_t nodes = 0;             // that are open when it comes out
  std::uint32_t keys = 0;              // up to the end of this visit's
  GroupReach reach{};
};

// A Gaussian that passed the coarse filter.
struct KeyWork {
  static constexpr std::uint32_t kNoSplat = UINT32_MAX;
  float depth = 0;
  std::uint32_t slot = 0;
  std::uint32_t splat = kNoSplat;  // of the group's BlendRecord; none: it touches nothing, or what
                                   // it reaches was finished
  GroupReach reach{};
};

struct ExactGroupWork {
  std::vector<NodeWork> nodes;
  // Behind those that the picture needs come some that a machine may have begun before it knows
  // that the group is finished.
  std::vector<VisitWork> visits;
  std::vector<KeyWork> keys;  // by visit, then slot
  BlendRecord blends;
};

struct ExactWork {
  std::vector<ExactGroupWork> groups;                   // row by row
  HeapWork node_queue, chunk_queue;                     // of the walks, with room for everything
  std::size_t node_queue_max = 0, chunk_queue_max = 0;  // entries
  std::uint64_t contributors = 0;                       // (splat, pixel) blends
};

}  // namespace sgs
