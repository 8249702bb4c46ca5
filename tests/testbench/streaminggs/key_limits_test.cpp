// What the numbers of configurations may be: each key's range, stated and kept to.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "modules/machines.h"
#include "testbench/command_line/config_source.h"
#include "testbench/streaminggs/run_config.h"
#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;

// What the numbers of the machines may be. e, p, g: the exact, paper and tile-centric machines'
// keys.
struct Limits {
  const char *machines, *low, *high;
  std::vector<std::string> keys;
};
const std::vector<Limits>& limits() {
  static const std::vector<Limits> kLimits = {
      {"epg", "0", "1", {"storage.sh_tolerance"}},
      {"epg", "0", "8", {"dram.refresh_postpone_max"}},
      {"epg", "0", "64", {"memory_port.path_cycles"}},
      {"epg", "0", "100", {"dram.io_pj_per_bit"}},
      {"epg", "0", "1000", {"storage.vq.iterations", "dram.front_end_ns", "dram.back_end_ns"}},
      {"epg", "0", "1023", {"dram.write_low_watermark"}},
      {"epg", "0", "100000000", {"dram.power_down_idle_cycles", "dram.self_refresh_idle_cycles"}},
      {"epg", "0", "9223372036854775807", {"storage.vq.seed"}},
      {"epg", "1", "2", {"rendering.pixel_buffers"}},
      {"epg", "1", "4", {"dram.ranks"}},
      {"epg", "1", "16", {"dram.channels"}},
      {"epg", "1", "64", {"lane_latency_cycles", "half_lane_latency_cycles"}},
      {"epg", "1", "1000", {"rendering.feedback_latency_cycles"}},
      {"epg",
       "1",
       "1024",
       {"dram.read_queue_entries", "dram.write_queue_entries", "dram.write_high_watermark"}},
      {"epg", "1", "4096", {"memory_port.max_outstanding", "memory_port.max_writes"}},
      {"epg", "1", "10000", {"clock_mhz"}},
      {"epg",
       "1",
       "65536",
       {"storage.vq.scale_entries", "storage.vq.rotation_entries", "storage.vq.dc_entries",
        "storage.vq.sh_entries"}},
      {"epg", "1", "1000000", {"dram.age_cap_cycles"}},
      {"epg", "32", "4096", {"memory_port.max_transaction_bytes"}},
      {"ep",
       "0",
       "1000",
       {"rendering.state_loop_cycles", "rendering.depth_cycles", "rendering.begin_depth_cycles",
        "rendering.span_depth_cycles", "rendering.drain_depth_cycles"}},
      {"ep", "0", "1020", {"group_width_px", "group_height_px"}},
      {"ep",
       "0",
       "10000",
       {"hfu.cfu_macs", "hfu.cfu_depth_cycles", "hfu.ffu_macs", "hfu.ffu_depth_cycles"}},
      {"ep", "0", "1073741824", {"sram.input_bytes", "sram.codebook_bytes", "sram.shared_bytes"}},
      {"ep", "1", "16", {"sorting_units"}},
      {"ep",
       "1",
       "64",
       {"hfus", "sorting.sort_interval_cycles", "sorting.merge_interval_cycles", "hfu.cfus",
        "codebook.banks"}},
      {"ep", "1", "100", {"codebook.latency_cycles"}},
      {"ep", "1", "256", {"rendering.clusters"}},
      {"ep", "1", "1000", {"sorting.sort_latency_cycles"}},
      {"ep",
       "1",
       "1024",
       {"hfu.second_half_slots", "rendering.cluster_queue_entries", "rendering.span_slots"}},
      {"ep",
       "1",
       "4096",
       {"hfu.candidate_fifo_entries", "rendering.cluster_lanes", "rendering.begin_lanes",
        "rendering.span_lanes", "rendering.input_fifo_entries",
        "rendering.drain_pixels_per_cycle"}},
      {"ep", "1", "10000", {"hfu.cfu_lanes", "hfu.ffu_lanes"}},
      {"ep", "2", "1024", {"hfu.input_slots"}},
      {"ep", "2", "1048576", {"hfu.slice_gaussians"}},
      {"ep", "4", "256", {"codebook.line_bytes"}},
      {"e", "0", "10000", {"vsu.test_depth_cycles"}},
      {"e", "0", "65535", {"storage.chunk_gaussians"}},
      {"e", "0", "1048576", {"vsu.upper_nodes"}},
      {"e", "1", "1000", {"merge.latency_cycles"}},
      {"e", "1", "1024", {"vsu.nodes_in_flight", "vsu.nodes_in_test", "merge.spill_block_entries"}},
      {"e", "1", "4096", {"merge.input_fifo_entries", "merge.output_fifo_entries"}},
      {"e", "1", "10000", {"vsu.test_lanes"}},
      {"e", "2", "16", {"merge.cycles_per_operation"}},
      {"e", "2", "64", {"vsu.cycles_per_queue_operation"}},
      {"e", "2", "1024", {"merge.spill_runs"}},
      {"e", "2", "16777216", {"merge.entries"}},
      // The children of a node, and one that is taken.
      {"e", "9", "16777216", {"vsu.queue_entries", "vsu.node_queue_entries"}},
      {"p", "0", "10", {"vsu.sample_step_voxels"}},
      {"p",
       "0",
       "1000",
       {"vsu.step_depth_cycles", "vsu.cell_step_depth_cycles", "vsu.ray_depth_cycles"}},
      {"p", "0", "1000000000", {"storage.voxel_size"}},
      {"p", "0", "1073741824", {"vsu.visit_gaussians"}},
      {"p", "1", "64", {"vsu.table_banks", "vsu.groups_ahead"}},
      {"p",
       "1",
       "1024",
       {"vsu.rays_in_flight", "vsu.chain_entries", "vsu.ray_step_px",
        "sorting.spill_block_entries"}},
      {"p", "1", "1024", {"vsu.node_fetches"}},
      {"p", "1", "4096", {"sorting.input_fifo_entries"}},
      {"p", "1", "10000", {"vsu.step_lanes", "vsu.ray_lanes"}},
      {"p", "2", "1048576", {"vsu.min_share"}},
      {"p", "8", "1073741824", {"vsu.table_bytes"}},
      {"p", "16", "1048576", {"sorting.buffer_entries"}},
      {"p",
       "64",
       "1073741824",
       {"vsu.node_cache_bytes", "vsu.record_cache_bytes", "vsu.cut_cache_bytes"}},
      {"g", "0", "4096", {"rendering.core_lanes"}},
      {"g", "0", "65536", {"sorting.list_entries"}},
      {"g", "0", "1048576", {"lists.tiles", "lists.lines"}},
      {"g", "0", "1073741824", {"sram.buffer_bytes"}},
      {"g", "1", "4", {"tiles.subtiles_across", "rendering.drain_pixels_per_cycle"}},
      {"g", "1", "16", {"lists.tiles_at_once", "sorting.list_buffers"}},
      {"g", "1", "64", {"ccus", "cores", "ccu.input_slots", "lists.block_lines"}},
      {"g", "1", "256", {"ccu.cull_lanes", "ccu.slice_gaussians", "ccu.second_half_slots"}},
      {"g",
       "1",
       "1024",
       {"ccu.convert_lanes", "ccu.candidates", "ccu.output_entries", "lists.tile_lanes",
        "lists.part_lanes", "lists.tested_entries", "rendering.record_slots"}},
      {"g", "1", "65536", {"rendering.sorted_entries"}},
      {"g", "16", "4096", {"sorting.chunk_entries"}},
      {"g", "32", "256", {"lists.line_bytes"}},
      {"g", "4096", "1099511627776", {"lists.pool_bytes"}}};
  return kLimits;
}

