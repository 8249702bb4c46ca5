// Everything that `left_out` lists: its count against one made elsewhere, and the same pixels with
// more work where it is not left out. That is by a switch, or by a scene of the same picture that
// needs what the other does not.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/system/made_scenes.h"
#include "tests/system/report_values.h"
#include "tests/system/tile_frame_checks.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;
using Value = std::function<std::uint64_t(const Json&)>;

// counted: of the frame with the saving and the one without.
using Counted = std::function<std::uint64_t(const Json& with, const Json& without)>;

struct Row {
  const char* what;
  Counted counted;
  Value work;              // of which there is more without
  std::uint64_t left = 0;  // count where it is not left out
};

std::uint64_t read_of(const Json& view, const char* region) {
  return region_bytes(view, region, "read");
}
Value region(const char* name) {
  return [name](const Json& v) { return read_of(v, name); };
}
Value sum(const char* counter) {
  return [counter](const Json& v) { return total(v, counter); };
}
Value of_scene(const char* key) {
  return [key](const Json& v) { return v["scene"][key].get<std::uint64_t>(); };
}
Value bytes() {
  return [](const Json& v) { return v["dram"]["bytes"].get<std::uint64_t>(); };
}
Counted known(std::uint64_t count) {
  return [count](const Json&, const Json&) { return count; };
}

void check_frames(const Simulation& of) {
  if (of.views()[0]["config"]["machine"] != "gscore") return of.check();
  for (const Json& view : of.views()) check_tile_machine(view);
}

void check(const std::string& label, const Arguments& saving, const Arguments& off,
           const std::vector<Row>& rows) {
  INFO(label);
  const Simulation with(saving), without(off);
  check_frames(with);
  check_frames(without);
  CHECK(with.frame(0) == without.frame(0));
  const Json &view = with.views()[0], &plain = without.views()[0];
  CHECK(view["image"]["empty"] == false);
  for (const Row& row : rows) {
    INFO(row.what);
    CHECK(left_out(view, row.what) > 0);
    CHECK(left_out(view, row.what) == row.counted(view, plain));
    CHECK(left_out(plain, row.what) == row.left);
    CHECK(row.work(plain) > row.work(view));
  }
}

// One in the middle of each group of a diagonal, the others in the dark.
std::vector<Ball> diagonal() {
  std::vector<Ball> balls;
  for (const float middle : {8.0F, 24.0F, 40.0F, 56.0F}) {
    balls.push_back({at_pixel(middle, middle, 4)});
  }
  return balls;
}

