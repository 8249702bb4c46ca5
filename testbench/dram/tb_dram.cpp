// tb_dram: the memory alone. Without a mode it checks itself; the modes measure, replay and check.
#include <fmt/format.h>

#include <systemc>

#include "algorithm/files/data_files.h"
#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"
#include "modules/config/strict_json.h"
#include "modules/dram/address_mapping.h"
#include "modules/dram/command_trace.h"
#include "modules/dram/request_trace.h"
#include "modules/dram/trace_checker.h"
#include "testbench/command_line/config_source.h"
#include "testbench/command_line/program.h"
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
  std::string vcd, dram_trace, check, replay, stream;
  std::string published = data_file("published.json");
  ConfigSource config;
  bool table = false, curve = false, print_config = false;
};

// As the accelerator's configuration names it.
struct Section {
  DramConfig dram;
};
void visit(ConfigVisitor& v, Section& section) { v.section("dram", section.dram, "the memory"); }

DramConfig read_config(const Arguments& a) {
  constexpr std::string_view kSection = "dram.";
  for (const std::string& assignment : a.config.overrides) {
    if (assignment.compare(0, kSection.size(), kSection) != 0) {
      throw InputError(
          fmt::format("--set {}: not of the memory, expected dram.KEY=VALUE", assignment));
    }
  }
  DramConfig config;
  a.config.document().read_section_into("dram", config);
  config.validate();
  return config;
}

// Where --vcd and --dram-trace go.
struct Outputs {
  OutputSet files;
  OutputFile* vcd = nullptr;
  OutputFile* dram_trace = nullptr;
};

void open_outputs(const Arguments& a, const DramConfig& config, Outputs& outputs) {
  OutputPlan plan;
  for (const std::string& input :
       {a.replay, a.published, a.config.path(), memspec_path(config.memspec)}) {
    plan.add_input(input);
  }
  for (const std::string& output : {a.vcd, a.dram_trace}) {
    if (!output.empty()) plan.add_output(output);
  }
  plan.check();
  if (!a.vcd.empty()) outputs.vcd = &outputs.files.add(a.vcd);
  if (!a.dram_trace.empty()) outputs.dram_trace = &outputs.files.add(a.dram_trace);
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
  std::vector<PartStreams> parts;
  for (const std::string& memspec : shipped_memspecs())
    parts.push_back(measure_part(memspec, a.requests));
  print_parts(parts);
  for (const PartStreams& part : parts)
    for (std::size_t i = 0; i < kPartStreams; ++i)
      if (part.gb_per_s[i] > part.bound_gb_per_s[i]) {
        fmt::print("FAIL: {} {} is above its bound\n", part.memspec, kPartStreamNames[i]);
        status = 1;
      }
  for (const auto* rows : {&one, &four})
    for (const MeasuredRow& row : *rows)
      if (row.published.bound_gb_per_s && row.ours.gb_per_s > *row.published.bound_gb_per_s) {
        fmt::print("FAIL: {} is above its bound\n", row.published.name);
        status = 1;
      }
  return status;
}

std::vector<MemoryRequest> requests_to_replay(const Arguments& a, std::uint64_t capacity_bytes,
                                              double cycle_ns) {
  const RequestTrace trace = read_request_trace(a.replay, cycle_ns);
  const std::vector<MemoryRequest>& requests = trace.requests;
  if (!trace.form.empty())
    fmt::print(stderr, "tb_dram: note: {}: a {} trace, its cycles are the memory's of {} ns\n",
               a.replay, trace.form, cycle_ns);
  if (requests.empty())
    throw InputError(fmt::format("{}: got no request, expected at least one", a.replay));
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const std::uint64_t bytes = requests[i].bytes != 0 ? requests[i].bytes : a.bytes;
    if (requests[i].address >= capacity_bytes || bytes > capacity_bytes - requests[i].address) {
      throw InputError(
          fmt::format("{}: request {}: got {} bytes from {}, expected them below the "
                      "memory's {}",
                      a.replay, i + 1, bytes, requests[i].address, capacity_bytes));
    }
  }
  return requests;
}

