// Numbers drawn evenly from an interval, for random cases.
#pragma once

#include <random>

namespace sgs::tb {

inline float uniform(std::mt19937_64& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

// Both ends are among them.
inline int whole(std::mt19937_64& random, int low, int high) {
  return std::uniform_int_distribution<int>(low, high)(random);
}

}  // namespace sgs::tb
