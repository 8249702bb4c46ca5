// What a coarse filter knows of a Gaussian beside its centre.
#pragma once

#include <cstdint>

namespace sgs {

enum class CoarseBoundBy : std::uint8_t {
  kLargestScale,  // coarse_bound.h: the paper's
  kExtents,       // extent_bound.h
};

}  // namespace sgs
