// Whole frames of the tile-centric machine through the command: the golden picture bit for bit and
// everything accounted for, whatever the parameters, the stalls and the order of processes.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/support/shared_inputs.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

struct GscoreVariant {
  const char* name;
  Arguments settings;
};

// Each brings something about that the others do not.
const std::vector<GscoreVariant>& variants() {
  static const std::vector<GscoreVariant> all = {
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
      {"chunks are culled", {"culling.by=chunk_boxes", "storage.chunk_gaussians=5"}},
      {"chunks are culled in several passes, one node at a time",
       {"culling.by=chunk_boxes", "culling.nodes_in_flight=1", "culling.nodes_in_test=1",
        "culling.nodes_tested=1", "culling.test_lanes=3", "lists.tiles=5", "ccus=3"}},
  };
  return all;
}

Arguments run_of(const GscoreVariant& variant) {
  Arguments settings = variant.settings;
  settings.emplace_back("sram.buffer_bytes=1073741824");
  return with_settings({"builtin:object?n=3000", "--size", "97x61", "--config", "gscore"},
                       settings);
}

// Stalls may bring tiles to other cores and accesses into a better order: a frame may end earlier.
// They may hide behind a memory that is asked for one thing at a time: it may end at the same
// cycle.
TEST_CASE("gscore: every variant, with stalls and in every order of processes", "[nightly]") {
  std::size_t changed = 0;
  for (const GscoreVariant& variant : variants()) {
    INFO(variant.name);
    const Simulation plain(run_of(variant));
    plain.check();
    const Simulation stalled(joined(run_of(variant), {"--stalls", "0.2", "--seed", "3"}));
    stalled.check();
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
    for (const GscoreVariant& variant : variants()) {
      if (variant.name == std::string(name)) return Simulation(run_of(variant)).views()[0];
    }
    throw std::logic_error(name);
  };
  CHECK(counter(view_of("passes over few tiles"), "lister", "passes") == 6);
  const Json one_node = view_of("chunks are culled in several passes, one node at a time");
  CHECK(counter(one_node, "lister", "passes") == 6);
  CHECK(counter(one_node, "culler", "nodes") > 6);
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

// In chunks of as many Gaussians the scene is stored in the order of gscore_lossless.
TEST_CASE("gscore: the lossless presets give the reference picture, whatever is culled") {
  std::uint64_t spared = 0;  // first halves
  for (const char* scene : {"builtin:object?n=3000", "builtin:outdoor?n=3000"}) {
    INFO(scene);
    const auto run = [&](const char* preset) {
      return Simulation({scene, "--view", "all", "--size", "96x54", "--config", preset});
    };
    const Simulation plain = run("gscore_lossless"), boxes = run("gscore_lossless_boxes");
    for (const Simulation* simulation : {&plain, &boxes}) {
      simulation->check();
      for (const Json& view : simulation->views()) CHECK(view["image"]["max_abs_error"] == 0.0);
    }
    for (std::size_t v = 0; v < plain.views().size(); ++v) {
      CHECK(boxes.frame(v) == plain.frame(v));
      const std::uint64_t read = total(boxes.views()[v], "first_halves");
      CHECK(read <= total(plain.views()[v], "first_halves"));
      spared += total(plain.views()[v], "first_halves") - read;
    }
  }
  CHECK(spared > 3000);
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
  plain.check();
  CHECK(plain.views()[0]["image"]["psnr_db"] > 35.0);
}

}  // namespace
}  // namespace sgs::test