Arguments plus(Arguments first, const Arguments& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

TEST_CASE("left out: bands of colours that the scene does not have, or does not need") {
  const MadeScene whole(padded(cloud_of(diagonal()), 3));
  for (const char* machine : {"exact", "paper_no_vq", "gscore"}) {
    for (const int degree : {0, 1, 2}) {
      const MadeScene scene(padded(cloud_of(diagonal()), degree));
      check(std::string(machine) + " " + std::to_string(degree), scene.arguments(machine, {}),
            whole.arguments(machine, {}), {{"sh_bands", known(4), region("second_halves")}});
    }
    // All of the scene's bands are noughts, which no colour misses.
    check(machine, whole.arguments(machine, {"storage.sh_tolerance=1e-6"}),
          whole.arguments(machine, {}), {{"sh_bands_below_tolerance", known(4), bytes()}});
  }
}

TEST_CASE("left out: what bands below the tolerance change stays below what is stated") {
  GaussianCloud cloud = padded(cloud_of(diagonal()), 3);
  for (std::size_t i = 0; i < cloud.sh_coeffs.size(); ++i) {
    if (i % 16 >= 9) cloud.sh_coeffs[i] = glm::vec3(0.0004F);  // of degree 3
    if (i % 16 >= 1 && i % 16 < 9) cloud.sh_coeffs[i] = glm::vec3(0.01F);
  }
  // Seven coefficients of 0.0004 in a band that adds at most sqrt(7 / (4 pi)) of their length.
  const double error = std::sqrt(7 / (4 * M_PI)) * std::sqrt(7.0) * 0.0004;
  const MadeScene scene(cloud);
  const Simulation with(scene.arguments("exact", {"storage.sh_tolerance=0.00196"}));
  with.check();
  const Json& view = with.views()[0];
  CHECK(view["scene"]["sh_degree"] == 2);
  const auto changed = view["image"]["max_abs_error"].get<double>();
  CHECK(changed > 0);
  CHECK(changed <= error);
  for (const Json& entry : view["left_out"]) {
    if (entry["what"] != "sh_bands_below_tolerance") continue;
    const std::string why = entry["why"];
    CHECK(std::stod(why.substr(why.rfind(' '))) == Approx(error).epsilon(0.01));
  }
  // A packed scene does not bring what was left out.
  const ScratchFolder folder;
  const Arguments of_scene = scene.arguments("exact", {});
  const Outcome packed =
      run_streaminggs({"pack", of_scene[0], "--set", "storage.sh_tolerance=0.00196", "--config",
                       "exact", "--out", folder.path("a.sgs")});
  REQUIRE(packed.status == 0);
  CHECK(packed.out.find("sh bands left out         1") != std::string::npos);
  Arguments of_packed = of_scene;
  of_packed[0] = folder.path("a.sgs");
  const Simulation restored(of_packed);
  CHECK(restored.frame(0) == with.frame(0));
  CHECK(restored.views()[0]["image"]["reference"] == "decoded_scene");
  CHECK(left_out(restored.views()[0], "sh_bands_below_tolerance") == 4);
  const Simulation below(scene.arguments("exact", {"storage.sh_tolerance=0.0007"}));
  CHECK(below.views()[0]["scene"]["sh_degree"] == 3);
  CHECK(left_out(below.views()[0], "sh_bands_below_tolerance") == 0);
}

TEST_CASE("left out: Gaussians that no view can show") {
  std::vector<Ball> balls = diagonal();
  // So many that they take pages of their own.
  constexpr int kInvisible = 400;
  for (int i = 0; i < kInvisible; ++i) {
    balls.push_back({at_pixel(32, 32, 5), 0.02F, kBlack, false});
  }
  const MadeScene scene(cloud_of(balls));
  for (const char* machine : {"exact", "paper_no_vq", "gscore"}) {
    check(machine, scene.arguments(machine, {}),
          scene.arguments(machine, {"storage.store_invisible=true"}),
          {{"invisible_gaussians", known(kInvisible), of_scene("stored_bytes")}});
  }
}

// Words of all codebooks together.
std::uint64_t words(const Json& view) {
  std::uint64_t sum = 0;
  for (const Json& codebook : view["scene"]["codebooks"]) {
    sum += codebook["entries"].get<std::uint64_t>() * codebook["words"].get<std::uint64_t>();
  }
  return sum;
}
std::uint64_t entries(const Json& view) {
  std::uint64_t sum = 0;
  for (const Json& codebook : view["scene"]["codebooks"]) {
    sum += codebook["entries"].get<std::uint64_t>();
  }
  return sum;
}

TEST_CASE("left out: codebooks, their words, their entries, their load") {
  const Arguments vq = {"storage.encoding=vq_packed", "sram.codebook_bytes=256000"};
  const std::vector<Ball> balls = diagonal();
  // Behind the camera stand so many other colours.
  constexpr std::uint32_t kOthers = 299;
  std::vector<Ball> many = balls;
  for (std::uint32_t i = 0; i < kOthers; ++i) {
    many.push_back({{0, 0, -4}, 0.02F, glm::vec3(0.001F * static_cast<float>(i + 1))});
  }
  const MadeScene plain(cloud_of(balls)), colourful(cloud_of(many));
  for (const char* machine : {"exact", "paper"}) {
    INFO(machine);
    check("raw", plain.arguments(machine, {"storage.encoding=raw", "sram.codebook_bytes=256000"}),
          plain.arguments(machine, vq), {{"codebooks", known(3), region("codebooks")}});
    for (const int degree : {0, 1, 2}) {
      const MadeScene scene(padded(cloud_of(balls), degree)), whole(padded(cloud_of(balls), 3));
      check("degree " + std::to_string(degree), scene.arguments(machine, vq),
            whole.arguments(machine, vq),
            {{"codebook_words", [](const Json& a, const Json& b) { return words(b) - words(a); },
              region("codebooks")}});
    }
    // 4,096 scales, rotations and colours at most; all have one scale and one rotation.
    constexpr std::uint64_t kMost = 3 * 4096;
    check("entries", plain.arguments(machine, vq), colourful.arguments(machine, vq),
          {{"codebook_entries", [](const Json& view, const Json&) { return kMost - entries(view); },
            region("codebooks"), kMost - 3 - kOthers},
           // Three times 12 bits; 300 colours are told apart by 9.
           {"index_bits", known(36), region("codebooks"), 36 - 9}});
    check("load", plain.arguments(machine, plus(vq, {"codebook.preloaded=true"})),
          plain.arguments(machine, vq), {{"codebook_load", known(1), region("codebooks")}});
  }
}

// Eight Gaussians that lie close together: a chunk.
void add_cluster(std::vector<Ball>& balls, const glm::vec3& middle, const glm::vec3& dc,
                 bool visible = true) {
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 corner((i & 1) != 0, (i & 2) != 0, (i & 4) != 0);
    balls.push_back({middle + 0.01F * corner, 0.02F, dc, visible});
  }
}

