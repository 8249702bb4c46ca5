// What cannot be built or read is refused with exit status 2 and one line that says why.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Arguments = std::vector<std::string>;

// Runs and expects status 2, one line on stderr that holds every one of `words`, and no output
// folder.
void check_not_started(Arguments arguments, const std::vector<std::string>& words) {
  const ScratchFolder scratch;
  arguments.insert(arguments.end(), {"--out", scratch.path("out")});
  const Outcome outcome = run_streaminggs(arguments);
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
  for (const std::string& word : words) {
    INFO(word);
    CHECK(outcome.err.find(word) != std::string::npos);
  }
  CHECK(scratch.file_count() == 0);
}

void check_set_refused(const std::string& order, const Arguments& settings,
                       const std::vector<std::string>& words) {
  Arguments arguments = {"simulate", "builtin:object?n=100", "--size", "16x16", "--config", order};
  for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
  check_not_started(arguments, words);
}

TEST_CASE("refusals: an SRAM budget that is broken, with the sum") {
  check_set_refused("paper", {"group_width_px=128", "group_height_px=128"},
                    {"streaminggs: preset paper with --set group_height_px=128 --set "
                     "group_width_px=128: sram.shared_bytes: 91136 bytes are there",
                     "expected at least", "pixel state", "1 groups x 128 px x 128 px x 8 B"});
  check_set_refused("paper", {"hfu.slice_gaussians=1024"},
                    {"sram.input_bytes: 16384 bytes are there", "2 slots x 1024 Gaussians"});
  check_set_refused("exact", {"hfus=8"},
                    {"streaminggs: preset exact with --set hfus=8: sram.input_bytes: 7680 bytes "
                     "are there, expected at least 15360, or 0 for as many as that: ",
                     "; --fit-memories sizes it\n"});
  check_set_refused("exact", {"sram.input_bytes=100", "hfus=8"},
                    {"streaminggs: --set sram.input_bytes=100: sram.input_bytes: 100 bytes"});
  check_set_refused("paper", {"storage.vq.iterations=0", "sram.codebook_bytes=9"},
                    {"streaminggs: --set sram.codebook_bytes=9: sram.codebook_bytes: 9 bytes",
                     " are there, expected at least "});
  check_set_refused("exact",
                    {"group_width_px=128", "group_height_px=128", "sram.shared_bytes=10000"},
                    {"sram.shared_bytes: 10000", "pixel state"});
}

TEST_CASE("refusals: a pipeline shorter than its schedule, a loop longer than its pipeline") {
  struct Row {
    const char *order, *key;
    int least;
  };
  for (const auto& [order, key, least] : {Row{"exact", "rendering.begin_depth_cycles", 77},
                                          {"exact", "rendering.depth_cycles", 48},
                                          {"exact", "rendering.state_loop_cycles", 8},
                                          {"exact", "rendering.span_depth_cycles", 39},
                                          {"exact", "rendering.drain_depth_cycles", 10},
                                          {"exact", "hfu.cfu_depth_cycles", 85},
                                          {"exact", "hfu.ffu_depth_cycles", 160},
                                          {"exact", "vsu.test_depth_cycles", 195},
                                          {"paper_no_vq", "vsu.step_depth_cycles", 43},
                                          {"paper_no_vq", "vsu.cell_step_depth_cycles", 12},
                                          {"paper_no_vq", "vsu.ray_depth_cycles", 86}}) {
    const auto set = [key = key](int depth) { return key + ("=" + std::to_string(depth)); };
    check_set_refused(
        order, {set(least - 1)},
        {"streaminggs: --set " + set(least - 1) + ": ",
         "expected " + std::to_string(least) + " or more, the end of the schedule of ",
         ", or 0: that\n"});
    CHECK(run_streaminggs({"simulate", "builtin:object?n=100", "--config", order, "--set",
                           set(least), "--print-config"})
              .status == 0);
  }
  check_set_refused("exact", {"rendering.depth_cycles=60", "rendering.state_loop_cycles=61"},
                    {"rendering.state_loop_cycles: got 61, expected at most 60"});
  // Four cycles a sub-tile: the write at the end of the loop waits for a cycle without reads.
  check_set_refused(
      "exact",
      {"rendering.cluster_lanes=42", "rendering.pixel_ports=1", "rendering.state_loop_cycles=9"},
      {"rendering.state_loop_cycles: got 9, expected 10 or more"});
  check_set_refused("paper_no_vq", {"hfu.coarse_filter=false", "hfu.cfu_depth_cycles=99"},
                    {"hfu.cfu_depth_cycles: got 99 with hfu.coarse_filter=false", "expected 0"});
}

