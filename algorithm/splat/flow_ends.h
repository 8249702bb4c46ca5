// Where a data flow begins and ends: vectors that come from outside, and what goes on.
#pragma once

#include <glm/vec3.hpp>
#include <initializer_list>

#include "algorithm/splat/counting.h"
#include "algorithm/splat/data_flow.h"

namespace sgs {

inline glm::vec<3, Counting> input(DataFlow& flow, const glm::vec3& v) {
  return {input(flow, v.x), input(flow, v.y), input(flow, v.z)};
}

inline void keep(DataFlow& flow, std::initializer_list<Counting> values) {
  for (const Counting& value : values) {
    if (value.flow != nullptr) flow.keep(value.node);
  }
}

}  // namespace sgs
