// The bench's streams through every shipped memory.
#include "testbench/dram/part_streams.h"

#include <fmt/format.h>

#include <algorithm>

namespace sgs {

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

double part_bound_gb_per_s(const Memspec& m, const StreamSpec& stream) {
  const Memspec::Timing& t = m.timing_cycles;
  const double bytes = stream.request_bytes;
  const std::uint32_t bursts = (stream.request_bytes + m.burst_bytes() - 1) / m.burst_bytes();
  double cycles = bursts * std::max(m.burst_cycles(), t.ccd);  // a request, at least
  if (stream.pattern == Pattern::kRandom)
    cycles = std::max({cycles, static_cast<double>(t.rrd), t.faw / 4.0,
                       static_cast<double>(t.ras + t.rp_bank) / m.organisation.banks});
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
