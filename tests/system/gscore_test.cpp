// Whole frames of the tile-centric machine through the command: the golden picture bit for bit and
// everything accounted for, whatever the parameters, the stalls and the order of processes.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/support/shared_inputs.h"
#include "tests/system/frame_checks.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;
using Json = nlohmann::json;

std::uint64_t count(const Json& value) { return value.get<std::uint64_t>(); }

// Bytes by region against counters of the units that asked.
void check_bytes(const Json& view) {
  const Json& tiles = view["config"]["tiles"];
  const bool half = tiles["features"] == "fp16";
  const std::uint64_t record = half ? 24 : 36, place = half ? 32 : 64;
  const std::uint64_t entry =
      (tiles["keys"] == "fp16" ? 2 : 4) + (tiles["subtiles_across"] == 4 ? 6 : 4);
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
  CHECK(region_bytes(view, "frame_buffer", "write") ==
        12 * counter_of_all(view, "rendering", "pixels"));
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
  // A record in floats is two words, of the place that is written and of what is read back.
  const std::uint64_t more_words = config["tiles"]["features"] == "fp16" ? 0 : 1;
  CHECK(busy(view, "lister", "list") >=
        of_lister("pairs") + of_lister("tiles") + more_words * of_lister("records"));
  CHECK(busy(view, "sorter", "load") >= of_sorters("entries_read"));
  // Each split passes its QSU twice; a chunk takes a cycle for 16 entries into the network, for 8
  // in each level of merging, and what is sorted leaves an entry a cycle.
  CHECK(busy(view, "sorter", "sort") >=
        2 * of_sorters("split_entries") + of_sorters("chunk_entries") / 16 +
            of_sorters("merged") / 8 + of_sorters("entries_sorted"));
  CHECK(busy(view, "rendering", "fetch") >= of_cores("records") + of_cores("dropped"));
  CHECK(busy(view, "rendering", "blend") >= of_cores("blocks") * turn("blend"));
  CHECK(busy(view, "rendering", "blend") >= (1 + more_words) * of_cores("splats"));
  CHECK(busy(view, "rendering", "drain") * count(config["rendering"]["drain_pixels_per_cycle"]) >=
        of_cores("pixels"));
}

void check_gscore(const Simulation& simulation) {
  for (const Json& view : simulation.views()) {
    check_any_machine(view);
    check_halves(view);
    check_bytes(view);
    check_flow(view);
    check_bounds(view);
    check_rates(view);
  }
}

struct Variant {
  const char* name;
  Arguments settings;
};

// Each brings something about that the others do not.
const std::vector<Variant>& variants() {
  static const std::vector<Variant> all = {
      {"as published", {}},
      {"bitmaps of 4 x 4", {"tiles.subtiles_across=4"}},
      {"no bitmaps, boxes along the screen", {"tiles.subtiles_across=1", "tiles.test=box"}},
      {"floats", {"tiles.features=fp32", "tiles.keys=fp32", "rendering.precision=fp32"}},
      {"passes over few tiles", {"lists.tiles=5"}},
      {"one line for all tiles", {"lists.lines=1", "lists.line_bytes=32", "lists.block_lines=1"}},
      {"lists split in memory", {"sorting.list_entries=16", "sorting.chunk_entries=16"}},
      {"lists split on chip", {"sorting.chunk_entries=16"}},
      {"a pool that overflows", {"lists.pool_bytes=21504"}},
      {"one of each",
       {"ccus=1", "cores=1", "rendering.record_slots=1", "ccu.input_slots=1",
        "ccu.second_half_slots=1", "sorting.list_buffers=1", "rendering.pixel_buffers=1",
        "rendering.sorted_entries=1"}},
      {"other numbers",
       {"ccus=3", "cores=5", "clock_mhz=733", "rendering.core_lanes=64", "lists.tiles_at_once=3",
        "lists.tile_lanes=5"}},
      {"narrow memory", {"memory_port.max_outstanding=1", "dram.channels=1"}},
      {"finished parts are blended", {"rendering.skip_finished=false"}},
      {"second halves of 16 bits", {"storage.encoding=half"}},
  };
  return all;
}

Arguments run_of(const Variant& variant) {
  Arguments settings = variant.settings;
  settings.emplace_back("sram.buffer_bytes=1073741824");
  return with_settings({"builtin:object?n=3000", "--size", "97x61", "--config", "gscore"},
                       settings);
}

