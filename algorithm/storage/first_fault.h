// The first of many things in which something is wrong, looked for in parallel.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cstddef>
#include <optional>
#include <string>

namespace sgs {

// fault_at(i) says what is wrong with thing i of `count`, or nothing; may be called for several at
// once, and for those behind the first fault as well. Returns what it said of the lowest such i.
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
