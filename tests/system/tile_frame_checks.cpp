// Bytes, flow, accesses, bounds and rates of a view of the tile-centric machine.
#include "tests/system/tile_frame_checks.h"

#include <catch2/catch.hpp>
#include <ostream>
#include <string>

#include "tests/system/frame_checks.h"
#include "tests/system/report_values.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

std::uint64_t count(const Json& value) { return value.get<std::uint64_t>(); }

// Bytes by region against counters of the units that asked.
void check_bytes(const Json& view) {
  const Json& tiles = view["config"]["tiles"];
  const bool half = tiles["features"] == "fp16";
  const std::uint64_t record = half ? 24 : 32, place = 32;
  const std::uint64_t entry =
      (tiles["keys"] == "fp16" ? 2 : 4) + (half ? 0 : 2) + (tiles["subtiles_across"] == 4 ? 6 : 4);
  CHECK(region_bytes(view, "projected", "write") == place * counter(view, "lister", "records"));
  CHECK(region_bytes(view, "projected", "read") ==
        record * counter_of_all(view, "rendering", "records"));
  const std::uint64_t pairs = counter(view, "lister", "pairs");
  const std::uint64_t lines =
      counter(view, "lister", "lines_full") + counter(view, "lister", "lines_displaced");
  const std::uint64_t line = count(view["config"]["lists"]["line_bytes"]);
  if (counter(view, "lister", "passes_overflowed") == 0) {
    CHECK(region_bytes(view, "tile_lists", "write") >= entry * pairs);
    CHECK(region_bytes(view, "tile_lists", "write") <=
          entry * pairs + line * (lines + counter(view, "lister", "tiles")));
    // Of two eyes a record each.
    CHECK(counter(view, "lister", "records") <=
          count(view["config"]["eyes"]) * (total(view, "converted") - total(view, "unseen")));
  }
  if (view["config"]["culling"]["by"] == "chunk_boxes") {
    CHECK(region_bytes(view, "chunk_table", "read") == 128 * counter(view, "culler", "nodes"));
  }
  CHECK(region_bytes(view, "subsets", "write") >=
        entry * counter_of_all(view, "sorter", "entries_split"));
  const std::uint64_t pixel_bytes = view["config"]["framebuffer"] == "rgb32f" ? 12 : 3;
  CHECK(region_bytes(view, "frame_buffer", "write") +
            region_bytes(view, "right_frame_buffer", "write") ==
        pixel_bytes * counter_of_all(view, "rendering", "pixels"));
}

// A pass is projected, then drawn: what one waits for is what the other takes. With two sets of
// lists nothing waits for a phase.
void check_phases(const Json& view) {
  const auto waited = [&](const char* unit, const char* activity, const char* what) {
    return count(view["units"][unit]["activities"][activity]["waited_cycles"][what]);
  };
  const std::uint64_t projecting = waited("rendering0", "drain", "phase");
  if (view["config"]["lists"]["sets"] != 1) {
    CHECK(projecting + waited("sorter0", "load", "phase") + waited("lister", "test", "phase") == 0);
    return;
  }
  const std::uint64_t drawing = frame_cycles(view) - projecting;
  CHECK(waited("sorter0", "load", "phase") == projecting);
  CHECK(waited("lister", "test", "phase") + waited("lister", "test", "idle") == drawing);
  // The end of the frame takes up to two cycles of each.
  for (const char* activity : {"load", "cull", "fetch", "convert"}) {
    const std::uint64_t spare =
        waited("ccu0", activity, "phase") + waited("ccu0", activity, "idle");
    CHECK(spare <= drawing);
    CHECK(spare + 2 >= drawing);
  }
}

