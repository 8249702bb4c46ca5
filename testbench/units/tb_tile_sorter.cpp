// Sorter of a core of the tile-centric machine alone: chained lists in memory and jobs in, entries
// in order out. Checked against std::stable_sort; busy cycles against closed forms, in one chunk to
// the cycle.
#include <algorithm>
#include <array>

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

bool one_key(const std::vector<TileEntry>& list) {
  return std::all_of(list.begin(), list.end(),
                     [&](const TileEntry& e) { return e.key == list[0].key; });
}

// Lists of one chunk, one key or none take no splitting: the whole time can be told.
std::uint64_t sort_cycles(const Plan& plan) {
  std::uint64_t cycles = 1;  // the end of the frame
  for (const auto& list : plan.lists) {
    cycles += 1 + list.size();
    if (one_key(list)) continue;
    cycles += bitonic_cost(list.size()).cycles + 1;  // the first entry's place
  }
  return cycles;
}

// Operations for lists that nobody finishes, counted beside the unit.
struct Work {
  std::uint64_t lists_split = 0, entries_split = 0, loaded = 0, in_order = 0;
  std::uint64_t splits = 0, split_entries = 0;
  std::uint64_t chunks = 0, chunk_entries = 0, exchanges = 0, merged = 0;
  std::uint64_t list_reads = 0, key_reads = 0;  // on chip
  std::uint64_t bursts = 0, bytes_read = 0, sampled = 0;
  std::uint64_t bytes_written = 0, words_written = 0, words_flushed = 0;
};

using Subsets = std::array<std::vector<TileEntry>, kSubsets>;

Subsets subsets_of(const std::vector<TileEntry>& list, const Pivots& pivots) {
  Subsets out;
  for (const TileEntry& entry : list) out[subset_of(pivots, entry.key)].push_back(entry);
  return out;
}

Pivots pivots_of_range(const std::vector<TileEntry>& list) {
  KeyRange keys;
  for (const TileEntry& entry : list) keys.take(entry.key);
  return ranged_pivots(keys);
}

// A list on chip, or a subset of one, whose keys lie beside it.
void sort_on_chip(const GscoreConfig& config, const std::vector<TileEntry>& list, bool subset,
                  Work& work) {
  if (list.empty()) return;
  work.list_reads += list.size();  // as they come out
  std::uint64_t& key_reads = subset ? work.key_reads : work.list_reads;
  if (one_key(list)) {
    work.in_order += list.size();
    if (subset) key_reads += list.size();  // a key lies beside the place of its entry
    return;
  }
  if (list.size() <= config.sorting.chunk_entries) {
    const BitonicCost cost = bitonic_cost(list.size());
    ++work.chunks;
    work.chunk_entries += list.size();
    work.exchanges += cost.compare_exchanges;
    work.merged += cost.merged;
    key_reads += list.size();
    return;
  }
  ++work.splits;
  work.split_entries += list.size();
  key_reads += 2 * list.size() + (subset ? 0 : kPivots);
  work.list_reads -= list.size();  // they come out of the subsets
  const Pivots pivots = subset ? pivots_of_range(list) : sampled_pivots(list, list.size());
  for (const auto& one : subsets_of(list, pivots)) sort_on_chip(config, one, true, work);
}

// Words of 8 B that bytes [begin, end) lie in.
std::uint64_t words_of(std::uint32_t begin, std::uint32_t end) {
  return (end - 1) / 8 - begin / 8 + 1;
}

// A subset as it is written: each block with its link, each line when it is full or the list ends.
void write_chain(const BlockFormat& blocks, std::size_t entries, Work& work) {
  for (std::size_t e = 0; e < entries; ++e) {
    const std::uint32_t begin = e % blocks.block_entries() == 0 ? 0 : blocks.offset(e);
    const std::uint32_t end = blocks.offset(e) + blocks.entry.bytes();
    work.bytes_written += end - begin;
    work.words_written += words_of(begin, end);
    const std::uint32_t line = begin / blocks.line_bytes * blocks.line_bytes;
    const bool last = e + 1 == entries || end + blocks.entry.bytes() > line + blocks.line_bytes;
    if (last) work.words_flushed += words_of(line, end);
  }
}

