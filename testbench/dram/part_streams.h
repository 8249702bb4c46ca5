// The bench's streams through every shipped memory, beside closed forms.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "modules/dram/memspec.h"
#include "testbench/dram/stream_bench.h"

namespace sgs {

// In sequence and at random, requests of 64 and of 32 bytes, and of 64 with 30 % writes.
constexpr std::size_t kPartStreams = 6;
extern const std::array<const char*, kPartStreams> kPartStreamNames;

struct PartStreams {
  std::string memspec;
  double peak_gb_per_s = 0;
  std::array<double, kPartStreams> bound_gb_per_s{};
  std::array<double, kPartStreams> gb_per_s{};
};

// One channel as the default configuration has it, without the way to it; 32 requests outstanding a
// data bus.
StreamBench part_bench(const std::string& memspec, std::size_t stream, std::uint64_t requests);

// No stream of such requests is faster. In sequence the data bus binds. At random each request
// opens a row: tRRD, tFAW, or as many banks as there are, each busy for tRAS + tRP. Turn-arounds
// and refresh are not in it.
double part_bound_gb_per_s(const Memspec& memspec, const StreamSpec& stream);

// Runs each stream in a process of its own.
PartStreams measure_part(const std::string& memspec, std::uint64_t requests);

void print_parts(const std::vector<PartStreams>& parts);

}  // namespace sgs