// What one unit hands on the next receives.
void check_flow(const Json& view) {
  CHECK(total(view, "first_halves") == total(view, "culled") + total(view, "second_halves"));
  if (view["config"]["culling"]["by"] == "chunk_boxes") {
    CHECK(total(view, "first_halves") == counter(view, "culler", "gaussians"));
  }
  CHECK(total(view, "second_halves") == total(view, "converted"));
  CHECK(counter(view, "lister", "pairs") <= counter(view, "lister", "part_tests"));
  CHECK(counter(view, "lister", "part_tests") <= counter(view, "lister", "tile_tests"));
  CHECK(counter(view, "lister", "tiles") == counter_of_all(view, "rendering", "tiles"));
  CHECK(counter_of_all(view, "sorter", "entries_sorted") ==
        counter_of_all(view, "rendering", "records") +
            counter_of_all(view, "rendering", "dropped"));
  CHECK(counter_of_all(view, "rendering", "records") ==
        counter_of_all(view, "rendering", "splats") +
            counter_of_all(view, "rendering", "dropped_fetched"));
  CHECK(counter_of_all(view, "rendering", "contributors") == count(view["image"]["blends"]));
  const auto sorted = [&](const char* name) { return counter_of_all(view, "sorter", name); };
  CHECK(sorted("entries_read") == sorted("entries_loaded") + sorted("entries_split"));
  CHECK(sorted("entries_sorted") == sorted("chunk_entries") + sorted("entries_in_order"));
  CHECK(sorted("entries_loaded") == sorted("entries_sorted") + sorted("dropped_loaded"));
  // A read is of one second half at least, and of no more than the ring of slots has.
  CHECK(total(view, "runs") <= total(view, "second_halves"));
  CHECK(total(view, "runs") * count(view["config"]["ccu"]["second_half_slots"]) >=
        total(view, "second_halves"));
  CHECK(total(view, "unseen") <= total(view, "converted"));
  if (counter(view, "lister", "passes_overflowed") == 0) {
    CHECK(counter(view, "lister", "pairs") == counter_of_all(view, "sorter", "entries_sorted") +
                                                  counter_of_all(view, "sorter", "dropped_unread") +
                                                  counter_of_all(view, "sorter", "dropped_loaded"));
  }
}

// Reads and writes of one use of on-chip memory, of all units that have it.
struct Accesses {
  std::uint64_t reads = 0, writes = 0;
};
bool operator==(const Accesses& a, const Accesses& b) {
  return a.reads == b.reads && a.writes == b.writes;
}
std::ostream& operator<<(std::ostream& out, const Accesses& a) {
  return out << a.reads << " reads, " << a.writes << " writes";
}
Accesses accesses(const Json& view, const std::string& use) {
  for (const Json& u : view["sram"]["uses"]) {
    if (u["name"] == use) return {count(u["reads"]), count(u["writes"])};
  }
  FAIL_CHECK("no use " << use);
  return {};
}
// What is put in is taken out.
Accesses both(std::uint64_t accesses) { return {accesses, accesses}; }

// Of projection. A Gaussian whose tiles are tested is kept until the last of them is listed.
void check_projection_accesses(const Json& view) {
  const auto of = [&](const char* name) { return counter(view, "lister", name); };
  const std::uint64_t words = (count(view["scene"]["second_half_bytes"]) + 31) / 32;
  CHECK(accesses(view, "first halves") == both(total(view, "first_halves")));
  CHECK(accesses(view, "second halves") == both(total(view, "second_halves") * words));
  // A slice is gathered of what leaves the queue, and goes on from there.
  CHECK(accesses(view, "candidates of a slice") == accesses(view, "candidates"));
  CHECK(accesses(view, "fetched candidates") == accesses(view, "candidates"));
  const std::uint64_t kept = of("gaussians") - of("gaussians_off_pass");
  CHECK(accesses(view, "records under test") == Accesses{of("records"), kept});
  CHECK(accesses(view, "keys under test") == Accesses{of("pairs"), kept});
  if (view["datapath"].contains("part_test")) {
    CHECK(accesses(view, "boxes under test") == Accesses{of("part_tests"), kept});
  }
  CHECK(accesses(view, "listed tiles") == both(of("pairs") + of("passes")));
  CHECK(accesses(view, "records to write") == both(of("records")));
  // Each entry asks whose line it is; behind the last of a pass every line is looked at.
  const std::uint64_t looks = of("pairs") + of("passes") * count(view["config"]["lists"]["lines"]);
  CHECK(accesses(view, "tiles of lines").reads == looks);
  CHECK(accesses(view, "ends of lists").reads == of("pairs") + of("tiles"));
  if (of("passes_overflowed") > 0) return;
  CHECK(accesses(view, "tiles of lines").writes == looks);
  CHECK(accesses(view, "ends of lists").writes == of("pairs") + of("tiles"));
  // Words of 8 B; an entry lies in three of them at most, and none leaves that was not written.
  const auto [reads, writes] = accesses(view, "lines of lists");
  CHECK(8 * reads >= region_bytes(view, "tile_lists", "write"));
  CHECK(reads <= writes);
  CHECK(writes >= of("pairs"));
  CHECK(writes <= 3 * of("pairs"));
}

// Those that were drawn.
std::uint64_t good_passes(const Json& view) {
  return counter(view, "lister", "passes") - counter(view, "lister", "passes_overflowed");
}

constexpr std::uint64_t kPivots = 7, kSubsets = 8;

// That many pivots were read one by one, of no more lists than were split.
bool pivots_of(std::uint64_t reads, std::uint64_t lists) {
  return reads % kPivots == 0 && reads / kPivots <= lists && (reads > 0 || lists == 0);
}

