// The benchmark table: this model beside public simulators and closed forms on the same streams.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "modules/dram/memspec.h"
#include "testbench/dram/stream_bench.h"

namespace sgs {

struct PublishedRow {
  std::string name;
  std::string interleave;  // between channels; empty with one channel
  StreamBench bench;
  std::optional<double> bound_gb_per_s;
  std::optional<double> dramsim3_gb_per_s;
  std::optional<double> dramsim3_mean_ns;
  std::optional<double> ramulator_gb_per_s;
  std::optional<double> ramulator_mean_ns;
  std::string why;  // the named constraint behind a difference beyond 5 %
};

struct MeasuredRow {
  PublishedRow published;
  StreamResult ours;
};

// Rows of the data file. `section`: "one_channel" or "four_channels". `requests` caps a row's
// number of requests. InputError: not readable.
std::vector<PublishedRow> published_rows(const std::string& path, const std::string& section,
                                         std::uint64_t requests);

// Runs each row in a process of its own, one after the other.
std::vector<MeasuredRow> measure(const std::vector<PublishedRow>& rows);

// Further than 5 % from every published figure of the row.
bool beyond_both(const MeasuredRow& row);

void print_table(const std::string& title, const std::vector<MeasuredRow>& rows);

// Random 32-byte reads offered at growing rates: bandwidth and latency at each.
void print_latency_curve(const DramConfig& config, std::uint64_t requests);

// The bench's streams through every shipped memory, beside closed forms.

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
// opens a row: tRRD, tFAW, its commands, or as many banks as there are, each busy for tRAS + tRP.
// Turn-arounds and refresh are not in it.
double part_bound_gb_per_s(const Memspec& memspec, const StreamSpec& stream);

// Runs each stream in a process of its own.
PartStreams measure_part(const std::string& memspec, std::uint64_t requests);

void print_parts(const std::vector<PartStreams>& parts);

}  // namespace sgs
