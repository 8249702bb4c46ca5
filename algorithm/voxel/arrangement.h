// How a cloud is to be stored.
#pragma once

#include <cstdint>
#include <vector>

namespace sgs {

// A table that finds Gaussians by their storage slots, and which of the cloud's Gaussians goes into
// which slot. Whoever reads the table has the cloud in that order (`reordered`,
// ../splat/gaussian.h): to them a slot is a Gaussian's index, and equal depths are ordered by it.
template <class Table>
struct Arrangement {
  Table table;
  std::vector<std::uint32_t> storage_order;  // [slot] index in the cloud
};

}  // namespace sgs
