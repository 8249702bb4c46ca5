// tb_dram: the memory alone. Without a mode it checks itself; the modes measure, replay and check.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <systemc>

#include "algorithm/input_error.h"
#include "modules/config/strict_json.h"
#include "modules/dram/address_mapping.h"
#include "modules/dram/command_trace.h"
#include "modules/dram/request_trace.h"
#include "modules/dram/trace_checker.h"
#include "testbench/dram/bench_table.h"
#include "testbench/dram/self_check.h"
#include "testbench/dram/stats_table.h"
#include "tlm/no_banner.h"
#include "tlm/time_resolution.h"

namespace {

using namespace sgs;

struct Arguments {
  std::uint64_t seed = 1;
  std::uint64_t transactions = 3000;
  std::uint64_t requests = 1000000;
  std::uint32_t window = 32;
  std::uint32_t bytes = 32;
  std::uint64_t stride = 4096;
  std::uint32_t write_percent = 0;
  std::string timing = "accurate";
  std::string vcd, dram_trace, check, replay, stream, config;
  std::string published = SGS_PUBLISHED_ROWS;
  std::vector<std::string> overrides;
  bool table = false, curve = false, speed = false, print_config = false;
};

DramConfig read_config(const Arguments& a) {
  ConfigDocument document;
  if (!a.config.empty()) document.add_file(a.config);
  for (const std::string& assignment : a.overrides) document.add_override(assignment);
  DramConfig config;
  document.read_into(config);
  config.validate();
  return config;
}

int check_trace(const std::string& path) {
  CommandTraceReader reader(path);
  TraceChecker checker(load_memspec(reader.header().memspec), reader.header());
  CommandRecord record;
  while (reader.next(record))
    if (const auto violation = checker.check(record)) {
      fmt::print("{}: line {}: {}\n", path, reader.line(), violation->text());
      return 1;
    }
  fmt::print("{}: {} commands, no violation\n", path, checker.checked());
  return 0;
}

int print_benchmarks(const Arguments& a) {
  const auto one = measure(published_rows(a.published, "one_channel", a.requests));
  print_table("LPDDR3-1600, 1 channel x32 (peak 6.4 GB/s), window 32", one);
  const auto four = measure(published_rows(a.published, "four_channels", a.requests));
  print_table("LPDDR3-1600, 4 channels x32 (peak 25.6 GB/s), window 128, by interleave", four);
  int status = 0;
  for (const auto* rows : {&one, &four})
    for (const MeasuredRow& row : *rows)
      if (row.published.bound_gb_per_s && row.ours.gb_per_s > *row.published.bound_gb_per_s) {
        fmt::print("FAIL: {} is above its bound\n", row.published.name);
        status = 1;
      }
  return status;
}

int run_requests(const Arguments& a, const DramConfig& config) {
  StreamBench bench;
  bench.dram = config;
  bench.window = a.window;
  bench.requests = a.requests;
  bench.dram_trace = a.dram_trace;
  bench.stream.request_bytes = a.bytes;
  bench.stream.stride_bytes = a.stride;
  bench.stream.write_percent = a.write_percent;
  bench.stream.span_bytes = AddressMapping(config, load_memspec(config.memspec)).capacity_bytes();
  bench.stream.pattern = a.stream == "seq"      ? Pattern::kSequential
                         : a.stream == "stride" ? Pattern::kStride
                                                : Pattern::kRandom;
  std::vector<MemoryRequest> requests;
  std::size_t next = 0;
  if (!a.replay.empty()) {
    requests = read_request_trace(a.replay);
    bench.requests = requests.size();
    bench.next = [&] { return requests[next++]; };
  }
  use_femtosecond_resolution();
  double wall_s = 0;
  const DramStats stats = run_stream(bench, wall_s);
  print_stats(stats);
  fmt::print("{:<24} {:>14.0f}  requests per wall second\n", "speed",
             static_cast<double>(bench.requests) / wall_s);
  return 0;
}

int run(const Arguments& a) {
  if (!a.check.empty()) return check_trace(a.check);
  const DramConfig config = read_config(a);
  if (a.print_config) {
    fmt::print("{}", config_to_json(config));
    return 0;
  }
  const Memspec memspec = load_memspec(config.memspec);
  for (const std::string& warning : check_memspec(memspec, config.memspec))
    fmt::print(stderr, "note: {}\n", warning);
  if (a.table || a.curve || a.speed) {
    const int status = a.table ? print_benchmarks(a) : 0;
    if (a.curve) print_latency_curve(config, std::min<std::uint64_t>(a.requests, 200000));
    if (a.speed) print_speed(a.requests);
    return status;
  }
  if (!a.stream.empty() || !a.replay.empty()) return run_requests(a, config);
  SelfCheck check;
  check.dram = config;
  check.timing = a.timing == "fast" ? TimingMode::kFast : TimingMode::kAccurate;
  check.seed = a.seed;
  check.transactions = a.transactions;
  check.vcd = a.vcd;
  check.dram_trace = a.dram_trace;
  use_femtosecond_resolution();
  return run_self_check(check) ? 0 : 1;
}

}  // namespace

int sc_main(int argc, char* argv[]) {
  Arguments a;
  CLI::App app{"The memory alone: self-check, benchmarks, replay, trace checking"};
  app.add_option("--seed", a.seed, "seed of the random check");
  app.add_option("--transactions", a.transactions, "of each random initiator of the check");
  app.add_option("--timing", a.timing, "of the check")->check(CLI::IsMember({"accurate", "fast"}));
  app.add_option("--vcd", a.vcd, "waveform of the check");
  app.add_option("--config", a.config, "JSON file of the memory's configuration");
  app.add_option("--set", a.overrides, "key=value over the configuration");
  app.add_flag("--print-config", a.print_config, "print the resolved configuration and stop");
  app.add_option("--dram-trace", a.dram_trace, "write the DRAM commands to this file");
  app.add_option("--check", a.check, "check a command trace against the device's constraints");
  app.add_flag("--table", a.table, "benchmarks beside public simulators and closed forms");
  app.add_flag("--curve", a.curve, "latency against throughput");
  app.add_flag("--speed", a.speed, "requests per wall second");
  app.add_option("--published", a.published, "data file of the published figures");
  app.add_option("--stream", a.stream, "measure one stream")
      ->check(CLI::IsMember({"seq", "rnd", "stride"}));
  app.add_option("--replay", a.replay,
                 "measure a request trace: ADDRESS R|W [NANOSECONDS [BYTES]]");
  app.add_option("--requests", a.requests, "how many")->check(CLI::PositiveNumber);
  app.add_option("--window", a.window, "outstanding requests")->check(CLI::PositiveNumber);
  app.add_option("--bytes", a.bytes, "of a request")->check(CLI::Range(1, 65536));
  app.add_option("--stride", a.stride, "bytes, for --stream stride")->check(CLI::PositiveNumber);
  app.add_option("--write-percent", a.write_percent, "of a stream")->check(CLI::Range(0, 100));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    return run(a);
  } catch (const InputError& error) {
    fmt::print(stderr, "tb_dram: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "tb_dram: {}\n", error.what());
    return 1;
  }
}
