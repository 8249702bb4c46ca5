// Placing of regions.
#include "algorithm/memory/regions.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace sgs {

RegionSpan Regions::add(const std::string& name, std::uint64_t bytes) {
  if (std::any_of(begin(), end(), [&](const Region& region) { return region.name == name; })) {
    throw std::invalid_argument("two regions of the memory are called " + name);
  }
  if (size() > std::numeric_limits<RegionId>::max()) {
    throw std::length_error("no number is left for the memory's region " + name);
  }
  const auto id = static_cast<RegionId>(size());
  regions_.push_back({name, next_base(), bytes});
  return {id, regions_.back().base, bytes};
}

RecordArray Regions::add_records(const std::string& name, std::uint32_t record_bytes,
                                 std::uint64_t count) {
  return add(name, record_bytes * count).records(0, record_bytes, count);
}

std::uint64_t Regions::next_base() const {
  return (total_bytes() + kRegionAlignment - 1) / kRegionAlignment * kRegionAlignment;
}

}  // namespace sgs
