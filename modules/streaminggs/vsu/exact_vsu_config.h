// Parameters of the voxel sorting unit, exact order.
#pragma once

#include <cstdint>

#include "modules/config/config_visitor.h"

namespace sgs {

struct ExactVsuConfig {
  std::uint32_t node_cache_bytes = 4096;  // in front of the chunk tree in DRAM
  std::uint32_t test_lanes = 64;          // multiply-accumulates a cycle of the chunk test
  std::uint32_t queue_entries = 512;      // of the front-to-back walk
};

void visit(ConfigVisitor& v, ExactVsuConfig& config);

// An entry of the walk's queue, on chip and in DRAM: depth, place, count.
constexpr std::uint32_t kWalkEntryBytes = 12;

}  // namespace sgs
