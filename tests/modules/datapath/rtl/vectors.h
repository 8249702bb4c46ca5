// Numbers that modules in Verilog are tested with: their bits, and how many cases there are.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <random>

namespace sgs::test {

constexpr std::size_t kCases = 100'000;
constexpr std::uint64_t kNightlySeeds = 100;  // so many times the cases of each test

inline std::uint32_t bits_of(float x) { return __builtin_bit_cast(std::uint32_t, x); }
inline float float_of(std::uint32_t bits) { return __builtin_bit_cast(float, bits); }

// A half's 16 bits, and the float that holds it. NaN: the quiet one.
inline std::uint16_t half_bits_of(float half) {
  if (std::isnan(half)) return 0x7E00;
  const std::uint32_t sign = std::signbit(half) ? 0x8000 : 0;
  const float magnitude = std::abs(half);
  if (std::isinf(half)) return static_cast<std::uint16_t>(sign | 0x7C00);
  if (magnitude < 0x1p-14F) {
    return static_cast<std::uint16_t>(sign | static_cast<std::uint32_t>(magnitude * 0x1p24F));
  }
  return static_cast<std::uint16_t>(sign | ((bits_of(magnitude) >> 13) - ((127 - 15) << 10)));
}
inline float half_of(std::uint16_t bits) {
  const int field = (bits >> 10) & 31, fraction = bits & 1023;
  const float magnitude = field == 31 ? (fraction != 0 ? NAN : INFINITY)
                          : field == 0
                              ? std::ldexp(static_cast<float>(fraction), -24)
                              : std::ldexp(static_cast<float>(1024 + fraction), field - 25);
  return std::copysign(magnitude, (bits & 0x8000) != 0 ? -1.0F : 1.0F);
}

// Every NaN is one.
inline bool same_number(float a, float b) {
  return bits_of(a) == bits_of(b) || (std::isnan(a) && std::isnan(b));
}

// Zeros, infinities, none, the ends of the subnormal and of the normal numbers, neighbours of 1.
constexpr std::array<std::uint32_t, 14> kMagnitudes = {
    0,          1,          2,          0x7FFFFF,   0x800000,   0x800001,   0x3F000000,
    0x3F7FFFFF, 0x3F800000, 0x3F800001, 0x7F000000, 0x7F7FFFFF, 0x7F800000, 0x7FC00000};

// check(cases, seed) of all seeds that a nightly test has.
template <class Check>
void with_nightly_seeds(const Check& check) {
  for (std::uint64_t seed = 1; seed <= kNightlySeeds; ++seed) check(kCases, seed);
}

class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : random_(seed) {}

  std::uint64_t bits() { return random_(); }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }
  bool one_in(std::size_t n) { return below(n) == 0; }

  // Any bits, a special one, a subnormal one, few digits, or an exponent not far from 0.
  float any() {
    const auto random = static_cast<std::uint32_t>(random_());
    switch (below(8)) {
      case 0:
        return float_of(random);
      case 1:
        return float_of((random & 0x80000000U) | kMagnitudes[below(kMagnitudes.size())]);
      case 2:
        return float_of(random & 0x80FFFFFFU);
      case 3: {
        const std::size_t without = below(23);
        return float_of(random >> without << without);
      }
      default:
        return normal(-30, 30);
    }
  }
  // Of either sign, 2^least to 2^(most + 1).
  float normal(int least, int most) {
    const auto random = static_cast<std::uint32_t>(random_());
    const int power = least + static_cast<int>(below(static_cast<std::size_t>(most - least + 1)));
    return float_of((random & 0x807FFFFFU) | static_cast<std::uint32_t>(power + 127) << 23);
  }
  // Such that a product nearly cancels it: a few last places off, or some powers of two.
  float beside(float negated) {
    const std::uint32_t moved =
        bits_of(-negated) + static_cast<std::uint32_t>(below(9)) - 4U +
        (one_in(2) ? static_cast<std::uint32_t>(below(60) << 23) - (30U << 23) : 0U);
    return float_of(moved);
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace sgs::test
