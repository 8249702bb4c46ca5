// Codebook buffer alone: loading from memory, and readers that share its banks. Checked against the
// bytes in memory and against an arbiter that goes cycle by cycle.
#include <algorithm>
#include <cstring>

#include "modules/datapath/selection.h"
#include "modules/streaminggs/hfu/codebook_buffer.h"
#include "testbench/units/case_runner.h"
#include "testbench/units/job_memory.h"
#include "testbench/units/unit_bench.h"

namespace sgs::tb {
namespace {

// Codebooks of random bytes behind some other region.
struct Plan {
  CodebookConfig config;
  StreamingJob job;
  std::vector<std::byte> codebooks;
};

Plan plan_of(std::mt19937_64& random, const SecondHalfFormat& format) {
  Plan plan;
  plan.job.layout.second_half = format;
  plan.codebooks.resize(format.codebook_bytes());
  for (std::byte& byte : plan.codebooks) byte = static_cast<std::byte>(random() % 256);
  plan.job.layout.regions.add("something_else", 4096);
  plan.job.layout.codebooks = plan.job.layout.regions.add("codebooks", plan.codebooks.size());
  return plan;
}

BenchConfig bench_of(const Plan& plan, std::uint32_t latency_cycles) {
  BenchConfig config;
  config.latency_cycles = latency_cycles;
  config.memory_bytes = memory_bytes(plan.job);
  return config;
}

// The scale codebook alone, with lines as long as its entries: entry i is line i.
SecondHalfFormat one_line_entries(std::uint32_t entries) {
  return {SecondHalfEncoding::kVq, 0, {entries, 0, 0, 0}};
}
constexpr std::uint32_t kScaleEntryBytes = 12;

struct Request {
  CodebookIndices indices{};
  std::uint64_t asked = 0, done = 0;  // cycles
  std::uint32_t reader = 0;
};

// Lines of one codebook's entry; none of a codebook that the scene has not.
std::vector<std::uint32_t> lines_of(const Plan& plan, const CodebookIndices& indices,
                                    std::size_t id) {
  std::vector<std::uint32_t> lines;
  const SecondHalfFormat& format = plan.job.layout.second_half;
  if (format.entries[id] == 0) return lines;
  const EntryRange range = format.entry(static_cast<Codebook>(id), indices[id]);
  for (std::uint32_t byte = range.begin; byte < range.begin + range.bytes; ++byte) {
    const std::uint32_t line = byte / plan.config.line_bytes;
    if (lines.empty() || line != lines.back()) lines.push_back(line);
  }
  return lines;
}

// The lines of all of the record's entries, codebook after codebook.
std::vector<std::uint32_t> lines_of(const Plan& plan, const CodebookIndices& indices) {
  std::vector<std::uint32_t> lines;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    const std::vector<std::uint32_t> of_entry = lines_of(plan, indices, id);
    lines.insert(lines.end(), of_entry.begin(), of_entry.end());
  }
  return lines;
}

// A line that is read is an access to the codebook that it is of.
void check_lines(UnitBench& bench, const Plan& plan, const std::vector<Request>& requests) {
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    std::uint64_t lines = 0;
    for (const Request& request : requests) lines += lines_of(plan, request.indices, id).size();
    bench.checks().equal(bench.accesses(kCodebookNames[id]).first, lines,
                         fmt::format("lines read of codebook {}", kCodebookNames[id]));
  }
}

// When each request is done. In every cycle the requests that are under way each take the bank of
// their next line if nobody has taken it: in the order of `requests`, which is that in which they
// were made, those of one cycle by the readers' numbers.
std::vector<std::uint64_t> arbitrate(const Plan& plan, const std::vector<Request>& requests) {
  std::vector<std::uint64_t> done(requests.size(), 0);
  std::vector<std::vector<std::uint32_t>> lines;
  for (const Request& request : requests) lines.push_back(lines_of(plan, request.indices));
  std::vector<std::size_t> next(requests.size(), 0);
  std::size_t left = requests.size();
  for (std::uint64_t cycle = 0; left > 0; ++cycle) {
    std::vector<bool> taken(plan.config.banks, false);
    for (std::size_t r = 0; r < requests.size(); ++r) {
      if (requests[r].asked > cycle || next[r] == lines[r].size()) continue;
      const std::uint32_t bank = lines[r][next[r]] % plan.config.banks;
      if (taken[bank]) continue;
      taken[bank] = true;
      if (++next[r] < lines[r].size()) continue;
      done[r] = cycle + 1;
      --left;
    }
  }
  return done;
}

