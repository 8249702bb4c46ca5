// Formats of numbers in records.
#pragma once

#include <cstdint>

namespace sgs {

enum class NumberFormat : std::uint8_t { kSingle, kHalf };

}  // namespace sgs
