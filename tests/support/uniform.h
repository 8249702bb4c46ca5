// A random number of an interval.
#pragma once

#include <random>

namespace sgs::test {

template <class Random>
float uniform(Random& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

}  // namespace sgs::test
