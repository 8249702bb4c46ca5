// The sorter of a core of the tile-centric machine against its clocked reference: every entry that
// comes out, and every mark.
#include <catch2/catch.hpp>

#include "modules/gscore/sorting/tile_sorter.h"
#include "testbench/units/gscore_bench.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/gscore/clocked/clocked_list_loader.h"

namespace sgs::test {
namespace {

using namespace gscore;

constexpr std::uint64_t kEndOfTile = 0xffffffff;
constexpr std::uint64_t kEndOfFrame = ~std::uint64_t{0};

struct SorterWorkload {
  const char* name;
  std::size_t longest = 200;  // list, of six
  std::uint32_t keys = 1000;  // different ones
  SorterHardware hardware;
  std::uint32_t out_one_in = 1, out_longest = 1, sorted_entries = 64;
  std::size_t finish_after = ~std::size_t{0};  // entries of a tile that come out
  NumberFormat key_format = NumberFormat::kHalf;
};

GscoreConfig config_of(const SorterWorkload& load) {
  const SorterHardware& hw = load.hardware;
  GscoreConfig config;
  config.cores = 1;
  config.lists.pool_bytes = 1 << 20;
  config.lists.line_bytes = hw.line_bytes;
  config.lists.block_lines = hw.block_lines;
  config.tiles.keys = load.key_format;
  config.sorting.chunk_entries = static_cast<std::uint32_t>(hw.chunk_entries);
  config.sorting.list_entries = static_cast<std::uint32_t>(hw.list_entries);
  config.sorting.list_buffers = hw.list_buffers;
  REQUIRE(config.entries().bytes() == hw.entry_bytes);
  return config;
}

// [tile] of one that is long, some, and one that is empty.
std::vector<std::vector<TileEntry>> lists_of(const SorterWorkload& load, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::vector<TileEntry>> lists;
  for (std::size_t t = 0; t < 6; ++t) {
    const std::size_t some = random() % (load.longest + 1);
    const std::size_t entries = t == 1 ? load.longest : t == 3 ? 0 : some;
    lists.push_back(tb::random_entries(random, config_of(load), entries, load.keys));
  }
  return lists;
}

std::uint64_t what_of(std::uint64_t tile, std::uint64_t record) { return tile << 32U | record; }
std::uint64_t what_of(const SortedEntry& entry) {
  if (entry.mark == EntryMark::kEndOfFrame) return kEndOfFrame;
  return what_of(entry.tile, entry.mark == EntryMark::kEntry ? entry.record : kEndOfTile);
}

// A block after the other, of all lists in turn.
std::vector<std::byte> pool_of(const BlockFormat& blocks,
                               const std::vector<std::vector<TileEntry>>& lists) {
  std::vector<std::vector<std::uint32_t>> chains;
  auto next = static_cast<std::uint32_t>(lists.size());
  for (std::uint32_t t = 0; t < lists.size(); ++t) {
    chains.push_back({t});
    while (chains[t].size() * blocks.block_entries() < lists[t].size()) chains[t].push_back(next++);
  }
  std::vector<std::byte> pool(std::size_t{next} * blocks.block_bytes());
  for (std::size_t t = 0; t < lists.size(); ++t) {
    const auto own = tb::chained_blocks(blocks, lists[t], chains[t], next);
    for (std::size_t i = 0; i < pool.size(); ++i) pool[i] |= own[i];
  }
  return pool;
}

// Tells that a tile is finished when so many of its entries have come.
class Finisher {
 public:
  explicit Finisher(std::size_t after) : after_(after) {}
  bool finishes(std::uint64_t what) {
    const std::uint64_t tile = what >> 32U;
    taken_ = tile == tile_ ? taken_ + 1 : 1;
    tile_ = tile;
    return what != kEndOfFrame && taken_ == after_;
  }