TEST_CASE("left out: chunks that no group needs, groups that see none") {
  // Two in groups of the diagonal, three behind the camera; or those, black, in other groups.
  std::vector<Ball> unseen, seen;
  for (std::vector<Ball>* balls : {&unseen, &seen}) {
    add_cluster(*balls, at_pixel(8, 8, 4), {1, 0.5F, 0});
    add_cluster(*balls, at_pixel(40, 40, 4), {0, 0.5F, 1});
  }
  for (const float x : {8.0F, 24.0F, 56.0F}) {
    add_cluster(unseen, at_pixel(x, 56, 4) * glm::vec3(1, 1, -1), kBlack);
    add_cluster(seen, at_pixel(x, 56, 4), kBlack);
  }
  const MadeScene scene(cloud_of(unseen)), needed(cloud_of(seen));
  check("exact", scene.arguments("exact", {}), needed.arguments("exact", {}),
        {{"chunks_not_needed", known(3), sum("visits")},
         {"empty_groups", known(16 - 2), sum("visits"), 16 - 5}});
}

TEST_CASE("left out: empty cells, voxels that no ray meets, groups that see none") {
  // Voxels of 1: 4 x 4 x 4 of them before the camera, each with eight Gaussians that no view can
  // show; in two of them visible ones, and behind the camera as well.
  std::vector<Ball> balls;
  for (int cell = 0; cell < 64; ++cell) {
    const glm::vec3 at(cell % 4, cell / 4 % 4, cell / 16);
    add_cluster(balls, at + glm::vec3(-1.5F, -1.5F, 10.5F), kBlack, false);
  }
  add_cluster(balls, {-0.5F, -0.5F, 10.5F}, {1, 0.5F, 0});
  add_cluster(balls, {0.5F, 0.5F, 10.5F}, {0, 0.5F, 1});
  const MadeScene scene(cloud_of(balls));
  const Arguments set = {"storage.voxel_size=1"};
  // A voxel is 5.8 px wide on its near side, all are 25.6 px: groups of 16 px around the middle.
  check("paper", scene.arguments("paper_no_vq", set),
        scene.arguments("paper_no_vq", plus(set, {"storage.store_invisible=true"})),
        {{"empty_cells", known(64 - 2), region("voxel_table")},
         {"empty_groups", known(16 - 2), sum("visits"), 16 - 4}});

  std::vector<Ball> unseen, seen;
  for (std::vector<Ball>* of : {&unseen, &seen}) add_cluster(*of, {-0.5F, -0.5F, 10.5F}, {1, 1, 0});
  for (const float x : {-0.5F, 0.5F, 1.5F}) {
    add_cluster(unseen, {x, 0.5F, -10.5F}, kBlack);
    add_cluster(seen, {x, 0.5F, 10.5F}, kBlack);
  }
  const MadeScene behind(cloud_of(unseen)), before(cloud_of(seen));
  check("voxels", behind.arguments("paper_no_vq", set), before.arguments("paper_no_vq", set),
        {{"voxels_not_needed", known(3), sum("first_halves")}});
}

