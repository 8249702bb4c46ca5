// A unit quaternion in three of its four words, to the bit.
//
// The largest component follows from the others: w = sqrt(1 - x^2 - y^2 - z^2) >= 1/2. Of a
// quaternion that was normalised in double and rounded to float, the three leave w^2 off by at most
// 2 (3/4) 2^-25 and the arithmetic here by 5 2^-25, so w by 5 2^-24 / (2 w) and two roundings: less
// than 16 units in the last place, which are 2^-24 for w in [1/2, 1).
#pragma once

#include <array>
#include <cstdint>

namespace sgs {

struct ShortQuaternion {
  std::array<float, 3> others;  // in their order
  std::uint8_t rest = 0;        // bits 0 and 1: which is left out; 2: its sign; 3 to 7: units + 16
};

// The first of equal ones is left out. Throws std::invalid_argument where the length is not 1.
ShortQuaternion shorten(const std::array<float, 4>& quat);
std::array<float, 4> lengthen(const ShortQuaternion& quat);

}  // namespace sgs
