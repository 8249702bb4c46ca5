// From work to cycles and operations: rules that several units share.
#pragma once

#include <cstdint>

namespace sgs {

// Cycles of `count` things of which `per_cycle` are done a cycle.
constexpr std::uint64_t cycles_for(std::uint64_t count, std::uint64_t per_cycle) {
  return (count + per_cycle - 1) / per_cycle;
}

// Multiply-accumulates of one step of a ray through the voxel tree (three plane times), and of one
// chunk bound against a group (the multiplications of algorithm/voxel/chunk_test.cpp).
constexpr double kRayStepMacs = 6;
constexpr double kChunkTestMacs = 80;

}  // namespace sgs