// Five groups whose pixels finish behind the first of many layers, and one where few lie.
GaussianCloud layers() {
  std::vector<Ball> balls;
  for (int layer = 0; layer < 150; ++layer) {
    const float depth = 4 + 0.02F * static_cast<float>(layer);
    for (const auto& [column, row] : {std::pair(0, 0), {2, 0}, {0, 2}, {2, 2}, {3, 3}}) {
      for (int at = 0; at < 16; ++at) {
        const float x = static_cast<float>(16 * column + 2 + 4 * (at % 4));
        const float y = static_cast<float>(16 * row + 2 + 4 * (at / 4));
        balls.push_back({at_pixel(x, y, depth), 3 * depth / 64});
      }
    }
  }
  balls.push_back({at_pixel(56, 24, 4)});
  return cloud_of(balls);
}

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
         {"hidden_chunks",
          [](const Json& v, const Json&) {
            return counter(v, "vsu", "looked_up") - counter(v, "vsu", "nodes") -
                   counter(v, "vsu", "nodes_dropped") - counter(v, "vsu", "visits") -
                   counter(v, "vsu", "visits_dropped") - left_out(v, "hidden_nodes") - kFinished;
          },
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
}

TEST_CASE("left out: sorts of one") {
  const MadeScene scene(cloud_of(diagonal()));
  const std::pair<const char*, const char*> alone[] = {{"exact", "storage.chunk_gaussians=1"},
                                                       {"paper_no_vq", "storage.voxel_size=0.25"}};
  for (const auto& [machine, one_each] : alone) {
    check(machine, scene.arguments(machine, {one_each}),
          scene.arguments(machine, {one_each, "sorting.skip_trivial=false"}),
          {{"trivial_sorts", known(4), sum("moves")}});
  }
}

// A frame for which less would do: how much, and what more there is to do with less than that.
struct Spare {
  const char* machine;
  Arguments set;
  const char *what, *key;
  Value enough;  // by the frame's counters
  std::uint64_t there;
  Value work;  // null: less than enough is not tried
};

TEST_CASE("left out: what is never fed, and how much would do") {
  std::vector<Ball> few;
  for (const float x : {20.0F, 28.0F, 36.0F}) few.push_back({at_pixel(x, 32, 4)});
  const MadeScene layered(layers()), three(cloud_of(few));
  const auto of = [](const char* unit, const char* name) {
    return [=](const Json& v) { return counter(v, unit, name); };
  };
  const auto longest = [](const Json& v) {
    return std::max(counter(v, "sorting0", "list_max"), counter(v, "sorting1", "list_max"));
  };
  const auto number = [](std::uint64_t value) { return [=](const Json&) { return value; }; };
  const Arguments one_group = {"group_width_px=64", "group_height_px=64"};
  const Arguments cut = {"storage.voxel_size=0.2", "vsu.visit_gaussians=0"};
  const Spare rows[] = {
      {"exact",
       {},
       "spare_merge_entries",
       "merge.entries",
       of("merge", "pending_keys_max"),
       512,
       sum("keys_spilled")},
      {"paper_no_vq", cut, "spare_table_bytes", "vsu.table_bytes",
       of("vsu", "ordering_table_bytes_max"), 4096, sum("passes")},
      {"paper_no_vq",
       {"storage.voxel_size=1", "vsu.visit_gaussians=0", "sorting.buffer_entries=4096"},
       "spare_sort_buffer_entries",
       "sorting.buffer_entries",
       longest,
       4096,
       sum("entries_spilled")},
      // Three Gaussians: three visits, in turn to the HFUs and to the sorting units.
      {"exact", plus(one_group, {"hfus=8", "storage.chunk_gaussians=1"}), "spare_hfus", "hfus",
       number(3), 8, nullptr},
      {"exact", plus(one_group, {"sorting_units=4", "storage.chunk_gaussians=1"}),
       "spare_sorting_units", "sorting_units", number(3), 4, nullptr},
      // Groups of 8 px have four sub-tiles.
      {"exact",
       {"group_width_px=8", "group_height_px=8", "rendering.clusters=16"},
       "spare_clusters",
       "rendering.clusters",
       number(4),
       16,
       nullptr}};
  for (const Spare& row : rows) {
    INFO(row.machine << " " << row.what);
    const MadeScene& scene = row.work ? layered : three;
    const std::string key = std::string(row.key) + "=";
    const auto with = [&](std::uint64_t value) {
      Arguments all = scene.arguments(row.machine, plus(row.set, {key + std::to_string(value)}));
      return Simulation(all);
    };
    const Simulation ample = with(row.there);
    ample.check();
    const Json& view = ample.views()[0];
    const std::uint64_t enough = row.enough(view);
    CHECK(enough < row.there);
    CHECK(left_out(view, row.what) == row.there - enough);
    for (const Json& entry : view["left_out"]) {
      if (entry["what"] != row.what) continue;
      CHECK(entry["saves"].get<std::string>().find(key + std::to_string(enough) + " ") == 0);
    }
    const Simulation tight = with(enough);
    tight.check();
    CHECK(tight.frame(0) == ample.frame(0));
    CHECK(left_out(tight.views()[0], row.what) == 0);
    CHECK(frame_cycles(tight.views()[0]) <= frame_cycles(view));
    CHECK(tight.views()[0]["area_mm2"]["total"] < view["area_mm2"]["total"]);
    if (!row.work) continue;
    const Simulation less = with(enough - 1);
    CHECK(less.frame(0) == ample.frame(0));
    CHECK(row.work(less.views()[0]) > row.work(tight.views()[0]));
  }
}

