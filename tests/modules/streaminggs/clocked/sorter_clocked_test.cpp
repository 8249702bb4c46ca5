// The sorting unit of exact order against its clocked reference.
#include <catch2/catch.hpp>

#include "modules/streaminggs/sorting/exact_sorter.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/streaminggs/clocked/clocked_sorter.h"

namespace sgs::test {
namespace {

constexpr std::uint64_t kKeyMark = 1U << 30U;

struct SorterWorkload {
  const char* name;
  std::uint32_t fewest, most;  // keys of a visit
  std::uint32_t in_one_in = 1, in_longest = 1, out_one_in = 1, out_longest = 1;
  std::uint32_t entries = 16;  // of both FIFOs
};

std::vector<FineCandidate> keys_of(const SorterWorkload& load, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<FineCandidate> keys;
  for (std::uint32_t visit = 0; visit < 60; ++visit) {
    const std::uint64_t count = load.fewest + random() % (load.most - load.fewest + 1);
    FineCandidate key;
    key.visit = visit;
    for (std::uint64_t k = 0; k < count; ++k) {
      key.slot = static_cast<std::uint32_t>(k);
      key.depth = static_cast<float>(random() % 1000);
      keys.push_back(key);
    }
    key.mark = Mark::kEndOfVisit;
    keys.push_back(key);
  }
  return keys;
}

std::uint64_t what_of_sorted(const FineCandidate& key) {
  if (key.mark != Mark::kNone) return kKeyMark;
  return static_cast<std::uint64_t>(key.depth) << 10U | key.slot;
}

void run_sorter(tb::Case& test, Takings& taken, const SorterWorkload& load, std::uint64_t seed) {
  tb::UnitBench bench(test, {});
  StreamingJob job;
  UnitContext context = bench.context(job);
  context.built_for.chunk_gaussians = load.most;
  ExactSorter unit("sorter", {}, 0, 1, context);
  auto& in = bench.add_fifo<FineCandidate>("in", load.entries, 1);
  auto& out = bench.add_fifo<FineCandidate>("out", load.entries, 1);
  unit.keys(in);
  unit.sorted(out);
  bench.add_unit(unit);
  const std::vector<FineCandidate> keys = keys_of(load, seed);
  add_source(bench, "before", keys, {seed, load.in_one_in, load.in_longest}, in);
  add_sink(bench, "behind", until_items(keys.size()),
           {seed + 1000, load.out_one_in, load.out_longest}, out, taken, what_of_sorted);
  bench.run();
}

Takings clocked_sorter(const SorterWorkload& load, std::uint64_t seed) {
  std::vector<SorterItem> items;
  for (const FineCandidate& key : keys_of(load, seed)) {
    items.push_back({what_of_sorted(key), key.mark != Mark::kNone});
  }
  const std::size_t count = items.size();
  ClockedSorter unit;
  ClockedFifo<SorterItem> in(load.entries), out(load.entries);
  ClockedSource<SorterItem> source(std::move(items), {seed, load.in_one_in, load.in_longest});
  ClockedSink<SorterItem> sink({seed + 1000, load.out_one_in, load.out_longest});
  for (std::uint64_t now = 0; sink.taken().size() < count; ++now) {
    sink.step(out, now, [](const SorterItem& item) { return item.key; });
    unit.step(in, out);
    source.step(in);
    in.step();
    out.step();
  }
  return sink.taken();
}

TEST_CASE("clocked reference: sorting unit of exact order") {
  Comparison table("exact sorter");
  for (const SorterWorkload& load : {
           SorterWorkload{"light: visits of up to 2", 0, 2},
           SorterWorkload{"heavy: visits of 2 to 16", 2, 16},
           SorterWorkload{"input stalled", 2, 16, 4, 60},
           SorterWorkload{"output stalled", 2, 16, 1, 1, 4, 20},
           SorterWorkload{"tiny buffers", 2, 16, 4, 20, 4, 20, 1},
           SorterWorkload{"lists of 17 to 64", 17, 64},
           SorterWorkload{"lists of 65 to 256", 65, 256},
       }) {
    table.workload(load, run_sorter, clocked_sorter);
  }
}

}  // namespace
}  // namespace sgs::test
