// Random options and random scenes.
#include "tests/system/exact_order_checks.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "algorithm/render/reference_renderer.h"
#include "algorithm/scene/camera.h"
#include "algorithm/scene/ply_writer.h"
#include "algorithm/splat/activate.h"
#include "tests/algorithm/voxel/hard_scenes.h"
#include "tests/support/shared_inputs.h"
#include "tests/system/frame_checks.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {

std::vector<std::string> random_exact_options(std::mt19937_64& random) {
  std::vector<std::string> options = {"--config", "exact"};
  const auto set = [&](const char* key, std::uint64_t value) {
    options.insert(options.end(), {"--set", fmt::format("{}={}", key, value)});
  };
  const auto between = [&](std::uint64_t low, std::uint64_t high) {
    return low + random() % (high - low + 1);
  };
  set("sram.shared_bytes", 1U << 30U);
  set("sram.input_bytes", 1U << 30U);
  set("group_width_px", 4 * between(1, random() % 2 == 0 ? 8 : 50));
  set("group_height_px", 4 * between(1, random() % 2 == 0 ? 8 : 50));
  set("storage.chunk_gaussians", between(1, random() % 2 == 0 ? 16 : 256));
  set("merge.entries", between(2, random() % 2 == 0 ? 32 : 4096));
  set("merge.cycles_per_operation", between(2, 4));
  set("merge.spill_runs", between(2, 8));
  set("merge.spill_block_entries", between(1, 16));
  set("vsu.queue_entries", between(9, random() % 2 == 0 ? 16 : 512));
  set("vsu.node_queue_entries", between(9, random() % 2 == 0 ? 16 : 128));
  set("vsu.upper_nodes", between(0, 40));
  set("vsu.nodes_in_flight", between(1, 16));
  // A slow walk has visits left when a group finishes.
  set("vsu.cycles_per_queue_operation", between(2, random() % 2 == 0 ? 4 : 64));
  set("hfus", between(1, 6));
  set("sorting_units", between(1, 4));
  set("hfu.second_half_slots", between(1, 16));
  set("hfu.slice_gaussians", 4 * between(1, 32));  // of 16 or 24 B: whole bursts
  set("merge.output_fifo_entries", between(1, 4));
  set("rendering.pixel_buffers", between(1, 2));
  set("rendering.pixel_ports", between(0, 2));
  if (random() % 2 == 0) {
    options.insert(options.end(), {"--stalls", "0.02", "--seed", std::to_string(random() % 1000)});
  }
  return options;
}

void fuzz_exact_frames(unsigned first_seed, unsigned scenes) {
  std::uint64_t blends = 0, spilled = 0, put_aside = 0, saturated = 0, ties = 0;
  for (unsigned seed = first_seed; seed < first_seed + scenes; ++seed) {
    HardScenes hard(seed);
    std::mt19937_64 random(seed);
    constexpr std::size_t kCounts[] = {1, 30, 300, 1500};
    const HardScene scene = hard.next(kCounts[random() % 4], 120);
    const ScratchFolder scratch;
    write_ply(scratch.path("scene.ply"), scene.cloud);
    write_cameras(scratch.path("cameras.json"), {scene.camera});
    std::vector<std::string> arguments = {scratch.path("scene.ply"), "--cameras",
                                          scratch.path("cameras.json")};
    const std::vector<std::string> options = random_exact_options(random);
    arguments.insert(arguments.end(), options.begin(), options.end());
    INFO("seed " << seed);
    const Simulation simulation(arguments);
    simulation.check();
    const auto& view = simulation.views()[0];
    check_reference(view, simulation.folder() + "/out",
                    render_reference(make_view<float>(scene.camera), activate(scene.cloud)).image);
    blends += view["image"]["blends"].get<std::uint64_t>();
    spilled += counter(view, "merge", "keys_spilled");
    put_aside += counter(view, "vsu", "queue_entries_put_aside");
    saturated += counter(view, "vsu", "groups_saturated");
    ties += counter(view, "merge", "ties");
  }
  fmt::print("{} blends, {} keys spilled, {} entries put aside, {} groups ended early, {} ties\n",
             blends, spilled, put_aside, saturated, ties);
  CHECK(blends > 1000 * std::uint64_t{scenes});
  CHECK(spilled > 10 * std::uint64_t{scenes});
  CHECK(put_aside > scenes);
  CHECK(saturated > 0);
  CHECK(ties > scenes);
}

void check_exact_under_pressure(const std::string& name) {
  const Simulation simulation(
      with_settings({shared_scene(name), "--cameras", shared_path("cameras/" + name + ".json"),
                     "--view", "all", "--config", "exact", "--stalls", "0.02"},
                    {"group_width_px=64", "group_height_px=64", "merge.entries=128",
                     "vsu.queue_entries=48", "sram.shared_bytes=1073741824"}));
  simulation.check();
  for (const auto& view : simulation.views()) {
    CHECK(counter(view, "merge", "keys_spilled") > 0);
  }
}

}  // namespace sgs::test
