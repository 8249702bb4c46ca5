// Tile lister alone: Gaussians with their boxes of several CCUs in; projected records and chained
// lists in memory, tiles handed out. Checked by walking the chains; busy cycles against closed
// forms.
#include <cstring>
#include <optional>

#include "modules/datapath/work_rates.h"
#include "modules/gscore/gscore_datapaths.h"
#include "modules/gscore/lists/tile_lister.h"
#include "testbench/units/gscore_bench.h"
#include "testbench/units/random_scene.h"

namespace sgs::tb {
namespace {

struct Plan {
  GscoreConfig config;
  int columns = 4, rows = 3;
  int tiles_each = 1;
  std::vector<Converted> gaussians;
};

// Boxes of up to tiles_each x tiles_each tiles.
Plan make_plan(const GscoreConfig& config, std::mt19937_64& random, std::size_t gaussians,
               int tiles_each) {
  Plan plan;
  plan.config = config;
  plan.tiles_each = tiles_each;
  plan.gaussians.resize(gaussians);
  for (Converted& g : plan.gaussians) {
    g.there = random() % 8 != 0;
    g.splat.x = uniform(random, -50, 50);
    g.splat.conic_a = g.splat.conic_c = 0.5F;
    g.splat.opacity = uniform(random, 0.1F, 1);
    g.splat.depth = uniform(random, 1, 9);
    PixelRect& tiles = g.boxes.tiles;
    tiles.x0 = whole(random, 0, plan.columns - 1);
    tiles.y0 = whole(random, 0, plan.rows - 1);
    tiles.x1 = std::min(plan.columns, tiles.x0 + whole(random, 1, tiles_each));
    tiles.y1 = std::min(plan.rows, tiles.y0 + whole(random, 1, tiles_each));
    // A part of the first tile is not touched.
    g.boxes.parts = {4 * tiles.x0 + whole(random, 0, 2), 4 * tiles.y0, 4 * tiles.x1, 4 * tiles.y1};
  }
  return plan;
}

// Its tiles in the pass, in order, with their bits.
std::vector<std::pair<std::uint32_t, std::uint32_t>> tiles_of(const Converted& g,
                                                              const GscoreConfig& config,
                                                              const GscoreJob& job,
                                                              const Pass& pass) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
  if (!g.there) return out;
  for (int y = g.boxes.tiles.y0; y < g.boxes.tiles.y1; ++y) {
    for (int x = g.boxes.tiles.x0; x < g.boxes.tiles.x1; ++x) {
      const auto tile = static_cast<std::uint32_t>(y) * job.columns + static_cast<std::uint32_t>(x);
      if (tile < pass.first || tile >= pass.end) continue;
      const std::uint32_t bits = tile_bitmap(g.boxes, config.tiles.rules(), x, y);
      if (bits != 0) out.emplace_back(tile, bits);
    }
  }
  return out;
}

// Tests of a pass, by boxes; counted beside the unit.
struct Tests {
  std::uint64_t steps = 0, tiles = 0, touched = 0, off_pass = 0, records = 0;
};

void add_tests(const Converted& g, const GscoreConfig& config, const GscoreJob& job,
               const Pass& pass, Tests& tests) {
  if (!g.there) return;
  tests.records += tiles_of(g, config, job, pass).empty() ? 0 : 1;
  const PixelRect& box = g.boxes.tiles;
  const auto columns = static_cast<int>(job.columns);
  std::uint64_t rows = 0;
  for (int y = box.y0; y < box.y1; ++y) {
    // Rows of which the pass has a tile.
    const auto row = static_cast<std::uint32_t>(y * columns);
    if (row + job.columns <= pass.first || row >= pass.end) continue;
    ++rows;
    for (int x = box.x0; x < box.x1; ++x) {
      const std::uint32_t tile = row + static_cast<std::uint32_t>(x);
      if (tile < pass.first || tile >= pass.end) continue;
      tests.touched += touches_tile(g.boxes, x, y) ? 1 : 0;
    }
  }
  const auto width = static_cast<std::uint64_t>(box.x1 - box.x0);
  tests.steps += rows * cycles_for(width, config.lists.tiles_at_once);
  tests.tiles += rows * width;
  tests.off_pass += rows == 0 ? 1 : 0;
}

// Lists as they grow line by line, each tile's in the line that it shares with others; where the
// pool suffices.
struct Lists {
  std::uint64_t blocks = 0, full = 0, displaced = 0;
  std::uint64_t words_read = 0, words_written = 0, bytes = 0;
  std::uint64_t read_cycles = 0;  // four words each, of lines that leave between entries
};

// Words of 8 B of a block that its bytes [begin, end) lie in.
std::uint64_t words_of(std::uint32_t begin, std::uint32_t end) {
  return begin == end ? 0 : (end - 1) / 8 - begin / 8 + 1;
}

Lists lists_of(const Plan& plan, const GscoreConfig& config, const GscoreJob& job) {
  struct Line {
    std::uint32_t tile = 0, begin = 0, end = 0;  // bytes of its block that are not in memory yet
  };
  Lists out;
  const BlockFormat blocks = config.blocks();
  const auto write = [&](Line& line) {
    const std::uint64_t words = words_of(line.begin, line.end);
    out.words_read += words;
    out.bytes += line.end - line.begin;
    line.begin = line.end;
    return (words + 3) / 4;
  };
  for (std::uint32_t first = 0; first < job.tile_count; first += config.lists.tiles) {
    const Pass pass{first, std::min(first + config.lists.tiles, job.tile_count), false};
    std::vector<std::uint32_t> entries(job.tile_count);
    std::vector<Line> lines(config.lists.lines);
    for (const Converted& g : plan.gaussians) {
      for (const auto& [tile, bits] : tiles_of(g, config, job, pass)) {
        const std::uint32_t entry = entries[tile]++ % blocks.block_entries();
        const std::uint32_t end = blocks.offset(entry) + blocks.entry.bytes();
        // The first of a block brings its link.
        const std::uint32_t begin = entry == 0 ? 0 : blocks.offset(entry);
        out.blocks += entry == 0 ? 1 : 0;
        Line& line = lines[(tile - first) % lines.size()];
        if (line.begin < line.end && line.tile != tile) {
          ++out.displaced;
          out.read_cycles += write(line);
        }
        if (line.begin == line.end) line = {tile, begin, end};
        line.end = end;
        out.words_written += words_of(begin, end);
        const std::uint32_t end_of_line = (begin / blocks.line_bytes + 1) * blocks.line_bytes;
        if (end + blocks.entry.bytes() <= end_of_line) continue;
        ++out.full;
        out.read_cycles += write(line);
      }
    }
    for (Line& line : lines) write(line);
  }
  return out;
}

// The pool has the first block of each tile's list, and those behind that are taken ahead of need;
// where it is too small the pass is made again with half of its tiles.
struct Passes {
  std::uint64_t made = 0, overflowed = 0;
};

Passes passes_of(const Plan& plan, const GscoreConfig& config, const GscoreJob& job) {
  Passes out;
  std::uint32_t most = config.lists.tiles;
  for (std::uint32_t first = 0; first < job.tile_count;) {
    const Pass pass{first, std::min(first + most, job.tile_count), false};
    std::vector<std::uint64_t> entries(job.tile_count);
    for (const Converted& g : plan.gaussians) {
      for (const auto& [tile, bits] : tiles_of(g, config, job, pass)) ++entries[tile];
    }
    const std::uint32_t tiles = pass.end - first;
    std::uint64_t blocks = tiles;
    for (const std::uint64_t n : entries) blocks += cycles_for(n, config.blocks().block_entries());
    ++out.made;
    if (blocks > config.pool_blocks()) {
      ++out.overflowed;
      most = (tiles + 1) / 2;
    } else {
      first = pass.end;
    }
  }
  return out;
}

void check_tests(UnitBench& bench, const GscoreConfig& config, const Tests& tests,
                 std::uint64_t gaussians, std::uint64_t pairs) {
  bench.check_counter("gaussians_off_pass", tests.off_pass);
  bench.check_counter("tile_steps", tests.steps);
  bench.check_counter("tile_tests", tests.tiles);
  bench.check_counter("part_tests", tests.touched);
  bench.check_counter("records", tests.records);
  const std::uint64_t kept = gaussians - tests.off_pass;
  bench.check_accesses("records to write", tests.records, tests.records);
  bench.check_accesses("records under test", tests.records, kept);
  bench.check_accesses("keys under test", pairs, kept);
  if (config.tiles.subtiles_across > 1) {
    bench.check_accesses("boxes under test", tests.touched, kept);
  }
}

void check_lists(UnitBench& bench, const Plan& plan, const GscoreJob& job, std::uint64_t records,
                 std::uint64_t pairs) {
  const GscoreConfig& config = plan.config;
  const Passes passes = passes_of(plan, config, job);
  bench.check_counter("passes", passes.made);
  bench.check_counter("passes_overflowed", passes.overflowed);
  // Whose line it is is asked for each entry, and of each line at a pass's end.
  const std::uint64_t looks = pairs + passes.made * config.lists.lines;
  bench.checks().equal(bench.accesses("tiles of lines").first, looks, "tiles of lines: reads");
  bench.checks().equal(bench.accesses("ends of lists").first, pairs + job.tile_count,
                       "ends of lists: reads");
  if (passes.overflowed > 0) return;
  bench.check_accesses("tiles of lines", looks, looks);
  bench.check_accesses("ends of lists", pairs + job.tile_count, pairs + job.tile_count);
  const Lists lists = lists_of(plan, config, job);
  bench.check_counter("blocks", lists.blocks);
  bench.check_counter("lines_full", lists.full);
  bench.check_counter("lines_displaced", lists.displaced);
  bench.check_counter("line_cycles", lists.read_cycles);
  bench.check_accesses("lines of lists", lists.words_read, lists.words_written);
  bench.checks().equal(bench.bytes_written(), records * kRecordPlaceBytes + lists.bytes,
                       "bytes written");
}

void run_plan(Case& test, const BenchConfig& bench_config, Plan plan) {
  UnitBench bench(test, bench_config);
  Checks& checks = bench.checks();
  GscoreConfig& config = plan.config;
  FrameJob frame;
  frame.view.width = plan.columns * kTilePx;
  frame.view.height = plan.rows * kTilePx;
  frame.layout = empty_layout(static_cast<std::uint32_t>(plan.gaussians.size()));
  const GscoreJob job = gscore_frame(config, bench, frame);
  const BlockFormat blocks = config.blocks();
  auto passes = bench.add_fifos<Pass>("passes", config.ccus, 1, 1);
  auto converted = bench.add_fifos<Converted>("converted", config.ccus, 4, 1);
  auto requests = bench.add_fifos<TileRequest>("requests", config.cores, 1, 1);
  auto jobs = bench.add_fifos<TileJob>("jobs", config.cores, 1, 1);
  auto done = bench.add_fifos<PassDone>("done", config.cores, 1, 1);
  bool frame_done = false;
  gscore::Phases phases;
  TileLister unit("lister", {bench.clock(), job, config, phases},
                  [&](std::uint32_t) { frame_done = true; });
  for (auto* fifo : passes) unit.passes(*fifo);
  for (auto* fifo : converted) unit.converted(*fifo);
  for (auto* fifo : requests) unit.requests(*fifo);
  for (auto* fifo : jobs) unit.jobs(*fifo);
  for (auto* fifo : done) unit.done(*fifo);
  bench.add_unit(unit);

  std::uint64_t pairs = 0, there = 0, alone = 0;
  Tests tests;
  std::optional<Pass> current;
  for (std::uint32_t c = 0; c < config.ccus; ++c) {
    bench.add_thread(fmt::format("ccu{}", c), [&, c](Activity& activity) {
      const std::size_t size = config.ccu.slice_gaussians;
      for (Pass pass = passes[c]->pop(activity); !pass.over; pass = passes[c]->pop(activity)) {
        current = pass;
        for (std::size_t first = c * size; first < plan.gaussians.size();
             first += config.ccus * size) {
          for (std::size_t i = first; i < std::min(first + size, plan.gaussians.size()); ++i) {
            pairs += tiles_of(plan.gaussians[i], config, job, pass).size();
            add_tests(plan.gaussians[i], config, job, pass, tests);
            Converted next = plan.gaussians[i];
            next.last = i + 1 == std::min(first + size, plan.gaussians.size());
            next.end_of_pass = i + 1 == plan.gaussians.size();
            if (next.there || next.last) converted[c]->push(next, activity);
            there += next.there ? 1 : 0;
            alone += next.last && !next.there ? 1 : 0;
          }
        }
      }
    });
  }

  // Checks the pass: records are in the order of the scene, each list in the order of its records.
  std::vector<bool> seen(job.tile_count);
  std::uint64_t longest = 0, empty = 0;
  const auto check_tile = [&](const TileJob& tile) {
    checks.that(!seen[tile.tile], "a tile once");
    seen[tile.tile] = true;
    std::uint32_t record = 0, entry = 0, block = tile.first_block;
    std::vector<std::byte> bytes;
    for (const Converted& g : plan.gaussians) {
      const auto tiles = tiles_of(g, config, job, *current);
      if (tiles.empty()) continue;
      const std::uint32_t number = record++;
      for (const auto& [listed_tile, bits] : tiles) {
        if (listed_tile != tile.tile) continue;
        if (entry % blocks.block_entries() == 0) {
          if (entry > 0) std::memcpy(&block, bytes.data(), sizeof block);
          bytes = bench.read_back(job.lists.base + std::uint64_t{block} * blocks.block_bytes(),
                                  blocks.block_bytes());
        }
        const TileEntry got = decode_entry(blocks.entry, bytes.data() + blocks.offset(entry));
        ++entry;
        checks.that(got.key == depth_key(config.tiles.keys, g.splat.depth) &&
                        got.record == number && got.bitmap == bits &&
                        got.opacity == listed_opacity(config.tiles.features, g.splat.opacity),
                    fmt::format("entry {} of tile {}", entry, tile.tile));
      }
      const auto at =
          bench.read_back(job.projected.address(number), record_bytes(config.tiles.features));
      checks.that(decode_projected(config.tiles.features, at.data(), 0).x == g.splat.x, "a record");
    }
    checks.equal(tile.entries, entry, "entries of a list");
    longest = std::max<std::uint64_t>(longest, tile.entries);
    if (tile.entries == 0) ++empty;
  };
  for (std::uint32_t c = 0; c < config.cores; ++c) {
    bench.add_thread(fmt::format("core{}", c), [&, c](Activity& activity) {
      for (TileMark mark = TileMark::kTile; mark != TileMark::kEndOfFrame;) {
        requests[c]->push({}, activity);
        const TileJob tile = jobs[c]->pop(activity);
        mark = tile.mark;
        if (mark == TileMark::kTile) {
          check_tile(tile);
        } else {
          done[c]->push({}, activity);
        }
      }
    });
  }
  bench.run();

  checks.that(frame_done, "the frame is done");
  for (const bool tile : seen) checks.that(tile, "every tile handed out");
  bench.check_counter("pairs", pairs);
  bench.check_counter("tiles", job.tile_count);
  const std::uint64_t made = bench.counter("passes");
  bench.check_counter("gaussians", there);
  bench.check_counter("ends_alone", alone);
  check_tests(bench, config, tests, there, pairs);
  check_lists(bench, plan, job, tests.records, pairs);
  // A step of neighbours takes a turn of its lanes, or one of the parts' lanes for each that is
  // touched.
  const std::uint64_t tile = tile_test_pipeline(config).interval_cycles();
  const std::uint64_t part =
      config.tiles.subtiles_across > 1 ? part_test_pipeline(config).interval_cycles() : 1;
  const std::uint64_t beside = made + alone + bench.counter("gaussians_off_pass");
  const std::uint64_t busy = bench.busy_cycles("tile tests");
  checks.that(busy >= beside + bench.counter("tile_steps") * tile, "bound of tile tests");
  checks.that(busy >= beside + bench.counter("part_tests") * part, "bound of tests of parts");
  if (tile == 1 && part == 1 && made == 1 && plan.tiles_each == 1) {
    checks.equal(busy, beside + bench.counter("tile_steps"), "cycles of tile tests");
  }
  // A listed tile, a tile and each core's end a cycle; a line and a row of the table each pass;
  // lines that are read between entries.
  const std::uint64_t good = made - bench.counter("passes_overflowed");
  const std::uint64_t table = bench.accesses("ends of lists").second - pairs;
  checks.equal(bench.busy_cycles("listing"),
               pairs + bench.counter("line_cycles") + job.tile_count + good * config.cores +
                   made * config.lists.lines + table,
               "cycles of listing");
  if (made == 1) {
    bench.check_counter("tiles_empty", empty);
    bench.check_counter("list_entries_max", longest);
  }
}

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  GscoreConfig config = random_gscore(random);
  config.ccus = 1 + static_cast<std::uint32_t>(random() % 4);
  config.cores = 1 + static_cast<std::uint32_t>(random() % 4);
  config.lists.tiles_at_once = 1 + static_cast<std::uint32_t>(random() % 3);
  constexpr std::size_t kCounts[] = {0, 1, 9, 100, 400};
  const std::size_t gaussians = kCounts[random() % 5];
  if (random() % 3 == 0) {  // hardly more than one tile needs
    const BlockFormat blocks = config.blocks();
    config.lists.pool_bytes = std::max<std::uint64_t>(
        4096, (gaussians / blocks.block_entries() + 3) * blocks.block_bytes());
  }
  run_plan(test, random_bench(random, kGscoreMemoryBytes),
           make_plan(config, random, gaussians, 1 + static_cast<int>(random() % 4)));
}

}  // namespace
}  // namespace sgs::tb

int sc_main(int argc, char* argv[]) {
  using namespace sgs;
  using namespace sgs::tb;
  CaseRunner runner("tb_tile_lister", "Tile lister alone, against chains walked in memory");
  const auto directed = [&](const char* name, std::size_t gaussians, int tiles_each,
                            std::uint32_t tiles, std::uint32_t lines, std::uint64_t pool_bytes) {
    runner.add_directed(name, [=](Case& test) {
      GscoreConfig config;
      config.lists.tiles = tiles;
      config.lists.lines = lines;
      config.lists.pool_bytes = pool_bytes;
      run_plan(test, still_bench(kGscoreMemoryBytes),
               make_plan(config, test.random, gaussians, tiles_each));
    });
  };
  directed("no Gaussian", 0, 1, 64, 64, 1 << 20);
  directed("lists of many blocks", 500, 4, 64, 64, 1 << 20);
  directed("tiles that share lines", 300, 3, 64, 3, 1 << 20);
  directed("a pass of few tiles", 100, 2, 5, 64, 1 << 20);
  directed("a pool that overflows", 500, 4, 64, 64, 10 << 10);
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