TEST_CASE("left out: memory that no unit takes, activities without work") {
  const MadeScene scene(cloud_of(diagonal()));
  const Simulation fitted(scene.arguments("exact", {}));
  const auto needed = fitted.views()[0]["sram"]["shared_bytes"].get<std::uint64_t>();
  const auto shared = [](std::uint64_t bytes) {
    return Arguments{"sram.shared_bytes=" + std::to_string(bytes)};
  };
  constexpr std::uint64_t kMore = 12'345;
  const Simulation ample(scene.arguments("exact", shared(needed + kMore)));
  const Json &view = ample.views()[0], &tight = fitted.views()[0];
  CHECK(left_out(view, "unused_sram_shared") == kMore);
  CHECK(left_out(tight, "unused_sram_shared") == 0);
  CHECK(ample.frame(0) == fitted.frame(0));
  for (const char* same : {"frame", "area_mm2", "energy"}) CHECK(view[same] == tight[same]);
  const Arguments less = scene.arguments("exact", plus(shared(needed - 1), {"framebuffer=rgb32f"}));
  CHECK(run_streaminggs(plus({"simulate"}, less)).status == 2);
  std::uint64_t idle = 0;
  for (const Json& unit : view["units"]) {
    for (const Json& activity : unit["activities"]) idle += activity["busy_cycles"] == 0 ? 1 : 0;
  }
  CHECK(left_out(view, "idle_activities") == idle);
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
  const Simulation run(layered.arguments("gscore", {}));
  check_frames(run);
  const Json& view = run.views()[0];
  const std::uint64_t pairs = total(view, "pairs"), sorted = total(view, "entries_sorted");
  struct Counts {
    const char* what;
    std::uint64_t count;
  };
  for (const auto& [what, count] :
       {Counts{"tiles_not_touched", total(view, "tile_tests") - pairs},
        // Of 16 blocks of a tile, those of looked-at splats that were not blended.
        Counts{"parts_not_touched", 16 * counter_of_all(view, "rendering", "splats") -
                                        counter_of_all(view, "rendering", "blocks")},
        Counts{"entries_of_finished_tiles", pairs - sorted},
        Counts{"reads_of_finished_tiles",
               pairs + total(view, "entries_split") - total(view, "entries_read")},
        Counts{"records_of_finished_tiles",
               sorted - counter_of_all(view, "rendering", "records")}}) {
    INFO(what);
    CHECK(left_out(view, what) == count);
  }
}

}  // namespace
}  // namespace sgs::test
