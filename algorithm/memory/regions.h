// The contiguous regions of the modelled DRAM; every byte on its bus belongs to one of them. Who
// keeps something there adds a region for it: the stored scene first, then the machine that reads
// it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sgs {

// The number of a region, which each transaction carries.
using RegionId = std::uint8_t;

constexpr std::uint64_t kRegionAlignment = 4096;  // the row size of a DRAM page

struct Region {
  std::string name;  // as reports call it
  std::uint64_t base = 0, bytes = 0;
  std::uint64_t end() const { return base + bytes; }
};

// Records of one size, one behind the other, in a region or a piece of one.
struct RecordArray {
  RegionId region = 0;
  std::uint64_t base = 0;
  std::uint32_t record_bytes = 0;
  std::uint64_t count = 0;
  std::uint64_t bytes() const { return count * record_bytes; }
  std::uint64_t end() const { return base + bytes(); }
  std::uint64_t address(std::uint64_t record) const { return base + record * record_bytes; }
};

// A region, or a piece of one, as units know it: where it lies, and whose bytes these are.
struct RegionSpan {
  RegionId region = 0;
  std::uint64_t base = 0, bytes = 0;
  std::uint64_t end() const { return base + bytes; }
  // The piece from `offset` on.
  RegionSpan part(std::uint64_t offset, std::uint64_t size) const {
    return {region, base + offset, size};
  }
  RecordArray records(std::uint64_t offset, std::uint32_t record_bytes, std::uint64_t count) const {
    return {region, base + offset, record_bytes, count};
  }
};

class Regions {
 public:
  // Behind all others, from the next multiple of kRegionAlignment on. Throws std::invalid_argument
  // for a name that is taken and std::length_error when there are more than a RegionId can tell
  // apart.
  RegionSpan add(const std::string& name, std::uint64_t bytes);
  RecordArray add_records(const std::string& name, std::uint32_t record_bytes, std::uint64_t count);

  std::size_t size() const { return regions_.size(); }
  const Region& operator[](RegionId id) const { return regions_[id]; }
  std::vector<Region>::const_iterator begin() const { return regions_.begin(); }
  std::vector<Region>::const_iterator end() const { return regions_.end(); }

  std::uint64_t total_bytes() const { return regions_.empty() ? 0 : regions_.back().end(); }
  // Where the next region would begin.
  std::uint64_t next_base() const;

 private:
  std::vector<Region> regions_;  // [RegionId]
};

}  // namespace sgs
