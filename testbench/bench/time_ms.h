// Wall time of a piece of work.
#pragma once

#include <chrono>

namespace sgs {

template <class Work>
double time_ms(const Work& work) {
  const auto began = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - began;
  return took.count();
}

}  // namespace sgs