// Of sorting. A split reads its list twice, for sizes and for places; its subsets' rows are read
// and written for each entry, then for each subset.
void check_sorting_accesses(const Json& view) {
  const auto of = [&](const char* name) { return counter_of_all(view, "sorter", name); };
  const Accesses blocks = accesses(view, "list blocks"), lists = accesses(view, "lists on chip"),
                 keys = accesses(view, "keys of subsets"),
                 lines = accesses(view, "lines of subsets");
  CHECK(32 * blocks.writes >=
        region_bytes(view, "tile_lists", "read") + region_bytes(view, "subsets", "read"));
  CHECK(pivots_of(blocks.reads - blocks.writes, of("lists_split")));
  CHECK(lists.writes == of("entries_loaded"));
  CHECK(keys.writes == of("split_entries"));
  // A list's keys, or those of its subsets, go to the splits and to the network; what comes out is
  // read from the list, and where it is in order as a subset, by its place.
  const std::uint64_t besides = lists.reads + keys.reads - 2 * of("split_entries") -
                                of("chunk_entries") - of("entries_sorted");
  const std::uint64_t in_order = of("splits") > 0 ? of("entries_in_order") : 0;
  CHECK(besides <= kPivots * of("splits") + in_order);
  if (in_order == 0) CHECK(pivots_of(besides, of("splits")));
  CHECK(8 * lines.reads >= region_bytes(view, "subsets", "write"));
  CHECK(lines.reads <= lines.writes);
  CHECK(lines.writes >= of("entries_split"));
  CHECK(lines.writes <= 3 * of("entries_split"));
  CHECK(accesses(view, "subsets in memory") ==
        both(of("entries_split") + kSubsets * of("lists_split")));
  CHECK(accesses(view, "subsets on chip") ==
        both(2 * (of("split_entries") + kSubsets * of("splits"))));
  CHECK(accesses(view, "chunk") == both(of("chunk_entries") + of("merged")));
  // Lists, and a mark behind each tile and each pass.
  const Accesses loaded = accesses(view, "loaded lists");
  CHECK(loaded.reads == loaded.writes);
  CHECK(loaded.writes >= of("tiles") + good_passes(view) * count(view["config"]["cores"]));
}

// Of rendering: pixels where alpha passes, the last time without a write; each is cleared as it is
// drained.
void check_rendering_accesses(const Json& view) {
  const auto of = [&](const char* name) { return counter_of_all(view, "rendering", name); };
  CHECK(accesses(view, "records") == both(of("records")));
  CHECK(accesses(view, "finished parts") == both(of("splats")));
  const auto [reads, writes] = accesses(view, "pixel state");
  CHECK(writes == of("contributors") + of("pixels"));
  CHECK(reads >= writes);
  CHECK(reads <= writes + of("pixels"));
  CHECK(of("contributors") <= 16 * of("blocks"));
  CHECK(accesses(view, "finished pixels").reads == 16 * of("blocks"));
  CHECK(accesses(view, "finished pixels").writes == reads - writes + 256 * of("tiles"));
}

// Savings that more than one unit may know of, and those that are differences.
void check_left_out(const Json& view) {
  const auto sorted = [&](const char* name) { return counter_of_all(view, "sorter", name); };
  const auto drawn = [&](const char* name) { return counter_of_all(view, "rendering", name); };
  CHECK(left_out(view, "gaussians_off_frame") == total(view, "culled"));
  CHECK(left_out(view, "entries_of_finished_tiles") ==
        sorted("dropped_unread") + sorted("dropped_loaded"));
  CHECK(left_out(view, "reads_of_finished_tiles") == sorted("dropped_unread"));
  CHECK(left_out(view, "records_of_finished_tiles") == drawn("dropped"));
  // Where no row of tiles is tested for two passes.
  if (counter(view, "lister", "passes") == 1) {
    CHECK(left_out(view, "tiles_not_touched") ==
          counter(view, "lister", "tile_tests") - counter(view, "lister", "pairs"));
  }
  CHECK(left_out(view, "blocks_not_touched") == 16 * drawn("splats") - drawn("blocks"));
}

