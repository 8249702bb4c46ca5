// Times for the tables of benchmarks.
#pragma once

#include <algorithm>
#include <chrono>
#include <vector>

namespace sgs {

// Wall time of work(), milliseconds.
template <class Work>
double time_ms(const Work& work) {
  const auto began = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - began;
  return took.count();
}

// The upper one of two middles; `times` must not be empty.
inline double median(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

}  // namespace sgs