// A codebook lies in all banks, one of fewer lines in so many.
std::uint64_t memories(const Plan& plan) {
  const SecondHalfFormat& format = plan.job.layout.second_half;
  std::uint64_t sum = 0;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    const std::uint64_t bytes =
        std::uint64_t{format.entries[id]} * format.entry_bytes(static_cast<Codebook>(id));
    if (bytes == 0) continue;
    sum += std::clamp<std::uint64_t>(bytes / plan.config.line_bytes, 1, plan.config.banks);
  }
  return sum;
}

// Counters, and each request's time against the arbiter's. A line comes from one of all memories,
// and each of its words goes to any place among them.
void check_requests(UnitBench& bench, const Plan& plan, const std::vector<Request>& requests) {
  const std::vector<std::uint64_t> expected = arbitrate(plan, requests);
  std::uint64_t lines = 0, waited = 0;
  for (std::size_t r = 0; r < requests.size(); ++r) {
    bench.checks().equal(requests[r].done, expected[r],
                         fmt::format("request {}: cycle of its end", r));
    const std::size_t own = lines_of(plan, requests[r].indices).size();
    lines += own;
    waited += expected[r] - requests[r].asked - own;
  }
  bench.check_counter("records_decoded", requests.size());
  bench.check_counter("lines_read", lines);
  bench.check_counter("bank_conflict_cycles", waited);
  bench.check_operations("codebooks", "comparator", lines);
  bench.check_operations(
      "codebooks", "select_bit",
      8 * plan.config.line_bytes * lines *
          (counter_bits(memories(plan) - 1) + counter_bits(plan.config.line_bytes / 4 - 1)));
  check_lines(bench, plan, requests);
}

// `requests` made at their times by a reader each, of a buffer that is full from the start.
// by_hand: when each is done. Readers are made last first: their numbers decide, not who runs
// first.
void directed_readers(Case& test, const CodebookConfig& config, const SecondHalfFormat& format,
                      std::vector<Request> requests, const std::vector<std::uint64_t>& by_hand) {
  Plan plan = plan_of(test.random, format);
  plan.config = config;
  plan.config.preloaded = true;
  UnitBench bench(test, bench_of(plan, 20));
  bench.load(plan.job.layout.codebooks.base, plan.codebooks);
  CodebookBuffer buffer("codebooks", plan.config, bench.context(plan.job), bench.instant_end(),
                        static_cast<std::uint32_t>(requests.size()));
  bench.add_unit(buffer);
  for (std::size_t r = requests.size(); r-- > 0;) {
    bench.add_thread(fmt::format("reader{}", r), [&, r](Activity& activity) {
      bench.clock().wait_cycles(requests[r].asked);
      buffer.read_entries(static_cast<std::uint32_t>(r), requests[r].indices, activity);
      requests[r].done = bench.clock().now_cycles();
      activity.close();
      bench.checks().equal(activity.busy_cycles(), requests[r].done - requests[r].asked,
                           fmt::format("reader {}: busy cycles", r));
    });
  }
  bench.run();
  std::uint64_t took = 0, least = 0, lines = 0;
  for (std::size_t r = 0; r < requests.size(); ++r) {
    bench.checks().equal(requests[r].done, by_hand[r], fmt::format("cycle of end {}", r));
    took += requests[r].done;
    lines += lines_of(plan, requests[r].indices).size();
    least += requests[r].asked;
  }
  bench.check_counter("bank_conflict_cycles", took - least - lines);
  bench.check_counter("lines_read", lines);
  bench.check_counter("records_decoded", requests.size());
  check_lines(bench, plan, requests);
  bench.checks().equal(bench.bytes_read(), 0U, "bytes read for a buffer that was full");
  bench.checks().that(
      std::memcmp(buffer.bytes(), plan.codebooks.data(), plan.codebooks.size()) == 0,
      "the buffer holds other bytes than the memory");
  bench.check_counter("bytes_loaded", 0);
}

CodebookConfig lines_of_an_entry(std::uint32_t banks) {
  CodebookConfig config;
  config.banks = banks;
  config.line_bytes = kScaleEntryBytes;
  return config;
}

