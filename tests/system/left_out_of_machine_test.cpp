// What a machine has that a frame never feeds, and how much of it would do.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/system/left_out_checks.h"

namespace sgs::test {
namespace {

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

// The assignments that a report recommends.
Arguments would_do(const Json& view) {
  Arguments all;
  for (const Json& entry : view["left_out"]) {
    const auto saves = entry["saves"].get<std::string>();
    const std::size_t end = saves.find(" would do");
    if (end != std::string::npos) all.push_back(saves.substr(0, end));
  }
  return all;
}

TEST_CASE("left out: what would do is taken, also where next to nothing is fed") {
  const MadeScene scenes[] = {MadeScene(GaussianCloud{}),
                              MadeScene(cloud_of({{at_pixel(32, 32, 4)}}))};
  struct Row {
    const char* machine;
    Arguments set;
    Arguments recommended;  // among others
  };
  const Row rows[] = {
      {"exact", {"hfus=4", "sorting_units=4"}, {"merge.entries=2", "hfus=1", "sorting_units=1"}},
      {"exact_vq", {}, {"merge.entries=2"}},
      {"paper", {}, {"vsu.table_bytes=16", "sorting.buffer_entries=16"}},
      {"paper",
       {"fetch=split", "vsu.table_banks=64", "sorting.spill_block_entries=32"},
       {"vsu.table_bytes=512", "sorting.buffer_entries=128"}},
      {"paper_no_vq",
       {"fetch=split", "hfus=7", "sorting.spill_block_entries=5"},
       {"vsu.table_bytes=16", "sorting.buffer_entries=20"}}};
  for (const MadeScene& scene : scenes) {
    for (const Row& row : rows) {
      INFO(row.machine << (&scene == scenes ? ", empty" : ", tiny"));
      const auto with = [&](const Arguments& set) {
        return Simulation(scene.arguments(row.machine, plus(row.set, set)));
      };
      const Simulation ample = with({});
      const Arguments all = would_do(ample.views()[0]);
      for (const std::string& one : row.recommended) {
        INFO(one);
        CHECK((&scene != scenes || std::find(all.begin(), all.end(), one) != all.end()));
      }
      for (const std::string& one : all) {
        INFO(one);
        CHECK(with({one}).frame(0) == ample.frame(0));
      }
      CHECK(with(all).frame(0) == ample.frame(0));
    }
  }
}

// Where a list might become longer than the buffer there is a region to spill to, behind all
// others.
TEST_CASE("left out: a sort buffer that would do takes not a cycle more") {
  const auto with = [](const Arguments& set) {
    return Simulation(
        with_settings({"builtin:object?n=2000", "--size", "96x64", "--config", "paper"}, set));
  };
  const Simulation ample = with({});
  const Arguments all = would_do(ample.views()[0]);
  const auto buffer = std::find_if(all.begin(), all.end(), [](const std::string& one) {
    return one.rfind("sorting.buffer_entries=", 0) == 0;
  });
  REQUIRE(buffer != all.end());
  const Simulation tight = with({*buffer});
  CHECK(tight.frame(0) == ample.frame(0));
  CHECK(frame_cycles(tight.views()[0]) == frame_cycles(ample.views()[0]));
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
  // Of eight HFUs the first takes the only visit, the second the end of the group.
  const MadeScene one(cloud_of({{at_pixel(32, 32, 4)}}));
  const Arguments whole = {"group_width_px=64", "group_height_px=64"};
  const Simulation few(one.arguments("exact", plus(whole, {"hfus=2"})));
  const Simulation many(one.arguments("exact", plus(whole, {"hfus=8"})));
  const std::uint64_t of_hfu = few.views()[0]["units"]["hfu0.coarse"]["activities"].size() +
                               few.views()[0]["units"]["hfu0.fine"]["activities"].size();
  CHECK(left_out(many.views()[0], "idle_activities") -
            left_out(few.views()[0], "idle_activities") ==
        6 * of_hfu);
}

}  // namespace
}  // namespace sgs::test
