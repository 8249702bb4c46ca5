// The benchmark table: measuring and printing.
#include "testbench/dram/bench_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"

namespace sgs {

namespace {

using Json = nlohmann::ordered_json;

std::optional<double> number(const Json& row, const char* key) {
  return row.contains(key) ? std::optional<double>(row.at(key).get<double>()) : std::nullopt;
}

StreamBench bench_of(const Json& row, bool four_channels, std::uint64_t most_requests) {
  StreamBench bench;
  // The others time the devices, not the way to them, refresh all banks at once, and charge no I/O.
  bench.dram.front_end_ns = bench.dram.back_end_ns = 0;
  bench.dram.refresh = RefreshMode::kAllBank;
  bench.dram.io_pj_per_bit = 0;
  const std::string pattern = row.at("pattern");
  bench.stream.pattern = pattern == "sequential" ? Pattern::kSequential
                         : pattern == "stride"   ? Pattern::kStride
                                                 : Pattern::kRandom;
  bench.stream.request_bytes = row.at("bytes");
  bench.stream.stride_bytes = row.value("stride", std::uint64_t{0});
  bench.stream.write_percent = row.value("write_percent", 0u);
  bench.dram.channels = four_channels ? 4 : 1;
  bench.stream.span_bytes = (std::uint64_t{1} << 29) * bench.dram.channels;
  bench.window = row.value("window", four_channels ? 128u : 32u);
  bench.requests = std::min(most_requests, row.value("requests", std::uint64_t{1000000}));
  const std::string interleave = row.value("interleave", "32 B");
  bench.dram.mapping = interleave == "32 KB"  ? "row:rank:channel:bank:column"
                       : interleave == "4 KB" ? "row:rank:bank:channel:column"
                                              : "row:rank:bank:column:channel";
  return bench;
}

std::string optional_text(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

std::string difference(double ours, const std::optional<double>& theirs) {
  return theirs ? fmt::format("{:+.1f}", 100 * (ours / *theirs - 1)) : "-";
}

}  // namespace

std::vector<PublishedRow> published_rows(const std::string& path, const std::string& section,
                                         std::uint64_t requests) {
  const Json json = read_json(path);
  std::vector<PublishedRow> rows;
  try {
    for (const Json& row : json.at(section)) {
      PublishedRow r;
      r.name = row.at("name");
      r.interleave = row.value("interleave", "");
      r.bench = bench_of(row, section == "four_channels", requests);
      r.bound_gb_per_s = number(row, "bound");
      r.dramsim3_gb_per_s = number(row, "dramsim3");
      r.dramsim3_mean_ns = number(row, "dramsim3_mean_ns");
      r.ramulator_gb_per_s = number(row, "ramulator");
      r.ramulator_mean_ns = number(row, "ramulator_mean_ns");
      r.why = row.value("why", "");
      rows.push_back(r);
    }
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: {}: {}", path, section, error.what()));
  }
  return rows;
}

std::vector<MeasuredRow> measure(const std::vector<PublishedRow>& rows) {
  std::vector<MeasuredRow> measured;
  for (const PublishedRow& row : rows) measured.push_back({row, run_stream_in_child(row.bench)});
  return measured;
}

bool beyond_both(const MeasuredRow& row) {
  bool any = false;
  for (const auto& theirs : {row.published.dramsim3_gb_per_s, row.published.ramulator_gb_per_s}) {
    if (!theirs) continue;
    if (std::abs(row.ours.gb_per_s / *theirs - 1) <= 0.05) return false;
    any = true;
  }
  return any;
}

void print_table(const std::string& title, const std::vector<MeasuredRow>& rows) {
  fmt::print("\n{}\n", title);
  fmt::print(
      "{:<17} {:>6} | {:>6} {:>6} {:>5} {:>16} {:>5} {:>11} {:>5} {:>6} | {:>7} {:>6} {:>5} "
      "| {:>7} {:>6} {:>5}\n",
      "stream", "bound", "ours", "hit", "", "mean/p50/p99", "VDD2", "both rails", "", "",
      "DRAMsim3", "diff", "mean", "Ramul.", "diff", "mean");
  fmt::print(
      "{:<17} {:>6} | {:>6} {:>6} {:>5} {:>16} {:>5} {:>11} {:>5} {:>6} | {:>7} {:>6} {:>5} "
      "| {:>7} {:>6} {:>5}\n",
      "", "GB/s", "GB/s", "share", "%peak", "ns", "mW", "mW", "pJ/b", "kreq/s", "GB/s", "%", "ns",
      "GB/s", "%", "ns");
  for (const MeasuredRow& row : rows) {
    const PublishedRow& p = row.published;
    const StreamResult& o = row.ours;
    const std::string name = p.interleave.empty() ? p.name : p.interleave + " " + p.name;
    fmt::print(
        "{:<17} {:>6} | {:>6.3f} {:>6.3f} {:>5.1f} {:>16} {:>5.0f} {:>11} {:>5.1f} {:>6.0f} "
        "| {:>7} {:>6} {:>5} | {:>7} {:>6} {:>5}\n",
        name, optional_text(p.bound_gb_per_s, "{:.3f}"), o.gb_per_s, o.row_hit_rate,
        100 * o.gb_per_s / o.peak_gb_per_s,
        fmt::format("{:.0f}/{:.0f}/{:.0f}", o.latency_mean_ns, o.latency_p50_ns, o.latency_p99_ns),
        o.vdd2_power_mw, fmt::format("{:.0f}..{:.0f}", o.band_low_mw, o.band_high_mw), o.pj_per_bit,
        static_cast<double>(o.requests) / o.wall_s / 1e3,
        optional_text(p.dramsim3_gb_per_s, "{:.3f}"), difference(o.gb_per_s, p.dramsim3_gb_per_s),
        optional_text(p.dramsim3_mean_ns, "{:.0f}"), optional_text(p.ramulator_gb_per_s, "{:.3f}"),
        difference(o.gb_per_s, p.ramulator_gb_per_s), optional_text(p.ramulator_mean_ns, "{:.0f}"));
  }
  for (const MeasuredRow& row : rows)
    if (beyond_both(row))
      fmt::print("  {} {}: {}\n", row.published.interleave, row.published.name,
                 row.published.why.empty() ? "NOT EXPLAINED" : row.published.why);
}

void print_latency_curve(const DramConfig& config, std::uint64_t requests) {
  fmt::print("\nLatency and throughput: random 32-byte reads offered at a fixed rate\n");
  fmt::print("{:>8} {:>8} {:>8} {:>8} {:>8}\n", "offered", "reached", "mean", "p50", "p99");
  fmt::print("{:>8} {:>8} {:>8} {:>8} {:>8}\n", "GB/s", "GB/s", "ns", "ns", "ns");
  StreamBench bench;
  bench.dram = config;
  bench.requests = requests;
  bench.window = 4096;
  bench.stream.span_bytes = (std::uint64_t{1} << 29) * config.channels;
  for (int step = 1; step <= 12; ++step) {
    const double offered = 0.22 * step * config.channels;
    RequestGenerator generator(bench.stream);
    std::uint64_t sent = 0;
    bench.next = [&] {
      MemoryRequest request = generator.next();
      request.not_before_ns = static_cast<double>(sent++) * bench.stream.request_bytes / offered;
      return request;
    };
    const StreamResult r = run_stream_in_child(bench);
    const int bar = std::min(60, static_cast<int>(r.latency_mean_ns / 20));
    fmt::print("{:>8.2f} {:>8.3f} {:>8.0f} {:>8.0f} {:>8.0f}  {}\n", offered, r.gb_per_s,
               r.latency_mean_ns, r.latency_p50_ns, r.latency_p99_ns, std::string(bar, '#'));
  }
}

const std::array<const char*, kPartStreams> kPartStreamNames = {
    "seq 64", "seq 32", "rnd 64", "rnd 32", "seq 64, 30 % W", "rnd 64, 30 % W"};

StreamBench part_bench(const std::string& memspec, std::size_t stream, std::uint64_t requests) {
  constexpr std::uint32_t kWindow = 32;
  const Memspec device = load_memspec(memspec);
  StreamBench bench;
  bench.dram.memspec = memspec;
  bench.dram.channels = 1;
  bench.dram.front_end_ns = bench.dram.back_end_ns = 0;
  bench.window = kWindow * bench.dram.buses(device);
  bench.requests = requests;
  const bool random = stream == 2 || stream == 3 || stream == 5;
  bench.stream.pattern = random ? Pattern::kRandom : Pattern::kSequential;
  bench.stream.request_bytes = stream == 1 || stream == 3 ? 32 : 64;
  bench.stream.write_percent = stream < 4 ? 0 : 30;
  bench.stream.span_bytes = device.rank_bytes() * bench.dram.buses(device);
  return bench;
}

namespace {
// Of the command bus, or of the busier of two: an activate, the reads, a precharge.
std::uint32_t command_cycles(const Memspec::CommandBus& bus, std::uint32_t bursts) {
  const std::uint32_t rows = bus.activate + bus.row, columns = bursts * bus.column;
  return bus.buses == 1 ? rows + columns : std::max(rows, columns);
}
}  // namespace

double part_bound_gb_per_s(const Memspec& m, const StreamSpec& stream) {
  const Memspec::Timing& t = m.timing_cycles;
  const double bytes = stream.request_bytes;
  const std::uint32_t bursts = (stream.request_bytes + m.burst_bytes() - 1) / m.burst_bytes();
  double cycles = bursts * std::max(m.burst_cycles(), t.ccd);  // a request, at least
  if (stream.pattern == Pattern::kRandom)
    cycles = std::max({cycles, static_cast<double>(t.rrd), t.faw / 4.0,
                       static_cast<double>(t.ras + t.rp_bank) / m.organisation.banks,
                       static_cast<double>(command_cycles(m.command_bus, bursts))});
  return m.organisation.pseudo_channels * bytes / (cycles * m.clock_period_ns);
}

PartStreams measure_part(const std::string& memspec, std::uint64_t requests) {
  PartStreams part;
  part.memspec = memspec;
  const Memspec device = load_memspec(memspec);
  for (std::size_t i = 0; i < kPartStreams; ++i) {
    const StreamBench bench = part_bench(memspec, i, requests);
    const StreamResult result = run_stream_in_child(bench);
    part.peak_gb_per_s = result.peak_gb_per_s;
    part.bound_gb_per_s[i] = part_bound_gb_per_s(device, bench.stream);
    part.gb_per_s[i] = result.gb_per_s;
  }
  return part;
}

void print_parts(const std::vector<PartStreams>& parts) {
  fmt::print(
      "\nEvery shipped memory, 1 channel, per-bank refresh, GB/s of the bound in closed form\n");
  fmt::print("{:<17} {:>7}", "memspec", "peak");
  for (const char* name : kPartStreamNames) fmt::print(" {:>15}", name);
  fmt::print("\n");
  for (const PartStreams& part : parts) {
    fmt::print("{:<17} {:>7.3f}", part.memspec, part.peak_gb_per_s);
    for (std::size_t i = 0; i < kPartStreams; ++i)
      fmt::print(" {:>7.3f}/{:<7.3f}", part.gb_per_s[i], part.bound_gb_per_s[i]);
    fmt::print("\n");
  }
}

}  // namespace sgs