 private:
  const std::size_t after_;
  std::uint64_t tile_ = kEndOfFrame;
  std::size_t taken_ = 0;
};

void run_tile_sorter(tb::Case& test, Takings& taken, const SorterWorkload& load,
                     std::uint64_t seed) {
  const auto lists = lists_of(load, seed);
  tb::UnitBench bench(test, bench_of(load.hardware.port, tb::kGscoreMemoryBytes));
  FrameJob frame;
  frame.view.width = static_cast<int>(lists.size()) * kTilePx;
  frame.view.height = kTilePx;
  frame.layout = tb::empty_layout(static_cast<std::uint32_t>(load.longest));
  GscoreConfig config = config_of(load);
  const GscoreJob job = tb::gscore_frame(config, bench, frame);
  REQUIRE(job.lists.base % config.memory_port.max_transaction_bytes == 0);
  REQUIRE(job.subsets.base % config.memory_port.max_transaction_bytes == 0);
  bench.load(job.lists.base, pool_of(config.blocks(), lists));
  auto& requests = bench.add_fifo<TileRequest>("requests", 1, 1);
  auto& jobs = bench.add_fifo<TileJob>("jobs", 1, 1);
  auto& sorted = bench.add_fifo<SortedEntry>("sorted", load.sorted_entries, 1);
  FinishedTiles finished("finished_tiles", bench.clock(), lists.size(), 1);
  gscore::Phases phases;
  TileSorter unit("sorter", 0, {bench.clock(), job, config, phases}, finished);
  phases.drawing.begin();
  unit.requests(requests);
  unit.jobs(jobs);
  unit.sorted(sorted);
  bench.add_unit(unit);
  bench.add_thread("lister", [&](Activity& activity) {
    for (std::uint32_t t = 0; t < lists.size(); ++t) {
      requests.pop(activity);
      jobs.push({TileMark::kTile, t, t, static_cast<std::uint32_t>(lists[t].size())}, activity);
    }
    requests.pop(activity);
    jobs.push({TileMark::kEndOfFrame, 0, 0, 0}, activity);
  });
  const Pace pace(seed + 1000, load.out_one_in, load.out_longest);
  Finisher finisher(load.finish_after);
  bench.add_thread("rendering", [&](Activity& activity) {
    while (taken.empty() || taken.back().what != kEndOfFrame) {
      bench.clock().wait_cycles(pace.gap(taken.size()));
      const std::uint64_t what = what_of(sorted.pop(activity));
      const std::uint64_t now = bench.clock().now_cycles();
      if (finisher.finishes(what)) finished.finish(static_cast<std::uint32_t>(what >> 32U), now);
      taken.push_back({now, what});
    }
  });
  bench.run();
}

Takings clocked_tile_sorter(const SorterWorkload& load, std::uint64_t seed) {
  std::vector<LoadedList> tiles;
  for (const auto& list : lists_of(load, seed)) {
    LoadedList tile;
    tile.tile = static_cast<std::uint32_t>(tiles.size());
    tile.mark = what_of(tile.tile, kEndOfTile);
    for (const TileEntry& entry : list) tile.entries.push_back({entry.key, entry.record});
    tiles.push_back(std::move(tile));
  }
  tiles.push_back({true, 0, kEndOfFrame, {}});
  ClockedListLoader loader(load.hardware);
  ClockedListSorter sorter(load.hardware.chunk_entries);
  ClockedFifo<std::uint64_t> requests(1), sorted(load.sorted_entries);
  ClockedFifo<LoadedList> jobs(1), loaded(load.hardware.list_buffers + 2);
  ClockedSink<std::uint64_t> sink({seed + 1000, load.out_one_in, load.out_longest});
  Finisher finisher(load.finish_after);
  std::vector<bool> seen(tiles.size(), false), told(tiles.size(), false);
  const auto finished = [&](std::uint32_t tile) { return seen[tile]; };
  std::size_t next = 0;
  for (std::uint64_t now = 0; sink.taken().empty() || sink.taken().back().what != kEndOfFrame;
       ++now) {
    seen = told;
    const std::size_t before = sink.taken().size();
    sink.step(sorted, now);
    if (sink.taken().size() > before && finisher.finishes(sink.taken().back().what)) {
      told[sink.taken().back().what >> 32U] = true;
    }
    const std::uint32_t freed =
        sorter.step(loaded, sorted, finished,
                    [](std::uint64_t tile, std::uint64_t record) { return what_of(tile, record); });
    for (std::uint32_t f = 0; f < freed; ++f) loader.free_list();
    loader.step(requests, jobs, loaded, finished);
    if (requests.can_take() && jobs.has_room()) {
      requests.take();
      jobs.put(tiles[next++]);
    }
    requests.step();
    jobs.step();
    loaded.step();
    sorted.step();
  }
  return sink.taken();
}

TEST_CASE("clocked reference: tile sorter") {
  Comparison table("tile sorter");
  SorterHardware published;
  published.port = {port_of_preset("gscore", GscoreConfig{}.memory_port)};
  const SorterHardware short_lists =
      changed(published, [](SorterHardware& h) { h.list_entries = 512; });
  const SorterHardware tiny = changed(published, [](SorterHardware& h) {
    h.chunk_entries = 16;
    h.list_entries = 64;
    h.list_buffers = 1;
    h.port.config.max_writes = 1;
  });
  const SorterHardware slow_memory = changed(published, [](SorterHardware& h) {
    h.list_entries = 512;
    h.port.read_latency = 300;
    h.port.config.max_outstanding = 2;
  });
  const SorterHardware wide_keys = changed(published, [](SorterHardware& h) {
    h.entry_bytes = 8;
    h.line_bytes = 64;
    h.block_lines = 8;
    h.list_entries = 512;
  });
  for (const SorterWorkload& load : {
           SorterWorkload{"light: lists of up to 16", 16, 1000, published},
           SorterWorkload{"one chunk", 256, 1000, published},
           SorterWorkload{"split on chip", 1024, 60000, published},
           SorterWorkload{"heavy: split in memory", 3000, 60000, short_lists},
           SorterWorkload{"one key", 1500, 1, short_lists},
           SorterWorkload{"two keys", 2500, 2, short_lists},
           SorterWorkload{"output stalled", 900, 1000, published, 3, 60},
           SorterWorkload{"slow memory", 1500, 1000, slow_memory},
           SorterWorkload{"tiny buffers", 400, 60000, tiny, 4, 20, 1},
           SorterWorkload{"tiles that finish", 1500, 1000, short_lists, 1, 1, 64, 300},
           SorterWorkload{"keys of 32 bits", 1500, 60000, wide_keys, 1, 1, 64, ~std::size_t{0},
                          NumberFormat::kSingle},
       }) {
    table.workload(load, run_tile_sorter, clocked_tile_sorter);
  }
}

}  // namespace
}  // namespace sgs::test
