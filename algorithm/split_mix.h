// SplitMix64 (Steele, Lea and Flood 2014): random bits from a counter, and a good hash of one.
#pragma once

#include <cstdint>

namespace sgs {

constexpr std::uint64_t kSplitMixStep = 0x9e3779b97f4a7c15u;

// Its last step: one to one.
constexpr std::uint64_t scrambled(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

// The number behind `value`.
constexpr std::uint64_t mix_bits(std::uint64_t value) { return scrambled(value + kSplitMixStep); }

}  // namespace sgs
