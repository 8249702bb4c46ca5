// Request streams for memory benchmarks, defined to the bit so that other simulators can be given
// the same ones.
#pragma once

#include <cstdint>

#include "modules/dram/request_trace.h"

namespace sgs {

enum class Pattern { kRandom, kSequential, kStride };

struct StreamSpec {
  Pattern pattern = Pattern::kRandom;
  std::uint32_t request_bytes = 32;
  std::uint64_t stride_bytes = 0;  // kStride only
  std::uint64_t span_bytes = std::uint64_t{1} << 29;
  std::uint32_t write_percent = 0;
};

// xorshift64*, one draw a request whatever the pattern. Random: address = ((q >> 11) mod
// (span / size)) * size. Sequential: i * size mod span. Stride S: i S mod span, moved on by one
// request each time round, within the stride. A write when (q >> 1) mod 100 < write_percent.
class RequestGenerator {
 public:
  explicit RequestGenerator(const StreamSpec& spec) : spec_(spec) {}
  MemoryRequest next();

 private:
  const StreamSpec spec_;
  std::uint64_t state_ = 88172645463325252u;
  std::uint64_t index_ = 0;
};

// xorshift64* by itself: steps `state` and returns the draw.
std::uint64_t xorshift64star(std::uint64_t& state);

// FNV-1a of 64 bits over the eight little-endian bytes of (address | write) of `count` requests.
// The offset basis is 1469598103934665603, FNV's without its last digit: the figures that others
// can compare with were made with it.
std::uint64_t stream_hash(const StreamSpec& spec, std::uint64_t count);

}  // namespace sgs
