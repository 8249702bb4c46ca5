// Sorter of a core of the tile-centric machine alone: chained lists in memory and jobs in, entries
// in order out. Checked against std::stable_sort; busy cycles against closed forms, in one chunk to
// the cycle.
#include <algorithm>

#include "modules/datapath/work_rates.h"
#include "modules/gscore/sorting/bitonic_cost.h"
#include "modules/gscore/sorting/tile_sorter.h"
#include "testbench/units/gscore_bench.h"

namespace sgs::tb {
namespace {

struct Plan {
  GscoreConfig config;
  std::vector<std::vector<TileEntry>> lists;  // [tile]
  int finish_after = -1;  // entries of the first tile that come out until it is finished
};

std::vector<TileEntry> in_order(std::vector<TileEntry> list) {
  std::stable_sort(list.begin(), list.end(),
                   [](const TileEntry& a, const TileEntry& b) { return a.key < b.key; });
  return list;
}

// Lists of one chunk, one key or none take no splitting: the whole time can be told.
std::uint64_t sort_cycles(const Plan& plan) {
  std::uint64_t cycles = 1;  // the end of the frame
  for (const auto& list : plan.lists) {
    cycles += 1 + list.size();
    const auto differs = [&](const TileEntry& e) { return e.key != list[0].key; };
    if (!std::any_of(list.begin(), list.end(), differs)) continue;
    cycles += bitonic_cost(list.size()).cycles + 1;  // the first entry's place
  }
  return cycles;
}

void run_plan(Case& test, const BenchConfig& bench_config, Plan plan) {
  UnitBench bench(test, bench_config);
  Checks& checks = bench.checks();
  FrameJob frame;
  frame.view.width = static_cast<int>(plan.lists.size()) * kTilePx;
  frame.view.height = kTilePx;
  std::size_t most = 0, all = 0, split = 0;
  for (const auto& list : plan.lists) {
    most = std::max(most, list.size());
    all += list.size();
    split += list.size() > plan.config.sorting.list_entries ? 1 : 0;
  }
  frame.layout = empty_layout(static_cast<std::uint32_t>(most));
  const GscoreJob job = gscore_frame(plan.config, bench, frame);
  const BlockFormat blocks = plan.config.blocks();

  // Blocks of all lists in turn, so that chains go to and fro.
  std::vector<std::vector<std::uint32_t>> chain(plan.lists.size());
  auto next = static_cast<std::uint32_t>(plan.lists.size());
  for (std::size_t t = 0; t < plan.lists.size(); ++t) chain[t] = {static_cast<std::uint32_t>(t)};
  for (bool more = true; more;) {
    more = false;
    for (std::size_t t = 0; t < plan.lists.size(); ++t) {
      if (chain[t].size() * blocks.block_entries() >= plan.lists[t].size()) continue;
      chain[t].push_back(next++);
      more = true;
    }
  }
  std::vector<std::byte> pool(std::size_t{next} * blocks.block_bytes());
  for (std::size_t t = 0; t < plan.lists.size(); ++t) {
    const auto own = chained_blocks(blocks, plan.lists[t], chain[t], next);
    for (std::size_t i = 0; i < pool.size(); ++i) pool[i] |= own[i];
  }
  bench.load(job.lists.base, pool);

  auto& requests = bench.add_fifo<TileRequest>("requests", 1, 1);
  auto& jobs = bench.add_fifo<TileJob>("jobs", 1, 1);
  auto& sorted = bench.add_fifo<SortedEntry>("sorted", 64, 1);
  FinishedTiles finished("finished_tiles", bench.clock(), plan.lists.size(), 1);
  gscore::Phases phases;
  TileSorter unit("sorter", 0, {bench.clock(), job, plan.config, phases}, finished);
  phases.drawing.begin();
  unit.requests(requests);
  unit.jobs(jobs);
  unit.sorted(sorted);
  bench.add_unit(unit);
  bench.add_thread("lister", [&](Activity& activity) {
    for (std::uint32_t t = 0; t < plan.lists.size(); ++t) {
      requests.pop(activity);
      jobs.push({TileMark::kTile, t, t, static_cast<std::uint32_t>(plan.lists[t].size())},
                activity);
    }
    requests.pop(activity);
    jobs.push({TileMark::kEndOfFrame, 0, 0, 0}, activity);
  });
  std::size_t taken = 0;
  bench.add_thread("rendering", [&](Activity& activity) {
    for (std::uint32_t t = 0; t < plan.lists.size(); ++t) {
      const std::vector<TileEntry> expected = in_order(plan.lists[t]);
      std::size_t at = 0;
      for (SortedEntry e = sorted.pop(activity); e.mark == EntryMark::kEntry;
           e = sorted.pop(activity), ++at, ++taken) {
        checks.that(at < expected.size() && e.tile == t && e.record == expected[at].record &&
                        e.bitmap == expected[at].bitmap && e.opacity == expected[at].opacity,
                    fmt::format("entry {} of tile {}: record {}", at, t, e.record));
        if (t == 0 && plan.finish_after >= 0 && at == static_cast<std::size_t>(plan.finish_after)) {
          finished.finish(0, 0);
        }
      }
      if (plan.finish_after < 0 || t > 0) checks.equal(at, expected.size(), "entries of a tile");
    }
    checks.that(sorted.pop(activity).mark == EntryMark::kEndOfFrame, "the end of the frame");
  });
  bench.run();

  checks.equal(bench.counter("entries_sorted"), taken, "entries_sorted");
  checks.equal(taken + bench.counter("dropped_unread") + bench.counter("dropped_loaded"), all,
               "entries sorted and dropped");
  if (plan.finish_after < 0) bench.check_counter("dropped_loaded", 0);
  if (plan.finish_after < 0) checks.that(bench.counter("lists_split") >= split, "lists_split");
  // An entry a cycle through the QSU where lists come in, and out.
  checks.that(bench.busy_cycles("list loading") >= bench.counter("entries_read"),
              "loading's bound");
  const std::uint64_t least = taken + 2 * bench.counter("split_entries") +
                              cycles_for(bench.counter("chunk_entries"), kNetworkWidth) +
                              cycles_for(bench.counter("merged"), kMergeWidth);
  checks.that(bench.busy_cycles("sorting") >= least, "sorting's bound");
  if (most <= plan.config.sorting.chunk_entries && plan.finish_after < 0) {
    checks.equal(bench.busy_cycles("sorting"), sort_cycles(plan), "cycles of sorting");
  }
  checks.equal(bench.bytes_written() > 0, bench.counter("lists_split") > 0, "bytes written");
}

Plan plan_of(GscoreConfig config, std::mt19937_64& random, const std::vector<std::size_t>& lists,
             std::uint32_t keys) {
  Plan plan;
  plan.config = config;
  for (const std::size_t n : lists) {
    plan.lists.push_back(random_entries(random, config, n, keys));
  }
  return plan;
}

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  constexpr std::size_t kCounts[] = {0, 1, 2, 15, 16, 17, 100, 600, 2000};
  constexpr std::uint32_t kKeys[] = {1, 2, 50, 60000};
  std::vector<std::size_t> lists(1 + random() % 6);
  for (std::size_t& n : lists) n = kCounts[random() % 9];
  Plan plan = plan_of(random_gscore(random), random, lists, kKeys[random() % 4]);
  if (random() % 3 == 0) plan.finish_after = static_cast<int>(random() % 40);
  run_plan(test, random_bench(random, kGscoreMemoryBytes), plan);
}

}  // namespace
}  // namespace sgs::tb

