// Random numbers that follow from where they are used: the same for any number of threads, and no
// state to save.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <initializer_list>

namespace sgs {

// SplitMix64 (Steele, Lea and Flood 2014): random bits from a counter, and a good hash of one.
constexpr std::uint64_t kSplitMixStep = 0x9e3779b97f4a7c15u;

// Its last step: one to one.
constexpr std::uint64_t scrambled(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

// The number behind `value`.
constexpr std::uint64_t mix_bits(std::uint64_t value) { return scrambled(value + kSplitMixStep); }

// The uses of random numbers.
enum class RandomUse : std::uint64_t {
  kStart,
  kOrderOfViews,
  kBackground,
  kNoise,
  kRelocate,
  kGrow,
  kSplit,
  kCameras
};

class CounterRandom {
 public:
  // Other numbers for any other arguments.
  CounterRandom(std::uint64_t seed, RandomUse use, std::uint64_t step = 0,
                std::uint64_t index = 0) {
    for (const std::uint64_t name : {seed, static_cast<std::uint64_t>(use), step, index}) {
      state_ = scrambled(state_ ^ mix_bits(name));
    }
  }

  // 64 bits.
  std::uint64_t bits() {
    const std::uint64_t drawn = mix_bits(state_);
    state_ += kSplitMixStep;
    return drawn;
  }
  // In [0, 1), in steps of 2^-53.
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  // Below `end`, which is far below 2^53.
  std::uint64_t below(std::uint64_t end) {
    return static_cast<std::uint64_t>(uniform() * static_cast<double>(end));
  }
  // Three independent ones of mean 0 and deviation 1 (Box and Muller 1958).
  glm::dvec3 normal3() {
    const double r1 = radius(), a1 = kTurn * uniform(), r2 = radius();
    return {r1 * std::cos(a1), r1 * std::sin(a1), r2 * std::cos(kTurn * uniform())};
  }

 private:
  static constexpr double kTurn = 6.283185307179586;

  double radius() { return std::sqrt(-2 * std::log(1 - uniform())); }

  std::uint64_t state_ = kSplitMixStep;
};

}  // namespace sgs
