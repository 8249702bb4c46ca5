// From work to cycles: rules that several units share.
#pragma once

#include <cstdint>

namespace sgs {

// Cycles of `count` things of which `per_cycle` are done a cycle.
constexpr std::uint64_t cycles_for(std::uint64_t count, std::uint64_t per_cycle) {
  return (count + per_cycle - 1) / per_cycle;
}

}  // namespace sgs