int sc_main(int argc, char* argv[]) {
  using namespace sgs;
  using namespace sgs::tb;
  CaseRunner runner("tb_tile_sorter", "Sorter of a tile-centric core alone, against a stable sort");
  const auto directed = [&](const char* name, std::vector<std::size_t> lists, std::uint32_t keys,
                            std::uint32_t list_entries, int finish_after = -1) {
    runner.add_directed(name, [=](Case& test) {
      GscoreConfig config;
      config.cores = 1;
      config.lists.pool_bytes = 1 << 20;
      config.sorting.list_entries = list_entries;
      Plan plan = plan_of(config, test.random, lists, keys);
      plan.finish_after = finish_after;
      run_plan(test, still_gscore(), plan);
    });
  };
  directed("empty lists", {0, 0, 0}, 100, 1024);
  directed("one entry", {1}, 100, 1024);
  directed("one chunk", {256}, 1000, 1024);
  directed("chunks of every size", {2, 15, 16, 17, 31, 33, 128, 255}, 1000, 1024);
  directed("equal keys", {3000}, 1, 1024);
  directed("two keys", {3000}, 2, 256);
  directed("split on chip", {1024, 700}, 10000, 1024);
  directed("split in memory", {5000, 10}, 10000, 512);
  directed("a tile that finishes", {5000, 600}, 10000, 512, 100);
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