TEST_CASE("refusals: a port of pixels wanted twice in a cycle") {
  check_set_refused(
      "exact", {"rendering.cluster_lanes=167", "rendering.pixel_ports=1"},
      {"rendering.pixel_ports: got 1 with rendering.cluster_lanes 167", "expected 2"});
}

TEST_CASE("refusals: keys, types, ranges and combinations") {
  check_set_refused("paper", {"grop_px=32"}, {"grop_px"});
  check_set_refused("paper", {"group_width_px=big"}, {"group_width_px"});
  check_set_refused("paper", {"group_height_px=30", "fetch=split"},
                    {"group_height_px: got 30, expected a multiple of 4"});
  check_set_refused(
      "paper_no_vq", {"hfu.slice_gaussians=127"},
      {"hfu.slice_gaussians: got 127, 16 B each, expected a whole number of 32 B bursts"});
  check_set_refused("exact", {"hfu.slice_gaussians=6"},
                    {"hfu.slice_gaussians: got 6, 24 B each, expected a whole number of 32 B"});
  // Of four HFUs each has a quarter of the group.
  check_set_refused("paper", {"group_width_px=60", "fetch=shared"},
                    {"group_width_px: got 60, expected a multiple of 8", "4 HFUs"});
  for (const char* order : {"paper", "exact"}) {
    check_set_refused(order, {"group_width_px=0"},
                      {"group_width_px: got 0 with group_height_px", "both 0 or neither"});
    check_set_refused(order, {"group_height_px=0"}, {"both 0 or neither"});
    check_set_refused(order, {"group_width_px=0", "group_height_px=0", "sram.shared_bytes=0"},
                      {"group_width_px: got 0 with sram.shared_bytes 0"});
    check_set_refused(order, {"group_width_px=0", "group_height_px=0", "sram.shared_bytes=100"},
                      {"not even a group of", "fits sram.shared_bytes 100"});
  }
  check_set_refused("paper", {"clock_mhz=0"}, {"clock_mhz"});
  check_set_refused("paper", {"machine=random"}, {"machine", "random", "paper"});
  check_set_refused(
      "exact_half", {"hfus=2", "machine=paper"},
      {"--set machine=paper: preset exact_half is of machine exact", "take --config paper"});
  check_set_refused("paper", {"machine=exact"}, {"preset paper is of machine paper"});
  check_set_refused("paper", {"sorting.buffer_entries=16", "sorting.spill_block_entries=8"},
                    {"sorting.buffer_entries: got 16", "at least 32"});
  check_set_refused("paper", {"fetch=shared", "hfus=3"},
                    {"hfus: got 3 with fetch shared", "square number"});
  check_set_refused("paper", {"fetch=shared", "rendering.clusters=2"},
                    {"rendering.clusters: got 2", "multiple of hfus 4"});
  check_set_refused("paper", {"vsu.ray_step_px=65"},
                    {"--set vsu.ray_step_px=65: vsu.ray_step_px: got 65, expected at most 64"});
  check_set_refused("paper", {"fetch=shared", "sorting_units=3"},
                    {"sorting_units: got 3", "divisor or a multiple of hfus 4"});
  check_set_refused("paper", {"vsu.samples_per_cycle=1"},
                    {"vsu.sample_step_voxels: got 0 with vsu.samples_per_cycle 1, expected more"});
  check_set_refused(
      "paper", {"vsu.samples_per_cycle=1", "vsu.sample_step_voxels=1e-7", "sram.shared_bytes=0"},
      {"vsu.sample_step_voxels: got 1e-07, expected at least", "the scene reaches"});
  check_set_refused("paper", {"vsu.table_bytes=8"},
                    {"vsu.table_bytes: got 8, expected at least 16", "vsu.table_banks 2"});
  check_set_refused("gscore", {"storage.encoding=vq"}, {"machine gscore has no codebooks"});
  check_set_refused("gscore", {"tiles.subtiles_across=3"}, {"expected 1, 2 or 4"});
  check_set_refused("gscore", {"lists.line_bytes=48"}, {"power of two"});
  check_set_refused("gscore", {"lists.lines=8192"}, {"sram.buffer_bytes: 278528 bytes are there"});
  check_set_refused("gscore", {"sorting.list_entries=128"}, {"at least a chunk"});
  check_set_refused("gscore", {"lists.pool_bytes=99999999999"},
                    {"dram: the scene and its frame take", "tile_lists alone 99999999999", "hold"});
  check_set_refused("paper", {"dram.memspec=ddr9"},
                    {"dram.memspec: got 'ddr9'", "lpddr3_1600_4gb"});
  check_set_refused("no_such_preset", {}, {"no_such_preset"});
}