// The codebooks from memory while a reader waits for them.
void load(Case& test, const SecondHalfFormat& format, const BenchConfig& memory) {
  Plan plan = plan_of(test.random, format);
  BenchConfig config = memory;
  config.memory_bytes = memory_bytes(plan.job);
  UnitBench bench(test, config);
  Checks& checks = bench.checks();
  bench.load(plan.job.layout.codebooks.base, plan.codebooks);
  CodebookBuffer buffer("codebooks", plan.config, bench.context(plan.job), bench.instant_end(), 1);
  bench.add_unit(buffer);
  bool asked = false;
  bench.add_thread("reader", [&](Activity& activity) {
    if (plan.codebooks.empty()) return;  // no record, no index
    asked = true;
    const CodebookIndices first{};
    buffer.read_entries(0, first, activity);
    const std::uint64_t full = bench.counter("loaded_at_cycle");
    checks.equal(bench.clock().now_cycles(), full + lines_of(plan, first).size(),
                 "cycle in which the first record is read");
    activity.close();
    checks.equal(activity.waited_for(WaitFor::kLoading), full,
                 "cycles that the reader waited for codebooks");
    checks.that(std::memcmp(buffer.bytes(), plan.codebooks.data(), plan.codebooks.size()) == 0,
                "the buffer holds other bytes than the memory");
  });
  bench.run();
  checks.equal(asked, !plan.codebooks.empty(), "the reader asked");
  bench.check_counter("bytes_loaded", plan.codebooks.size());
  std::uint64_t words = 0;  // whole lines of all codebooks
  for (const SramUse& use : CodebookBuffer::sram_uses(plan.config, plan.job.layout.second_half)) {
    words += bench.accesses(use.name).second;
  }
  checks.that(words * plan.config.line_bytes >= plan.codebooks.size(), "lines written");
  checks.that(words <= plan.codebooks.size() / plan.config.line_bytes + kCodebookCount,
              "lines written twice");
  checks.equal(bench.bytes_read(), plan.codebooks.size(), "bytes read");
  checks.equal(bench.transactions(), (plan.codebooks.size() + 255) / 256, "transactions");
  if (config.memory == Memory::kFixedLatency) {
    // All of it is asked for as fast as the port can.
    const std::uint64_t leaving = (plan.codebooks.size() + 255) / 256 - 1;
    checks.equal(bench.counter("loaded_at_cycle"),
                 plan.codebooks.empty() ? 0 : leaving + config.latency_cycles,
                 "cycle in which the buffer is full");
  } else {
    constexpr double kPeakBytesPerCycle = 25.6;
    checks.that(static_cast<double>(bench.counter("loaded_at_cycle")) * kPeakBytesPerCycle >=
                    static_cast<double>(plan.codebooks.size()),
                "loaded faster than the memory can");
  }
}

SecondHalfFormat random_format(std::mt19937_64& random) {
  SecondHalfFormat format{SecondHalfEncoding::kVqPacked, static_cast<int>(random() % 4), {}};
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (id == 3 && format.sh_degree == 0) continue;
    format.entries[id] = 1 + static_cast<std::uint32_t>(random() % 200);
  }
  return format;
}

CodebookIndices random_indices(std::mt19937_64& random, const SecondHalfFormat& format) {
  CodebookIndices indices{};
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (format.entries[id] > 0) {
      indices[id] = static_cast<std::uint32_t>(random() % format.entries[id]);
    }
  }
  return indices;
}

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  Plan plan = plan_of(random, random_format(random));
  plan.config.banks = 1 + static_cast<std::uint32_t>(random() % 16);
  plan.config.line_bytes = 4 * (1 + static_cast<std::uint32_t>(random() % 16));
  BenchConfig config = random_bench(random, memory_bytes(plan.job));
  config.stall_probability = 0;  // there is no FIFO
  const bool preloaded = random() % 2 == 0;
  plan.config.preloaded = preloaded;
  UnitBench bench(test, config);
  bench.load(plan.job.layout.codebooks.base, plan.codebooks);
  constexpr std::uint64_t kFull = 100000;  // by then, whatever the memory
  const auto readers = 1 + static_cast<std::uint32_t>(random() % 8);
  const auto longest_pause = 1 + random() % 30;
  CodebookBuffer buffer("codebooks", plan.config, bench.context(plan.job), bench.instant_end(),
                        readers);
  bench.add_unit(buffer);
  std::vector<Request> requests;
  for (std::uint32_t r = 0; r < readers; ++r) {
    bench.add_thread(fmt::format("reader{}", r), [&, r](Activity& activity) {
      if (!preloaded) bench.clock().wait_cycles(kFull);
      for (int k = 0; k < 30; ++k) {
        bench.clock().wait_cycles(random() % longest_pause);
        const CodebookIndices indices = random_indices(random, plan.job.layout.second_half);
        const std::size_t mine = requests.size();
        requests.push_back({indices, bench.clock().now_cycles(), 0, r});
        buffer.read_entries(r, indices, activity);
        requests[mine].done = bench.clock().now_cycles();
      }
    });
  }
  bench.run();
  std::sort(requests.begin(), requests.end(), [](const Request& a, const Request& b) {
    return a.asked < b.asked || (a.asked == b.asked && a.reader < b.reader);
  });
  check_requests(bench, plan, requests);
  bench.checks().equal(bench.bytes_read(), preloaded ? 0 : plan.codebooks.size(), "bytes read");
  bench.checks().that(bench.counter("loaded_at_cycle") < kFull, "not full in time");
  bench.checks().that(
      std::memcmp(buffer.bytes(), plan.codebooks.data(), plan.codebooks.size()) == 0,
      "the buffer holds other bytes than the memory");
}

