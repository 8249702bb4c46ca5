// Gaussians as the scene's file has them, less those that are not stored; no table finds them.
#pragma once

#include <cstdint>
#include <vector>

namespace sgs {

struct FileOrder {
  std::vector<std::uint32_t> storage_order;  // [slot] index in the scene, ascending
};

}  // namespace sgs