// A list in memory, or a subset of one.
void load(const GscoreConfig& config, const std::vector<TileEntry>& list, bool subset, Work& work) {
  const BlockFormat blocks = config.blocks();
  const auto piece = [&](std::size_t at, std::size_t most) {
    const auto end = list.begin() + static_cast<std::ptrdiff_t>(std::min(list.size(), at + most));
    return std::vector<TileEntry>(list.begin() + static_cast<std::ptrdiff_t>(at), end);
  };
  for (std::size_t at = 0; at < list.size(); at += blocks.block_entries()) {
    const auto entries = static_cast<std::uint32_t>(piece(at, blocks.block_entries()).size());
    work.bytes_read += blocks.used_bytes(entries);
    work.bursts += cycles_for(blocks.used_bytes(entries), kPortBytes);
  }
  // Entries with one key are in order, however many; for a tile's list that is not known ahead.
  const std::size_t most = config.sorting.list_entries;
  if (list.size() <= most || (subset && one_key(list))) {
    for (std::size_t at = 0; at < list.size(); at += most) {
      ++work.loaded;
      sort_on_chip(config, piece(at, most), false, work);
    }
    return;
  }
  ++work.lists_split;
  work.entries_split += list.size();
  const std::vector<TileEntry> first = piece(0, blocks.block_entries());
  const Pivots pivots = subset ? pivots_of_range(list) : sampled_pivots(first, first.size());
  work.sampled += subset ? 0 : kPivots;
  for (const auto& one : subsets_of(list, pivots)) {
    write_chain(blocks, one.size(), work);
    load(config, one, true, work);
  }
}

void check_work(UnitBench& bench, const Plan& plan, std::uint64_t all) {
  Work work;
  for (const auto& list : plan.lists) load(plan.config, list, false, work);
  bench.check_counter("tiles", plan.lists.size());
  bench.check_counter("lists_split", work.lists_split);
  bench.check_counter("entries_split", work.entries_split);
  bench.check_counter("entries_loaded", all);
  bench.check_counter("entries_in_order", work.in_order);
  bench.check_counter("splits", work.splits);
  bench.check_counter("split_entries", work.split_entries);
  bench.check_counter("chunks", work.chunks);
  bench.check_counter("chunk_entries", work.chunk_entries);
  bench.check_counter("compare_exchanges", work.exchanges);
  bench.check_counter("merged", work.merged);
  bench.check_accesses("list blocks", work.bursts + work.sampled, work.bursts);
  bench.check_accesses("lists on chip", work.list_reads, all);
  bench.check_accesses("keys of subsets", work.key_reads, work.split_entries);
  bench.check_accesses("lines of subsets", work.words_flushed, work.words_written);
  // A subset's row is read and written for each entry, once more each subset when all are in.
  const std::uint64_t in_memory = work.entries_split + kSubsets * work.lists_split;
  bench.check_accesses("subsets in memory", in_memory, in_memory);
  // On chip in both passes.
  const std::uint64_t on_chip = 2 * (work.split_entries + kSubsets * work.splits);
  bench.check_accesses("subsets on chip", on_chip, on_chip);
  const std::uint64_t in_network = work.chunk_entries + work.merged;
  bench.check_accesses("chunk", in_network, in_network);
  // Lists, and a mark behind each tile and the frame.
  const std::uint64_t marks = plan.lists.size() + 1;
  bench.check_accesses("loaded lists", work.loaded + marks, work.loaded + marks);
  bench.checks().equal(bench.bytes_read(), work.bytes_read, "bytes read");
  bench.checks().equal(bench.bytes_written(), work.bytes_written, "bytes written");
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
          finished.finish(0, bench.clock().now_cycles());
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
  if (plan.finish_after < 0) {
    bench.check_counter("dropped_loaded", 0);
    check_work(bench, plan, all);
  }
  checks.equal(bench.counter("entries_loaded") + bench.counter("entries_split"),
               bench.counter("entries_read"), "entries loaded and split");
  checks.equal(bench.counter("chunk_entries") + bench.counter("entries_in_order"), taken,
               "entries of chunks and in order");
  checks.equal(taken + bench.counter("dropped_loaded"), bench.counter("entries_loaded"),
               "entries sorted and dropped on chip");
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
      run_plan(test, still_bench(kGscoreMemoryBytes), plan);
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