Request at(std::uint64_t cycle, std::uint32_t scale, std::uint32_t sh = 0) {
  return {{scale, 0, 0, sh}, cycle, 0, 0};
}

}  // namespace
}  // namespace sgs::tb

int sc_main(int argc, char* argv[]) {
  using namespace sgs;
  using namespace sgs::tb;
  CaseRunner runner("tb_codebook", "Codebook buffer alone, against a cycle-by-cycle arbiter");
  const SecondHalfFormat paper{SecondHalfEncoding::kVq, 3, {4096, 4096, 4096, 512}};
  for (const auto memory : {Memory::kFixedLatency, Memory::kDram}) {
    const auto add = [&](const char* name, const SecondHalfFormat& format) {
      runner.add_directed(fmt::format("{} from memory {}", name, static_cast<int>(memory)),
                          [=](Case& test) {
                            BenchConfig config;
                            config.memory = memory;
                            config.latency_cycles = 37;
                            load(test, format, config);
                          });
    };
    add("the paper's codebooks", paper);
    add("one entry", one_line_entries(1));
    add("no entry", {SecondHalfEncoding::kVq, 0, {}});
  }

  // Banks of whole entries: entry i lies in bank i modulo their number. A line takes one cycle.
  const auto readers = [&](const char* name, std::uint32_t banks, std::vector<Request> requests,
                           std::vector<std::uint64_t> done) {
    runner.add_directed(name, [=](Case& test) {
      directed_readers(test, lines_of_an_entry(banks), one_line_entries(32), requests, done);
    });
  };
  readers("one reader", 8, {at(10, 3)}, {11});
  readers("two readers, one bank, one cycle: one waits a cycle", 8, {at(10, 1), at(10, 9)},
          {11, 12});
  readers("two readers of the same entry: it is read twice", 8, {at(10, 1), at(10, 1)}, {11, 12});
  readers("two readers, two banks", 8, {at(10, 1), at(10, 2)}, {11, 11});
  readers("two readers, one bank, a cycle apart", 8, {at(10, 1), at(11, 9)}, {11, 12});
  readers("three readers, one bank", 8, {at(10, 0), at(10, 8), at(10, 16)}, {11, 12, 13});
  readers("one bank for all", 1, {at(10, 0), at(10, 1), at(10, 2), at(12, 3)}, {11, 12, 13, 14});
  readers("a reader behind a conflict meets the next", 8, {at(10, 1), at(10, 9), at(11, 17)},
          {11, 12, 13});
  readers("at time 0", 8, {at(0, 1), at(0, 9)}, {1, 2});

  // Entries of 36 B in lines of 12 B, behind one entry of scale: SH entry e is lines 1 + 3 e to
  // 3 + 3 e; the scale entry is line 0.
  runner.add_directed("records of several lines, one behind the other", [=](Case& test) {
    const SecondHalfFormat format{SecondHalfEncoding::kVq, 1, {1, 0, 0, 8}};
    // Both want banks 0 1 2 3 in turn: the second is one cycle behind throughout.
    directed_readers(test, lines_of_an_entry(8), format, {at(10, 0, 0), at(10, 0, 0)}, {14, 15});
  });
  runner.add_directed("records of several lines, a cycle apart", [=](Case& test) {
    const SecondHalfFormat format{SecondHalfEncoding::kVq, 1, {1, 0, 0, 8}};
    directed_readers(test, lines_of_an_entry(8), format, {at(10, 0, 0), at(11, 0, 0)}, {14, 15});
  });
  runner.add_directed("a line that two entries share is read for each", [=](Case& test) {
    // Lines of 16 B: scale entry 0 is bytes 0 to 11, the SH entry bytes 12 to 47: lines 0, then 0
    // to 2.
    CodebookConfig config;
    config.line_bytes = 16;
    directed_readers(test, config, {SecondHalfEncoding::kVq, 1, {1, 0, 0, 1}}, {at(10, 0, 0)},
                     {14});
  });
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