int run_requests(const Arguments& a, const DramConfig& config) {
  if (!a.vcd.empty()) throw InputError("--vcd: is of the self-check, expected no other mode");
  Outputs outputs;
  open_outputs(a, config, outputs);
  StreamBench bench;
  bench.dram = config;
  bench.window = a.window;
  bench.requests = a.requests;
  bench.dram_trace = outputs.dram_trace;
  bench.stream.request_bytes = a.bytes;
  bench.stream.stride_bytes = a.stride;
  bench.stream.write_percent = a.write_percent;
  const Memspec memspec = load_memspec(config.memspec);
  bench.stream.span_bytes = AddressMapping(config, memspec).capacity_bytes();
  bench.stream.pattern = a.stream == "seq"      ? Pattern::kSequential
                         : a.stream == "stride" ? Pattern::kStride
                                                : Pattern::kRandom;
  std::vector<MemoryRequest> requests;
  std::size_t next = 0;
  if (!a.replay.empty()) {
    requests = requests_to_replay(a, bench.stream.span_bytes, memspec.clock_period_ns);
    bench.requests = requests.size();
    bench.next = [&] { return requests[next++]; };
  }
  use_femtosecond_resolution();
  double wall_s = 0;
  const DramStats stats = run_stream(bench, wall_s);
  fmt::print("{}", stats_table(stats));
  fmt::print("{:<24} {:>14.0f}  requests per wall second\n", "speed",
             static_cast<double>(bench.requests) / wall_s);
  outputs.files.commit();
  return kDone;
}

int run_self_check(const Arguments& a, const DramConfig& config) {
  Outputs outputs;
  open_outputs(a, config, outputs);
  SelfCheck check;
  check.dram = config;
  check.seed = a.seed;
  check.transactions = a.transactions;
  check.vcd = outputs.vcd;
  check.dram_trace = outputs.dram_trace;
  use_femtosecond_resolution();
  const bool passed = sgs::run_self_check(check);
  outputs.files.commit();
  return passed ? kDone : kFailed;
}

// Tables and traces bring the memory that they are of.
void refuse_unused_config(const Arguments& a) {
  const char* mode = !a.check.empty() ? "--check" : a.table ? "--table" : "";
  if (*mode == 0 || (a.config.config.empty() && a.config.overrides.empty())) return;
  throw InputError(
      fmt::format("--config, --set: got them with {}, which brings its own memory, expected "
                  "neither",
                  mode));
}

int run(const Arguments& a) {
  refuse_unused_config(a);
  if (!a.check.empty()) return check_trace(a.check);
  const DramConfig config = read_config(a);
  if (a.print_config) {
    fmt::print("{}", config_to_json(Section{config}));
    return kDone;
  }
  const Memspec memspec = load_memspec(config.memspec);
  for (const std::string& warning : check_memspec(memspec, config.memspec))
    fmt::print(stderr, "tb_dram: note: {}\n", warning);
  if (a.table || a.curve) {
    const int status = a.table ? print_benchmarks(a) : kDone;
    if (a.curve) print_latency_curve(config, std::min<std::uint64_t>(a.requests, 200000));
    return status;
  }
  if (!a.stream.empty() || !a.replay.empty()) return run_requests(a, config);
  return run_self_check(a, config);
}

}  // namespace

int sc_main(int argc, char* argv[]) {
  constexpr std::uint64_t kMost = 1'000'000'000'000;
  Arguments a;
  CommandLine line("tb_dram", "The memory alone: self-check, benchmarks, replay, trace checking");
  line.whole("--seed", a.seed, 0, kMostSeed, "seed of the random check");
  line.whole("--transactions", a.transactions, 1, kMost, "of each random initiator of the check");
  line.file("--vcd", a.vcd, "waveform of the check");
  a.config.add_to(line);
  line.flag("--print-config", a.print_config, "print the resolved configuration and stop");
  line.file("--dram-trace", a.dram_trace, "write the DRAM commands to this file");
  line.file("--check", a.check, "check a command trace against the device's constraints");
  line.flag("--table", a.table, "benchmarks beside public simulators and closed forms");
  line.flag("--curve", a.curve, "latency against throughput");
  line.file("--published", a.published, "data file of the published figures");
  line.one_of({"seq", "rnd", "stride"}, "--stream", a.stream, "measure one stream");
  line.file("--replay", a.replay,
            "measure a request trace: ADDRESS R|W [NANOSECONDS [BYTES]], DRAMSys's or DRAMsim3's");
  line.whole("--requests", a.requests, 1, kMost, "how many");
  line.whole("--window", a.window, 1, 1 << 20, "outstanding requests");
  line.whole("--bytes", a.bytes, 1, 65536, "of a request");
  line.whole("--stride", a.stride, 1, std::uint64_t{1} << 40, "bytes, for --stream stride");
  line.whole("--write-percent", a.write_percent, 0, 100, "of a stream");
  return run_program(line, argc, argv, [&] { return run(a); });
}
