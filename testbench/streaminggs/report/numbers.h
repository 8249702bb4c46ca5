// Numbers for people, and lines about a scene, a data set or a fitting: a name, and what it is.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "algorithm/scene/describe.h"

namespace sgs {

// 1234567 -> "1,234,567"
inline std::string grouped(std::uint64_t value) {
  std::string digits = std::to_string(value);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

// As many digits as anybody reads of a measure: 0.4000000059604645 -> "0.4"
inline std::string rounded(double value) { return fmt::format("{:.4g}", value); }

// "gaussians                 1,200"
inline void print_fact(const std::string& name, const std::string& value) {
  fmt::print("{:<26}{}\n", name, value);
}

inline std::string in_words(const Extent& extent) {
  return fmt::format("{:.4g} {:.4g} {:.4g} .. {:.4g} {:.4g} {:.4g} (world units)", extent.min.x,
                     extent.min.y, extent.min.z, extent.max.x, extent.max.y, extent.max.z);
}

// A frame rate, rounded down: 89.96 holds no 90. 89.649 -> "89.6", 1234.9 -> "1,234"
inline std::string rate_in_words(double fps) {
  constexpr double kOfRounding = 1 + 1e-12;
  if (fps >= 100) return grouped(static_cast<std::uint64_t>(fps * kOfRounding));
  return fmt::format("{:.1f}", std::floor(10 * fps * kOfRounding) / 10);
}

}  // namespace sgs
