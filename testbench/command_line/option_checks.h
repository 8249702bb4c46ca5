// What values of options may be, for CLI::Option::check().
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

namespace sgs {

constexpr std::uint64_t kMostSeed = INT64_MAX;

// Decimal digits only, in [lo, hi]. (CLI11 alone wraps -1 to 2^64 - 1, cuts 10^23 and takes nan for
// in range.)
CLI::Validator whole_number(std::uint64_t lo, std::uint64_t hi);

// A finite number in [lo, hi].
CLI::Validator real_number(double lo, double hi);

// A text that is not empty: an option that was given must not count as left out.
CLI::Validator not_empty();

}  // namespace sgs
