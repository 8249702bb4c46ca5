// The benchmark table: this model beside public simulators and closed forms on the same streams.
#pragma once

#include <optional>
#include <string>
#include <vector>

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

// The host's speed: sequential reads as transactions of 32, 64 and 256 bytes, random of 32.
void print_speed(std::uint64_t requests);

}  // namespace sgs