TEST_CASE("refusals: two eyes where there is one, and axes that are not parallel") {
  const Arguments stereo = {"simulate", "builtin:object?n=100", "--size", "16x16", "--stereo"};
  const auto check = [&](const Arguments& more, const std::vector<std::string>& words) {
    Arguments arguments = stereo;
    arguments.insert(arguments.end(), more.begin(), more.end());
    check_not_started(arguments, words);
  };
  for (const Arguments& paths : {Arguments{}, Arguments{"--path", "builtin:path", "--stream"}}) {
    check(joined({"ipd=0.06", "--config", "paper"}, paths),
          {"--stereo: got it with machine paper, which draws one eye a frame", "exact or gscore"});
  }
  check({""}, {"--stereo: got '', expected ipd=DISTANCE"});
  check({"ipd=0.06", "--set", "merge.on_overflow=blend_early"}, {"blend_early with eyes 2"});
  for (const char* text :
       {"0.06", "ipd=", "ipd=x", "ipd=0", "ipd=-1", "ipd=2e6", "ipd=nan", "ipd=0.06,vergence=2"}) {
    check({text}, {"--stereo: got '" + std::string(text) + "'", "ipd=DISTANCE", "parallel"});
  }
  for (const char* machine : {"exact", "gscore"}) {
    check_set_refused(machine, {"eyes=2"},
                      {"--set eyes=2: eyes: got 2 without --stereo, expected 1"});
    check({"ipd=0.06", "--config", machine, "--set", "eyes=1"},
          {"--set eyes=1: eyes: got 1 with --stereo, expected 2"});
  }
}

TEST_CASE("refusals: voxels so small that the grid has no numbers for them") {
  check_set_refused("paper", {"storage.voxel_size=0.0000001"},
                    {"streaminggs: --set storage.voxel_size=0.0000001: storage.voxel_size: 1e-07 "
                     "divides",
                     "2^20", "at least"});
}

TEST_CASE("refusals: what every view refuses, in one line") {
  check_not_started({"simulate", "builtin:object?n=3000", "--size", "16x16", "--view", "all",
                     "--config", "gscore", "--set", "lists.pool_bytes=4096"},
                    {"view 0: --set lists.pool_bytes=4096: lists.pool_bytes: got 4096",
                     "none of 5 views can be drawn"});
}

}  // namespace
}  // namespace sgs::test
