// The bytes of one Gaussian in the modelled DRAM, in the two halves of StreamingGS: first half, and
// second half as it is: little-endian 32-bit floats, nothing stored twice, nothing rounded. (Other
// encodings: second_half.h.)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "algorithm/splat/gaussian.h"

namespace sgs {

constexpr std::uint32_t kFirstHalfBytes = 16;
constexpr std::uint32_t kMaxSecondHalfBytes = 220;  // raw: 55 words at degree 3

// x, y, z, largest scale.
struct FirstHalf {
  glm::vec3 mean;
  float scale_max;
};

// A Gaussian as the fine filter knows it once both halves are there; sh: the coefficients of its
// degree.
struct DecodedGaussian {
  Gaussian<float> gaussian;
  glm::vec3 sh[16];
};

// Raw second half: the two other scales in their order, quaternion (w, x, y, z), opacity, SH
// coefficients (rgb, (degree+1)^2 of them). The axis of the largest scale is in the sign bits of
// the two scales, which are never negative: bit 0 in the first, bit 1 in the second.
constexpr std::uint32_t raw_second_half_bytes(int sh_degree) {
  return 4U * (2 + 4 + 1 + 3 * static_cast<std::uint32_t>((sh_degree + 1) * (sh_degree + 1)));
}

// The first of equal ones.
int largest_axis(const glm::vec3& scale);

void encode_first_half(const Gaussian<float>& g, std::byte* out);
FirstHalf decode_first_half(const std::byte* bytes);

// sh: [(degree+1)^2]; out: raw_second_half_bytes(degree).
void encode_raw_second_half(const Gaussian<float>& g, const glm::vec3* sh, int sh_degree,
                            std::byte* out);
// Gives back the very bits that were encoded.
DecodedGaussian decode_raw_second_half(const FirstHalf& first, const std::byte* bytes,
                                       int sh_degree);

// A unit quaternion in three of its four words, to the bit.
//
// The largest component follows from the others: w = sqrt(1 - x^2 - y^2 - z^2) >= 1/2. Of a
// quaternion that was normalised in double and rounded to float, the three leave w^2 off by at most
// 2 (3/4) 2^-25 and the arithmetic here by 5 2^-25, so w by 5 2^-24 / (2 w) and two roundings: less
// than 16 units in the last place, which are 2^-24 for w in [1/2, 1).
struct ShortQuaternion {
  std::array<float, 3> others;  // in their order
  std::uint8_t rest = 0;        // bits 0 and 1: which is left out; 2: its sign; 3 to 7: units + 16
};

// The first of equal ones is left out. Throws std::invalid_argument where the length is not 1.
ShortQuaternion shorten(const std::array<float, 4>& quat);
std::array<float, 4> lengthen(const ShortQuaternion& quat);

}  // namespace sgs
