// Every record of a memory image decoded, and refused where it could not have been encoded.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cstddef>
#include <optional>
#include <string>

#include "algorithm/memory/scene_layout.h"
#include "algorithm/splat/gaussian.h"

namespace sgs {

// The stored Gaussians as the units decode them, by slot. source: what errors name. Throws
// InputError for a codebook or record that the units must not be given: an index beyond its
// codebook, a scale beyond the largest one, a rotation that is none, an opacity outside [0, 1], a
// value that is not finite.
ActivatedCloud decode_image(const MemoryImage& image, const std::string& source);

// Looks in parallel for the first of many things in which something is wrong. fault_at(i) says what
// is wrong with thing i of `count`, or nothing; may be called for several at once, and for those
// behind the first fault as well. Returns what it said of the lowest such i.
template <class FaultAt>
std::optional<std::string> first_fault(std::size_t count, const FaultAt& fault_at) {
  using Fault = std::optional<std::string>;
  constexpr std::size_t kGrain = 4096;
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count, kGrain), Fault{},
      [&](const auto& range, Fault found) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          Fault fault = fault_at(i);
          if (fault && !found) found = std::move(fault);
        }
        return found;
      },
      [](Fault left, Fault right) { return left ? left : right; });
}

}  // namespace sgs
