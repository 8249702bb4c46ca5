// Numbers for people.
#pragma once

#include <fmt/format.h>

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

}  // namespace sgs
