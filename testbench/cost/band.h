// An amount that is known within bounds: what the sources allow at least, what is taken, and what
// they allow at most.
#pragma once

#include <fmt/format.h>

#include <string>

#include "modules/config/config_visitor.h"

namespace sgs {

struct Band {
  double low = 0, middle = 0, high = 0;
};

constexpr Band operator+(const Band& a, const Band& b) {
  return {a.low + b.low, a.middle + b.middle, a.high + b.high};
}
constexpr Band operator*(const Band& a, const Band& b) {
  return {a.low * b.low, a.middle * b.middle, a.high * b.high};
}
constexpr Band operator*(double factor, const Band& a) {
  return {factor * a.low, factor * a.middle, factor * a.high};
}

// "6.50 (4.88 .. 9.50)"
inline std::string in_words(const Band& band) {
  return fmt::format("{:.2f} ({:.2f} .. {:.2f})", band.middle, band.low, band.high);
}

inline void visit(ConfigVisitor& v, Band& band) {
  const ConfigRange range = in_range(0, 1e9);
  v("low", band.low, range, "least that the sources allow");
  v("middle", band.middle, range, "taken");
  v("high", band.high, range, "most that the sources allow");
}

}  // namespace sgs
