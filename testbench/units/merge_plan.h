// The inputs of a merge unit under test: the visits of some groups, and the order in which their
// keys must come out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "modules/streaminggs/merge/merge_config.h"
#include "modules/streaminggs/messages.h"
#include "modules/streaminggs/streaming_job.h"

namespace sgs::tb {

struct MergeKey {
  float depth;
  std::uint32_t slot;
};

struct MergeVisit {
  std::vector<MergeKey> keys;  // by depth, then slot, as a sorting unit hands them on
  float release_below =
      std::numeric_limits<float>::infinity();  // no key of a later visit is nearer
};

struct MergeGroup {
  std::vector<MergeVisit> visits;
  std::uint64_t saturates_after = ~std::uint64_t{0};  // released keys
};

struct MergePlan {
  MergeConfig config;
  std::uint32_t sorters = 2, hfus = 4;
  std::uint32_t input_entries = 16, output_entries = 4;
  std::uint32_t feedback_cycles = 1;
  std::uint32_t slots = 0;  // slots of the scene, for which the spill area is sized
  std::vector<MergeGroup> groups;
};

// Most keys in a visit.
std::uint32_t longest_visit(const MergePlan& plan);

// Visits of up to `chunk` neighbouring slots each. depths: how many different ones, so that ties
// lie within visits and across them; a visit's nearest key may be as near as the visit before
// allowed, and no nearer. Some visits have no key, some slots are left out.
MergeGroup random_group(std::mt19937_64& random, const MergePlan& plan, std::uint32_t chunk,
                        std::uint32_t depths);

// One visit of n keys, in slots 0 to n - 1: all at one depth, or each behind the one before.
MergeGroup one_visit(std::uint32_t n, bool tied);

// A frame whose groups are the plan's, with a spill region.
StreamingJob merge_job(const MergePlan& plan);

FineCandidate candidate(std::uint32_t group, std::uint32_t visit, const MergeKey& key);

// Keys in the order of release. Exact: all by (depth, slot). blend_early: what the renderer of
// algorithm/ does, in words: after a visit what is final goes, then the nearest until the rest
// fits.
std::vector<MergeKey> expected_order(const MergePlan& plan, const MergeGroup& group);

}  // namespace sgs::tb