// Closed forms that no frame is faster than.
void check_bounds(const Json& view) {
  const std::uint64_t frame = frame_cycles(view);
  const Json& config = view["config"];
  CHECK(counter(view, "lister", "pairs") + counter(view, "lister", "tiles") <= frame);
  const std::uint64_t ccus = count(config["ccus"]), cores = count(config["cores"]);
  const auto interval = [&](const char* datapath, const Json& lanes) {
    const std::uint64_t macs = count(view["datapath"][datapath]["used"]["macs"]);
    const std::uint64_t of = count(lanes);
    return (macs + of - 1) / of;
  };
  CHECK(total(view, "first_halves") * interval("cull", config["ccu"]["cull_lanes"]) <=
        ccus * frame);
  CHECK(total(view, "converted") * interval("convert", config["ccu"]["convert_lanes"]) <=
        ccus * frame);
  const Json& lists = config["lists"];
  CHECK(counter(view, "lister", "tile_steps") * interval("tile_test", lists["tile_lanes"]) <=
        frame);
  CHECK(counter(view, "lister", "tile_steps") * count(lists["tiles_at_once"]) >=
        counter(view, "lister", "tile_tests"));
  if (view["datapath"].contains("part_test")) {
    CHECK(counter(view, "lister", "part_tests") * interval("part_test", lists["part_lanes"]) <=
          frame);
  }
  CHECK(counter_of_all(view, "rendering", "blocks") <= cores * frame);
  CHECK(counter_of_all(view, "sorter", "entries_read") <= cores * frame);
}

// Cycles that an activity of all units of a kind worked.
std::uint64_t busy(const Json& view, const std::string& units, const char* activity) {
  std::uint64_t sum = 0;
  for (const auto& [name, unit] : view["units"].items()) {
    if (name.rfind(units, 0) == 0) sum += cycles(view, name, activity);
  }
  return sum;
}

// No unit works for less time than its work takes at its rate.
void check_rates(const Json& view) {
  const Json& config = view["config"];
  const auto turn = [&](const char* datapath) {
    return count(view["datapath"][datapath]["used"]["interval_cycles"]);
  };
  const auto of_lister = [&](const char* name) { return counter(view, "lister", name); };
  const auto of_sorters = [&](const char* name) { return counter_of_all(view, "sorter", name); };
  const auto of_cores = [&](const char* name) { return counter_of_all(view, "rendering", name); };
  CHECK(busy(view, "ccu", "load") * count(config["ccu"]["slice_gaussians"]) >=
        total(view, "first_halves"));
  CHECK(busy(view, "ccu", "cull") >= total(view, "first_halves") * turn("cull"));
  CHECK(busy(view, "ccu", "fetch") >= total(view, "second_halves"));
  CHECK(busy(view, "ccu", "convert") >= total(view, "converted") * turn("convert"));
  CHECK(busy(view, "lister", "test") >= of_lister("tile_steps") * turn("tile_test"));
  if (view["datapath"].contains("part_test")) {
    CHECK(busy(view, "lister", "test") >= of_lister("part_tests") * turn("part_test"));
  }
  CHECK(busy(view, "lister", "list") >= of_lister("pairs") + of_lister("tiles"));
  CHECK(busy(view, "sorter", "load") >= of_sorters("entries_read"));
  // Each split passes its QSU twice; a chunk takes a cycle for 16 entries into the network, for 8
  // in each level of merging, and what is sorted leaves an entry a cycle.
  CHECK(busy(view, "sorter", "sort") >=
        2 * of_sorters("split_entries") + of_sorters("chunk_entries") / 16 +
            of_sorters("merged") / 8 + of_sorters("entries_sorted"));
  CHECK(busy(view, "rendering", "fetch") >= of_cores("records") + of_cores("dropped"));
  // A cycle for each tile's end, the pass's in each core, and what is dropped; at most for a splat
  // too, of which no part is left, before any splat until the lanes' next turn, and as long as the
  // blocks that are left out, while the conic's lanes do whole parts.
  const std::uint64_t blending = of_cores("blocks") * turn("blend") + of_cores("hazard_cycles") +
                                 of_cores("tiles") + of_cores("dropped_fetched") +
                                 good_passes(view) * count(config["cores"]);
  CHECK(busy(view, "rendering", "blend") >= blending);
  CHECK(busy(view, "rendering", "blend") <= blending + of_cores("parts_finished") +
                                                of_cores("blocks_finished") * turn("blend") +
                                                (turn("blend") - 1) * of_cores("splats"));
  CHECK(busy(view, "rendering", "blend") >= of_cores("splats"));
  CHECK(busy(view, "rendering", "drain") * count(config["rendering"]["drain_pixels_per_cycle"]) >=
        of_cores("pixels"));
}

}  // namespace

void check_tile_machine(const Json& view) {
  check_any_machine(view);
  check_halves(view);
  check_bytes(view);
  check_flow(view);
  check_projection_accesses(view);
  check_sorting_accesses(view);
  check_rendering_accesses(view);
  check_left_out(view);
  check_phases(view);
  check_bounds(view);
  check_rates(view);
}

}  // namespace sgs::test
