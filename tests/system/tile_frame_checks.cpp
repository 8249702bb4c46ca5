// Bytes, flow, bounds and rates of a view of the tile-centric machine.
#include "tests/system/tile_frame_checks.h"

#include <catch2/catch.hpp>
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
    CHECK(counter(view, "lister", "records") <= total(view, "converted") - total(view, "unseen"));
  }
  CHECK(region_bytes(view, "subsets", "write") >=
        entry * counter_of_all(view, "sorter", "entries_split"));
  const std::uint64_t pixel_bytes = view["config"]["framebuffer"] == "rgb32f" ? 12 : 3;
  CHECK(region_bytes(view, "frame_buffer", "write") ==
        pixel_bytes * counter_of_all(view, "rendering", "pixels"));
}

// A pass is projected, then drawn: what one waits for is what the other takes.
void check_phases(const Json& view) {
  const auto waited = [&](const char* unit, const char* activity, const char* what) {
    return count(view["units"][unit]["activities"][activity]["waited_cycles"][what]);
  };
  const std::uint64_t projecting = waited("rendering0", "drain", "phase");
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
  if (counter(view, "lister", "passes_overflowed") == 0) {
    CHECK(counter(view, "lister", "pairs") == counter_of_all(view, "sorter", "entries_sorted") +
                                                  counter_of_all(view, "sorter", "dropped_unread") +
                                                  counter_of_all(view, "sorter", "dropped_loaded"));
  }
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
  CHECK(busy(view, "rendering", "blend") >= of_cores("blocks") * turn("blend"));
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
  check_phases(view);
  check_bounds(view);
  check_rates(view);
}

}  // namespace sgs::test
