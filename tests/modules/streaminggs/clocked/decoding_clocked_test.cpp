// Fine filters that decode quantised second halves from one codebook buffer, side by side, against
// their clocked reference.
#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>

#include "modules/streaminggs/hfu/codebook_buffer.h"
#include "modules/streaminggs/hfu/fine_filter.h"
#include "modules/streaminggs/paper_config.h"
#include "testbench/units/job_memory.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/streaminggs/clocked/clocked_decoding_filter.h"
#include "tests/modules/streaminggs/clocked/group_numbers_hardware.h"
#include "tests/modules/streaminggs/clocked/hfu_workloads.h"

namespace sgs::test {
namespace {

struct DecodingWorkload {
  const char* name;
  std::uint32_t readers = 4;
  CodebookConfig codebook;
  std::uint32_t visit = 50;  // candidates
  Waits waits;
  FineHardware hardware;
};

// Each reader has the visits that are its in turn, as HFUs of paper order do.
std::vector<tb::HfuPlan> plans_of(const DecodingWorkload& load, std::uint64_t seed) {
  tb::SceneShape shape = shape_of(preset_of<PaperConfig>("paper").group);
  shape.sh_degree = 3;
  shape.encoding = SecondHalfEncoding::kVq;
  const tb::HfuPlan all = fine_plan(shape, load.hardware, load.visit, seed);
  std::vector<tb::HfuPlan> plans(load.readers, all);
  for (std::uint32_t r = 0; r < load.readers; ++r) {
    plans[r].codebook = load.codebook;
    plans[r].shares.clear();
    for (std::size_t v = r; v < all.shares.size(); v += load.readers) {
      plans[r].shares.push_back(all.shares[v]);
    }
  }
  return plans;
}

// One reader's behind the other's, and behind all the cycle of the last.
Takings together(const std::vector<Takings>& of_readers) {
  Takings all;
  Taken last;
  for (const Takings& takings : of_readers) {
    all.insert(all.end(), takings.begin(), takings.end());
    last.cycle = std::max(last.cycle, takings.back().cycle);
  }
  all.push_back(last);
  return all;
}

void run_decoding(tb::Case& test, Takings& taken, const DecodingWorkload& load,
                  std::uint64_t seed) {
  const std::vector<tb::HfuPlan> plans = plans_of(load, seed);
  tb::UnitBench bench(test, bench_of(load.hardware.port, tb::memory_bytes(plans[0].scene.job)));
  bench.load(0, plans[0].scene.image.bytes);
  const StreamingJob& job = plans[0].scene.job;
  const UnitContext context = bench.context(job);
  FinishedGroups finished("finished", bench.clock(), job.groups.size(), 1);
  add_finishing(bench, load.waits.finishing, job.groups.size(), finished);
  const Rejects rejects = load.hardware.reports_rejects ? Rejects::kReported : Rejects::kDropped;
  CodebookBuffer codebooks("codebooks", load.codebook, context, bench.instant_end(), load.readers);
  bench.add_unit(codebooks);
  std::vector<std::unique_ptr<FineFilter>> units;
  std::vector<Takings> takings(load.readers);
  // The last first: their numbers decide who goes before, not who runs first.
  for (std::uint32_t r = load.readers; r-- > 0;) {
    const std::string number = std::to_string(r);
    auto& in = bench.add_fifo<FineCandidate>("candidates" + number, kCandidateEntries, 1);
    auto& out = bench.add_fifo<SplatToken>("splats" + number, load.hardware.output_entries,
                                           load.hardware.depth_cycles);
    units.push_back(std::make_unique<FineFilter>(("fine" + number).c_str(), plans[r].config,
                                                 load.codebook, FineFilterPlace{r, rejects},
                                                 context));
    FineFilter& unit = *units.back();
    unit.candidates(in);
    unit.splats(out);
    unit.finished(finished);
    unit.codebooks(codebooks);
    bench.add_unit(unit);
    add_source(bench, "before" + number, candidates_of(plans[r]), load.waits.in(seed + r), in);
    add_sink(bench, "behind" + number, until_taken(last_of(plans[r])), load.waits.out(seed + r),
             out, takings[r], what_of_splat);
  }
  bench.run();
  taken = together(takings);
}

CodebookHardware codebooks_of(const DecodingWorkload& load, const tb::HfuPlan& plan) {
  CodebookHardware hardware;
  hardware.banks = load.codebook.banks;
  hardware.latency_cycles = load.codebook.latency_cycles;
  hardware.port = load.hardware.port;
  if (!load.codebook.preloaded) {
    const SceneLayout& layout = plan.scene.job.layout;
    hardware.load = {layout.codebooks.base, layout.second_half.codebook_bytes()};
  }
  return hardware;
}

struct ClockedReader {
  ClockedDecodingFilter unit;
  ClockedFifo<FineItem> in;
  ClockedSource<FineItem> source;
  ClockedSink<std::uint64_t> sink;
  std::uint64_t last;
};

Takings clocked_decoding(const DecodingWorkload& load, std::uint64_t seed) {
  const std::vector<tb::HfuPlan> plans = plans_of(load, seed);
  const CodebookHardware buffer = codebooks_of(load, plans[0]);
  ClockedCodebooks codebooks(buffer, load.readers);
  std::vector<ClockedReader> readers;
  for (std::uint32_t r = 0; r < load.readers; ++r) {
    readers.push_back({ClockedDecodingFilter(load.hardware, buffer, r),
                       ClockedFifo<FineItem>(kCandidateEntries),
                       {clocked_candidates(plans[r]), load.waits.in(seed + r)},
                       ClockedSink<std::uint64_t>(load.waits.out(seed + r)),
                       last_of(plans[r])});
  }
  const auto at_work = [](const ClockedReader& r) { return !until_taken(r.last)(r.sink.taken()); };
  for (std::uint64_t now = 0; std::any_of(readers.begin(), readers.end(), at_work); ++now) {
    const auto finished = [&](std::uint32_t group) {
      return load.waits.finishing.seen(group, now);
    };
    codebooks.begin_cycle();
    for (ClockedReader& r : readers) {
      r.unit.step_results();
      r.sink.step(r.unit.out(), now);
      r.unit.begin(codebooks, finished);
    }
    codebooks.step();
    for (ClockedReader& r : readers) {
      r.unit.step(r.in, finished);
      r.source.step(r.in);
      r.in.step();
    }
  }
  std::vector<Takings> takings;
  for (const ClockedReader& r : readers) takings.push_back(r.sink.taken());
  return together(takings);
}

TEST_CASE("clocked reference: fine filters that decode") {
  Comparison table("decoding");
  FineHardware paper{6, 27, 176, 1, 7};
  paper.numbers = hardware_of(GroupUse::kPixels);
  paper.port.config = preset_of<PaperConfig>("paper").port;
  FineHardware fast = paper, tiny = paper, far = paper;
  fast.test_cycles = 4;
  fast.output_entries = 64;
  far.port.read_latency = 300;
  FineHardware told = fast;
  told.reports_rejects = true;
  FineHardware three = paper;
  three.ffus = 3;
  three.slots = 32;
  three.output_entries = 64;
  tiny.slots = 1;
  tiny.output_entries = 2;
  CodebookConfig full;
  full.preloaded = true;
  CodebookConfig one_bank = full, narrow = full, late = full;
  one_bank.banks = 1;
  narrow.banks = 3;
  narrow.line_bytes = 4;
  late.latency_cycles = 20;
  for (const DecodingWorkload& load : {
           DecodingWorkload{"one reader", 1, full, 50, {}, paper},
           DecodingWorkload{"as of paper, visits of 5", 4, full, 5, {}, paper},
           DecodingWorkload{"as of paper, visits of 50", 4, full, 50, {}, paper},
           DecodingWorkload{"loading", 4, {}, 50, {}, paper},
           DecodingWorkload{"light", 4, full, 50, {2, 300}, paper},
           DecodingWorkload{"output stalled", 4, full, 50, {1, 1, 4, 200}, paper},
           DecodingWorkload{"memory of 300 cycles", 4, full, 50, {}, far},
           DecodingWorkload{"tests every 4 cycles", 4, full, 50, {}, fast},
           DecodingWorkload{"the same, 8 readers", 8, full, 50, {}, fast},
           DecodingWorkload{"the same, rejects reported", 8, full, 50, {}, told},
           DecodingWorkload{"groups that finish", 4, full, 5, {1, 1, 1, 1, {1500}}, paper},
           DecodingWorkload{"groups that finish, told", 8, full, 50, {1, 1, 1, 1, {300}}, told},
           DecodingWorkload{"three FFUs each", 4, full, 50, {}, three},
           DecodingWorkload{"one bank", 4, one_bank, 50, {}, fast},
           DecodingWorkload{"3 banks of 4 B", 4, narrow, 50, {}, paper},
           DecodingWorkload{"20 cycles behind the last line", 4, late, 50, {}, fast},
           DecodingWorkload{"tiny buffers", 4, full, 50, {}, tiny},
           DecodingWorkload{"tiny buffers, output stalled", 4, full, 5, {1, 1, 4, 200}, tiny},
       }) {
    table.workload(load, run_decoding, clocked_decoding);
  }
}

}  // namespace
}  // namespace sgs::test