// Stalls may bring tiles to other cores and accesses into a better order: a frame may end earlier.
// They may hide behind a memory that is asked for one thing at a time: it may end at the same
// cycle.
TEST_CASE("gscore: every variant, with stalls and in every order of processes") {
  std::size_t changed = 0;
  for (const Variant& variant : variants()) {
    INFO(variant.name);
    const Simulation plain(run_of(variant));
    check_gscore(plain);
    const Simulation stalled(joined(run_of(variant), {"--stalls", "0.2", "--seed", "3"}));
    check_gscore(stalled);
    CHECK(stalled.frame(0) == plain.frame(0));
    changed += frame_cycles(stalled.views()[0]) != frame_cycles(plain.views()[0]) ? 1 : 0;
    for (const char* order : {"1", "2"}) {
      INFO(order);
      const Simulation other(joined(run_of(variant), {"--process-order", order}));
      CHECK(without_host(other.views()[0]) == without_host(plain.views()[0]));
      const Simulation both(
          joined(run_of(variant), {"--stalls", "0.2", "--seed", "3", "--process-order", order}));
      CHECK(without_host(both.views()[0]) == without_host(stalled.views()[0]));
    }
  }
  CHECK(changed + 2 >= variants().size());
}

TEST_CASE("gscore: variants do what they are for") {
  const auto view_of = [](const char* name) {
    for (const Variant& variant : variants()) {
      if (variant.name == std::string(name)) return Simulation(run_of(variant)).views()[0];
    }
    throw std::logic_error(name);
  };
  CHECK(counter(view_of("passes over few tiles"), "lister", "passes") == 6);
  CHECK(counter(view_of("one line for all tiles"), "lister", "lines_displaced") > 0);
  CHECK(counter_of_all(view_of("lists split in memory"), "sorter", "lists_split") > 0);
  CHECK(counter_of_all(view_of("lists split on chip"), "sorter", "splits") > 0);
  CHECK(counter(view_of("a pool that overflows"), "lister", "passes_overflowed") > 0);
  const Json plain = view_of("as published");
  CHECK(counter_of_all(plain, "rendering", "tiles_finished") > 0);
  CHECK(counter_of_all(view_of("finished parts are blended"), "rendering", "blocks") >
        counter_of_all(plain, "rendering", "blocks"));
  CHECK(counter_of_all(view_of("no bitmaps, boxes along the screen"), "rendering", "blocks") >
        counter_of_all(plain, "rendering", "blocks"));
}

TEST_CASE("gscore: the lossless preset gives the reference picture") {
  for (const char* scene : {"builtin:object?n=3000", "builtin:outdoor?n=3000"}) {
    INFO(scene);
    const Simulation simulation(
        {scene, "--view", "all", "--size", "96x54", "--config", "gscore_lossless"});
    check_gscore(simulation);
    for (const Json& view : simulation.views()) CHECK(view["image"]["max_abs_error"] == 0.0);
  }
}

TEST_CASE("gscore: frames and scenes of every size") {
  for (const char* size : {"1x1", "200x1", "1x200", "3x5", "320x180"}) {
    INFO(size);
    check_gscore(Simulation({"builtin:object?n=2000", "--size", size, "--config", "gscore"}));
  }
  for (const char* scene : {"builtin:object?n=1", "builtin:object?n=30"}) {
    INFO(scene);
    check_gscore(Simulation({scene, "--size", "64x48", "--config", "gscore"}));
  }
}

TEST_CASE("gscore: a real scene") {
  const Arguments truck = {shared_scene("truck"),
                           "--cameras",
                           shared_path("cameras/truck.json"),
                           "--size",
                           "160x90",
                           "--config",
                           "gscore"};
  const Simulation plain(truck);
  check_gscore(plain);
  CHECK(plain.views()[0]["image"]["psnr_db"] > 35.0);
}

TEST_CASE("gscore: what cannot be built is refused") {
  const ScratchFolder scratch;
  const auto refused = [&](const char* setting) {
    const Outcome outcome =
        run_streaminggs({"simulate", "builtin:object?n=3000", "--size", "64x48", "--config",
                         "gscore", "--set", setting, "--out", scratch.path("out")});
    CHECK(outcome.status == 2);
    return outcome.err;
  };
  CHECK_THAT(refused("storage.encoding=vq"), Contains("machine gscore has no codebooks"));
  CHECK_THAT(refused("tiles.subtiles_across=3"), Contains("expected 1, 2 or 4"));
  CHECK_THAT(refused("lists.line_bytes=48"), Contains("power of two"));
  CHECK_THAT(refused("lists.lines=8192"), Contains("sram.buffer_bytes: 278528 bytes are there"));
  CHECK_THAT(refused("lists.pool_bytes=4096"), Contains("one tile may list all 3000 Gaussians"));
  CHECK_THAT(refused("sorting.list_entries=128"), Contains("at least a chunk"));
}

}  // namespace
}  // namespace sgs::test
