// What is left out of a frame once its pixels are finished, or where there is nothing to do:
// counted elsewhere as well, and the same pixels with more work without.
#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>
#include <vector>

#include "tests/system/left_out_checks.h"

namespace sgs::test {
namespace {

TEST_CASE("left out: what lies behind finished groups and sub-tiles") {
  const MadeScene scene(layers());
  constexpr std::uint64_t kFinished = 5;
  const auto hidden_keys = [](const Json& v) {
    return counter(v, "merge", "due") - counter(v, "merge", "released");
  };
  // A visit is a Gaussian.
  const Arguments single = {"storage.chunk_gaussians=1"},
                  off = {"rendering.saturation_feedback=false"};
  check("exact", scene.arguments("exact", single), scene.arguments("exact", plus(single, off)),
        {{"saturated_groups", known(kFinished), bytes()},
         {"hidden_nodes",
          [](const Json& v, const Json&) {
            // Looked up are nodes and chunks that are taken from their queues. Of a group that
            // finishes one chunk waits for its successor, and is forgotten.
            return counter(v, "vsu", "looked_up") - counter(v, "vsu", "nodes") -
                   counter(v, "vsu", "nodes_dropped") - counter(v, "vsu", "visits") -
                   counter(v, "vsu", "visits_dropped") - left_out(v, "hidden_chunks") - kFinished;
          },
          sum("nodes")},
         // Which of them are chunks tb_exact_vsu knows.
         {"hidden_chunks",
          [](const Json& v, const Json&) { return counter(v, "vsu", "chunks_hidden"); },
          sum("visits")},
         {"hidden_gaussians", [&](const Json& v, const Json&) { return hidden_keys(v); },
          sum("second_halves")},
         {"saturated_gaussians",
          [&](const Json& v, const Json&) {
            return counter(v, "vsu", "visits") - total(v, "coarse_tests") +
                   counter(v, "merge", "keys") - total(v, "second_halves") - hidden_keys(v);
          },
          sum("second_halves")},
         {"saturated_tests",
          [](const Json& v, const Json&) {
            return total(v, "second_halves") - total(v, "fine_tests");
          },
          sum("fine_tests")}});
  // Whole voxels: how many there are does not depend on what is cut.
  const Arguments whole = {"vsu.visit_gaussians=0", "storage.voxel_size=0.2"};
  check("paper", scene.arguments("paper_no_vq", whole),
        scene.arguments("paper_no_vq", plus(whole, off)),
        {{"saturated_visits",
          [](const Json& a, const Json& b) {
            return counter(b, "vsu", "visits") - counter(a, "vsu", "visits");
          },
          sum("first_halves")}});
  const Json view = Simulation(scene.arguments("paper_no_vq", whole)).views()[0];
  CHECK(left_out(view, "saturated_gaussians") + left_out(view, "saturated_tests") ==
        total(view, "dropped_saturated"));
}

TEST_CASE("left out: sorts of one") {
  // Two more share a voxel, but not a chunk of one.
  std::vector<Ball> balls = diagonal();
  for (const float depth : {4.0F, 4.03F}) balls.push_back({at_pixel(42, 58, depth)});
  const MadeScene scene(cloud_of(balls));
  const std::tuple<const char*, const char*, std::uint64_t> alone[] = {
      {"exact", "storage.chunk_gaussians=1", 6}, {"paper_no_vq", "storage.voxel_size=0.25", 4}};
  for (const auto& [machine, one_each, trivial] : alone) {
    check(machine, scene.arguments(machine, {one_each}),
          scene.arguments(machine, {one_each, "sorting.skip_trivial=false"}),
          {{"trivial_sorts", known(trivial), sum("moves")}});
  }
}

TEST_CASE("left out: what a tile-centric machine spares") {
  std::vector<Ball> unseen = diagonal(), seen = diagonal();
  for (const float x : {8.0F, 24.0F, 56.0F}) {
    unseen.push_back({at_pixel(x, 8, 4) * glm::vec3(1, 1, -1), 0.02F, kBlack});
    seen.push_back({at_pixel(x, 40, 4), 0.02F, kBlack});
  }
  const MadeScene scene(cloud_of(unseen)), needed(cloud_of(seen)), layered(layers());
  check("gscore", scene.arguments("gscore", {}), needed.arguments("gscore", {}),
        {{"gaussians_off_frame", known(3), sum("second_halves")}});
  // Needles across the corners of their boxes.
  GaussianCloud slanted = cloud_of(diagonal());
  for (std::size_t i = 0; i < slanted.size(); ++i) {
    slanted.log_scales[i] = glm::vec3(std::log(0.5F), std::log(0.01F), std::log(0.01F));
    slanted.quats[i] = {std::cos(0.4F), 0, 0, std::sin(0.4F)};
  }
  const MadeScene needles(slanted);
  check("gscore", needles.arguments("gscore_lossless", {}),
        needles.arguments("gscore_lossless", {"tiles.test=box"}),
        {{"tiles_not_touched",
          [](const Json& v, const Json& off) { return total(off, "pairs") - total(v, "pairs"); },
          sum("pairs")}});
  // Without bits of parts, and finished ones blended all the same, each splat is in all 16 parts:
  // none is left out then. How many splats are looked at before a tile is known to be finished is a
  // matter of time.
  check("gscore", layered.arguments("gscore", {}),
        layered.arguments("gscore", {"tiles.subtiles_across=1", "rendering.skip_finished=false"}),
        {{"blocks_not_touched",
          [](const Json& v, const Json&) {
            return 16 * counter_of_all(v, "rendering", "splats") -
                   counter_of_all(v, "rendering", "blocks");
          },
          sum("blocks")}});
  const Simulation run(layered.arguments("gscore", {}));
  run.check();
  const Json& view = run.views()[0];
  const std::uint64_t pairs = total(view, "pairs"), sorted = total(view, "entries_sorted");
  struct Skipped {
    const char* what;
    std::uint64_t count;
  };
  for (const auto& [what, count] :
       {Skipped{"entries_of_finished_tiles", pairs - sorted},
        Skipped{"reads_of_finished_tiles",
                pairs + total(view, "entries_split") - total(view, "entries_read")},
        Skipped{"records_of_finished_tiles",
                sorted - counter_of_all(view, "rendering", "records")}}) {
    INFO(what);
    CHECK(left_out(view, what) == count);
  }
}

}  // namespace
}  // namespace sgs::test
