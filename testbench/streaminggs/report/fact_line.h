// Lines about a scene, a data set or a fitting: a name, and what it is.
#pragma once

#include <fmt/format.h>

#include <string>

#include "algorithm/scene/describe.h"

namespace sgs {

// "gaussians                 1,200"
inline void print_fact(const std::string& name, const std::string& value) {
  fmt::print("{:<26}{}\n", name, value);
}

inline std::string in_words(const Extent& extent) {
  return fmt::format("{:.4g} {:.4g} {:.4g} .. {:.4g} {:.4g} {:.4g} (world units)", extent.min.x,
                     extent.min.y, extent.min.z, extent.max.x, extent.max.y, extent.max.z);
}

}  // namespace sgs
