// The ledger of the tile-centric machine: what stands beside its lanes and what that did, by hand
// from what the hardware is said to be (modules/gscore/README.md).
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/testbench/ledger/simulated_frame.h"

namespace sgs::test {
namespace {

// A configuration, and widths of its registers.
struct Build {
  const char* name;
  Settings settings;
  double ccus, cores;
  // Multiplexers of two that a bit passes from one of the CCUs: a level for each halving.
  double levels;
  double end_bits;  // of a list: three numbers of blocks, a line of a block, an entry of a line
  double key_bits;
  double compared_bits, comparators;  // key and place of 16 bits, by comparators of 32
  double place_bits;                  // that counts to a chunk's entries
  double mark_bits;                   // for each level a number of the stack, and one of 8 subsets
  double row_bits, row_in_memory_bits;
  double loop, flight_bits;  // cycles of a splat in the loop, with its read and its write
  double pixel_bits;
};

const std::vector<Build>& builds() {
  static const std::vector<Build> all = {
      // 2^19 blocks of 16 lines of 5 entries; 7 levels of them in the stack. A subset's row has two
      // keys and two counts; in memory two keys, a number of the stack in 3 B, the end in 10 B.
      {"as published",
       {"lists.tiles=15", "lists.lines=6", "sorting.list_entries=512"},
       4,
       4,
       2,
       3 * 19 + 4 + 3,
       16,
       32,
       1,
       9,
       7 * (22 + 4),
       64,
       8 * (4 + 3 + 10),
       5,
       3,
       24},
      // 2^11 blocks of 8 lines of 6 entries; 12 levels; ends of lists in 5 B, of subsets in 7 B.
      {"floats",
       {"tiles.keys=fp32", "tiles.features=fp32", "rendering.precision=fp32", "framebuffer=rgb32f",
        "lists.line_bytes=64", "lists.block_lines=8", "lists.pool_bytes=1048576", "ccus=3",
        "cores=2", "sorting.chunk_entries=64", "sorting.list_entries=512", "lists.tiles=15",
        "lists.lines=6"},
       3,
       2,
       2,
       40,
       32,
       48,
       2,
       7,
       12 * (15 + 4),
       96,
       8 * (8 + 2 + 7),
       7,
       3,
       96}};
  return all;
}

// Of the units whose names begin so.
double of(const Frame& frame, const std::string& units, const std::string& name) {
  std::uint64_t sum = 0;
  for (const UnitResult& unit : frame.result.machine.units) {
    if (unit.name.rfind(units, 0) != 0) continue;
    for (const CounterResult& c : unit.counters) sum += c.name == name ? c.value : 0;
  }
  return static_cast<double>(sum);
}

// Parts of one kind, and what they did.
struct Stands {
  double parts = 0, done = 0;
};

Stands in_ledger(const MachineResult& machine, const std::string& component,
                 const std::string& kind) {
  Stands out;
  for (const Parts& p : machine.parts) {
    if (p.component != component || p.kind != kind) continue;
    out.parts += p.count;
    CHECK(p.per_cycle == p.count);
  }
  for (const Operations& o : machine.operations) {
    out.done += o.component == component && o.kind == kind ? o.count : 0;
  }
  return out;
}

// Of them beside and between lanes, which datapaths say of themselves.
Stands of_lanes(const MachineResult& machine, const std::string& component,
                const std::string& kind) {
  Stands out;
  for (const DatapathResult& d : machine.datapaths) {
    if (d.datapath.component != component) continue;
    const auto items = static_cast<double>(d.items);
    for (const BesideLanes& beside : d.datapath.beside) {
      if (beside.kind != kind) continue;
      out.parts += static_cast<double>(d.datapath.parts(beside));
      out.done += items * beside.operations;
    }
    const BetweenLanes& between = d.datapath.between;
    if (kind == "register_bit") {
      out.parts += d.datapath.copies * double(between.registers) + d.datapath.set_bits;
      out.done += items * between.written;
    }
    if (kind == "select_bit") {
      out.parts += d.datapath.copies * double(between.multiplexers);
      out.done += items * between.selected;
    }
  }
  return out;
}

struct Row {
  const char *component, *kind;
  double parts, done;  // beside what lanes have
};

std::vector<Row> rows_of(const Frame& frame, const Build& b) {
  const auto sorted = [&](const char* name) { return of(frame, "sorter", name); };
  const double gaussians = of(frame, "lister", "gaussians"), pairs = of(frame, "lister", "pairs");
  const double chunked = sorted("chunk_entries"), merged = sorted("merged"), turns = merged / 8;
  const double exchanges = sorted("compare_exchanges");
  const double all_splits = sorted("splits") + sorted("lists_split");
  const double blocks = of(frame, "rendering", "blocks");
  const double w = b.compared_bits, state_bits = b.pixel_bits == 24 ? 4 * 16 : 4 * 32;
  constexpr double kGaussian = 8 * 108;
  // Of the network's 10 stages of 8 compare-exchanges.
  constexpr double kExchanges = 80;
  // Four rows of 16 that turn banks, then 8 of half of them, 16 to the last stages, 8 that are
  // kept, 16 to where they are written; an entry passes four of these to a block, and four in a
  // merge.
  constexpr double kSelected = 4 * 16 + 8 + 16 + 8 + 16;
  // 7 pivots and the two at the ends; a range's next and its step are as wide as pivots.
  const double pivot_bits = 9 * b.key_bits;
  // A part and a block of 16, which is next: a bit each, and a number of 0 to 16 - 1 and the end.
  constexpr double kBlocks = 16, kNext = 5 + 16;
  return {
      // Whose line, whether line, block and pool are full; three subtractions for the line's place.
      {"lists", "comparator", 4, 4 * pairs},
      {"lists", "adder", 3, 3 * pairs},
      {"lists", "register_bit", kGaussian + b.end_bits, kGaussian * gaussians + b.end_bits * pairs},
      {"lists", "select_bit", kGaussian * (b.ccus - 1), kGaussian * b.levels * gaussians},
      // Another comparator chooses the run that a merge's turn takes 8 entries of.
      {"bsu", "comparator", b.cores * b.comparators * (kExchanges + 1),
       b.comparators * (exchanges + turns)},
      {"bsu", "exchange_bit", b.cores * kExchanges * w, exchanges * w},
      {"bsu", "select_bit", b.cores * kSelected * w, 4 * w * (chunked + merged)},
      // Of each of four pairs two entries and five places; the 16 entries that were read.
      {"bsu", "register_bit", b.cores * (4 * (2 * w + 5 * b.place_bits) + 16 * w),
       w * (chunked + merged) + (w + 2 * b.place_bits) * turns},
      // Two units: 7 pivots, two ends and a count for an entry; two adders of pivots, which make 7
      // of two sums and 8 places a split. What is split on chip passes twice.
      {"qsu", "comparator", b.cores * 2 * (7 + 2),
       9 * (sorted("entries_read") + 2 * sorted("split_entries"))},
      {"qsu", "adder", b.cores * 2 * (1 + 2),
       sorted("entries_read") + 2 * sorted("split_entries") + (2 * 7 + 8) * all_splits},
      // Beside them the rows that were written last.
      {"qsu", "register_bit",
       b.cores * (2 * (pivot_bits + b.mark_bits) + b.row_bits + b.row_in_memory_bits),
       (pivot_bits + b.mark_bits) * all_splits + 2 * b.row_bits * sorted("split_entries") +
           b.row_in_memory_bits * sorted("entries_split")},
      // A pixel that drains comes from any of 16 memories of one of two tiles.
      {"rendering", "select_bit", b.cores * 31 * state_bits,
       5 * state_bits * of(frame, "rendering", "pixels")},
      // Of each block until when it is in the loop, counted down, and that it is finished; a row of
      // 16 pixels that drains.
      {"rendering", "register_bit",
       b.cores * (kBlocks * (b.flight_bits + 1) + kNext + 16 * b.pixel_bits),
       blocks * (b.loop + 1 + kNext) + b.pixel_bits * of(frame, "rendering", "pixels")}};
}

void check_rows(const Frame& frame, const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    INFO(row.component << " " << row.kind);
    const Stands all = in_ledger(frame.result.machine, row.component, row.kind);
    const Stands lanes = of_lanes(frame.result.machine, row.component, row.kind);
    CHECK(all.parts - lanes.parts == row.parts);
    CHECK(all.done - lanes.done == row.done);
  }
}

TEST_CASE("ledger: gscore is charged for what its units are said to hold and do") {
  for (const Build& build : builds()) {
    INFO(build.name);
    const Frame frame = simulated("gscore", build.settings, "builtin:object?n=3000");
    check_paid(frame);
    // All that is charged has been done.
    for (const char* name : {"splits", "lists_split", "entries_split", "merged", "pairs"}) {
      INFO(name);
      CHECK(counter(frame, name) > 0);
    }
    check_rows(frame, rows_of(frame, build));
  }
}

TEST_CASE("ledger: gscore is charged for what its culler is said to hold and do") {
  const Frame frame =
      simulated("gscore_lossless_boxes", {"culling.nodes_tested=6"}, "builtin:outdoor?n=3000");
  check_paid(frame);
  const auto culled = [&](const char* name) { return of(frame, "culler", name); };
  const double nodes = culled("nodes"), chunks = culled("chunks");
  CHECK(nodes > 10);
  // Numbers of nodes that have been tested are compared with that of the next one, and first slots
  // in a tree; a chunk joins a run, which ends a slice. First and end of the run; a slice that
  // waits.
  constexpr double kRun = 2 * 32, kSlice = 8 * 6;
  const double looked = double(accesses(frame, "keys of tested nodes").reads) / 6 - nodes;
  check_rows(frame, {{"culler", "comparator", 6 + 5 + 2, 6 * nodes + 5 * looked + 2 * chunks},
                     {"culler", "register_bit", kRun + kSlice,
                      kRun * chunks + kSlice * culled("slices")}});
  CHECK(double(items(frame, "chunk_test")) == culled("tests"));
}

TEST_CASE("ledger: gscore's smallest memories hold what an access of them takes") {
  for (const char* preset : {"gscore", "gscore_lossless_boxes"}) {
    INFO(preset);
    check_paid(simulated(preset,
                         {"ccu.slice_gaussians=1", "ccu.input_slots=1", "ccu.candidates=1",
                          "ccu.second_half_slots=1", "ccu.output_entries=1"},
                         "builtin:object?n=64"));
  }
}

TEST_CASE("ledger: gscore's lanes have had what its units counted") {
  struct Path {
    const char *datapath, *units, *counter;
  };
  for (const Build& build : builds()) {
    INFO(build.name);
    const Frame frame = simulated("gscore", build.settings, "builtin:object?n=3000");
    for (const Path& path :
         {Path{"cull", "ccu", "first_halves"}, Path{"convert", "ccu", "converted"},
          Path{"tile_test", "lister", "tile_steps"}, Path{"part_test", "lister", "part_tests"},
          Path{"conic", "rendering", "splats"}, Path{"corner", "rendering", "blocks"},
          Path{"blend", "rendering", "blocks"}, Path{"drain", "rendering", "pixels"}}) {
      // Blending in halves takes the conic as the record has it.
      if (path.datapath == std::string("conic") && build.pixel_bits == 24) continue;
      INFO(path.datapath);
      CHECK(double(items(frame, path.datapath)) == of(frame, path.units, path.counter));
    }
  }
}

}  // namespace
}  // namespace sgs::test