// A whole number's neighbour.
std::string next_to(const std::string& number, int away) {
  return number == "9223372036854775807" ? "9223372036854775808"
                                         : std::to_string(std::stoll(number) + away);
}

RunConfig preset_with(const std::string& preset, const std::vector<std::string>& overrides) {
  return read_run_config(ConfigSource{preset, overrides}.document(), machine_kinds());
}

// What the listing of keys says a machine's numbers may be: "low..high" by key.
std::map<std::string, std::string> stated_limits(const std::string& preset) {
  RunConfig config = preset_with(preset, {});
  const std::unique_ptr<ConfigWriter> listing = make_listing_writer();
  visit(static_cast<ConfigVisitor&>(*listing), config);
  const std::regex line(R"(([a-z0-9_.]+) = \S*  \((-?[0-9.e+]+\.\.[0-9.e+]+)\)  .*)");
  std::map<std::string, std::string> stated;
  std::istringstream lines(listing->text());
  for (std::string text; std::getline(lines, text);) {
    std::smatch parts;
    if (std::regex_match(text, parts, line)) stated[parts[1]] = parts[2];
  }
  return stated;
}

// Each is the promise of a key to who uses it: one that changes is meant to.
TEST_CASE("key limits: stated and kept to, of all keys of all machines") {
  for (const auto& [machine, preset] : std::vector<std::pair<char, std::string>>{
           {'e', "exact"}, {'p', "paper_no_vq"}, {'g', "gscore"}}) {
    INFO(preset);
    std::map<std::string, std::string> wanted;
    for (const Limits& row : limits()) {
      if (std::string(row.machines).find(machine) == std::string::npos) continue;
      const std::string range = std::string(" in [") + row.low + ", " + row.high + "]";
      for (const std::string& key : row.keys) {
        wanted[key] = std::string(row.low) + ".." + row.high;
        INFO(key);
        for (const char* last : {row.low, row.high}) {
          CHECK_NOTHROW(preset_with(preset, {key + "=" + last}));
        }
        for (const std::string& beyond : {next_to(row.low, -1), next_to(row.high, 1)}) {
          const std::string refusal =
              input_error_of([&, preset = preset] { preset_with(preset, {key + "=" + beyond}); });
          CHECK_THAT(refusal, Contains("--set " + key + "=" + beyond + ": "));
          CHECK_THAT(refusal,
                     Contains(key + ": got " + beyond + ", expected a") && Contains(range));
        }
      }
    }
    CHECK(stated_limits(preset) == wanted);
  }
}

}  // namespace
}  // namespace sgs::test
