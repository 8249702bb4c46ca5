// Numbers for people.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>

namespace sgs {

// 1234567 -> "1,234,567"
inline std::string grouped(std::uint64_t value) {
  std::string digits = std::to_string(value);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

// As many digits as anybody reads of a measure: 0.4000000059604645 -> "0.4"
inline std::string rounded(double value) { return fmt::format("{:.4g}", value); }

// A frame rate, rounded down: 89.96 holds no 90. 89.649 -> "89.6", 1234.9 -> "1,234"
inline std::string rate_in_words(double fps) {
  constexpr double kOfRounding = 1 + 1e-12;
  if (fps >= 100) return grouped(static_cast<std::uint64_t>(fps * kOfRounding));
  return fmt::format("{:.1f}", std::floor(10 * fps * kOfRounding) / 10);
}

}  // namespace sgs
