// Request streams for memory benchmarks.
#include "testbench/dram/request_generator.h"

namespace sgs {

std::uint64_t xorshift64star(std::uint64_t& state) {
  state ^= state >> 12;
  state ^= state << 25;
  state ^= state >> 27;
  return state * 2685821657736338717u;
}

MemoryRequest RequestGenerator::next() {
  const std::uint64_t q = xorshift64star(state_);
  const std::uint64_t i = index_++;
  const std::uint64_t size = spec_.request_bytes;
  MemoryRequest request;
  request.write = (q >> 1) % 100 < spec_.write_percent;
  switch (spec_.pattern) {
    case Pattern::kRandom:
      request.address = (q >> 11) % (spec_.span_bytes / size) * size;
      break;
    case Pattern::kSequential:
      request.address = i * size % spec_.span_bytes;
      break;
    case Pattern::kStride: {
      const std::uint64_t along = i * spec_.stride_bytes;
      request.address =
          along % spec_.span_bytes + along / spec_.span_bytes * size % spec_.stride_bytes;
      break;
    }
  }
  return request;
}

std::uint64_t stream_hash(const StreamSpec& spec, std::uint64_t count) {
  RequestGenerator generator(spec);
  std::uint64_t hash = 1469598103934665603u;
  for (std::uint64_t i = 0; i < count; ++i) {
    const MemoryRequest request = generator.next();
    const std::uint64_t word = request.address | (request.write ? 1u : 0u);
    for (int byte = 0; byte < 8; ++byte) {
      hash ^= (word >> (8 * byte)) & 0xff;
      hash *= 0x100000001b3u;
    }
  }
  return hash;
}

}  // namespace sgs
