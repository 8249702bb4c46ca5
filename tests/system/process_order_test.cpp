// The standard leaves open in which order the processes of one instant act. They act in several
// here: not a number of the report and not a command of the memory may change.
#include <catch2/catch.hpp>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/shared_inputs.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

// Everything that a run says.
struct Said {
  std::vector<Json> views;
  std::map<std::string, std::string> commands;  // of each channel of the memory
};

// How the lines of different channels lie between each other means nothing.
std::map<std::string, std::string> by_channel(const std::string& trace) {
  std::map<std::string, std::string> commands;
  std::istringstream lines(trace);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string cycle, channel;
    words >> cycle >> channel;
    commands[cycle == "#" ? cycle : channel] += line + "\n";
  }
  return commands;
}

Said run_in_order(const Arguments& arguments, int order) {
  const ScratchFolder scratch;
  const Simulation simulation(joined(arguments, {"--process-order", std::to_string(order),
                                                 "--dram-trace", scratch.path("trace")}));
  simulation.check();
  Said said{{}, by_channel(bytes_of(scratch.path("trace")))};
  for (const Json& view : simulation.views()) said.views.push_back(without_host(view));
  return said;
}

Said check_orders(const Arguments& arguments) {
  const Said first = run_in_order(arguments, 0);
  CHECK(first.commands.size() > 1);
  CHECK(first.commands.at("0").size() > 1000);
  for (int order = 1; order <= 3; ++order) {
    INFO("order " << order);
    const Said other = run_in_order(arguments, order);
    CHECK(other.views == first.views);
    CHECK(other.commands == first.commands);
  }
  return first;
}

// What is dropped depends on when the news of a finished group arrives.
void check_orders_with_drops(const Arguments& arguments) {
  const Said said = check_orders(arguments);
  REQUIRE(total(said.views[0], "groups_saturated") > 0);
  REQUIRE(total(said.views[0], "dropped_saturated") > 0);
}

Arguments settings(const std::vector<std::string>& keys) {
  Arguments arguments;
  for (const std::string& key : keys) arguments.insert(arguments.end(), {"--set", key});
  return arguments;
}

const Arguments kStalls = {"--stalls", "0.2", "--seed", "3"};

// What the machines are run with.
std::vector<Arguments> variants(const std::string& machine) {
  const Arguments quantised =
      joined(settings({"storage.encoding=vq_packed", "storage.vq.iterations=2",
                       "sram.codebook_bytes=256000"}),
             {"--weigh-by", "0"});
  const Arguments few_banks = joined(quantised, settings({"codebook.banks=2"}));
  const Arguments narrow = settings({"memory_port.max_outstanding=1", "dram.channels=1"});
  const Arguments hasty = settings({"rendering.feedback_latency_cycles=1", "lane_latency_cycles=1",
                                    "half_lane_latency_cycles=1", "rendering.span_slots=1"});
  // So many reads at once that channels hold several ports back.
  const Arguments crowded =
      settings({"memory_port.max_outstanding=64", "hfu.second_half_slots=64", "hfu.input_slots=16",
                "sram.shared_bytes=1073741824", "sram.input_bytes=1073741824"});
  std::vector<Arguments> out = {
      {},
      crowded,
      kStalls,
      few_banks,
      joined(few_banks, kStalls),
      narrow,
      joined(narrow, kStalls),
      joined(hasty, settings({"clock_mhz=533.33"})),
      settings({"hfus=3", "sorting_units=1", "dram.power_down_idle_cycles=10"})};
  if (machine == "paper") {
    const Arguments shared = settings({"fetch=shared", "sorting_units=1", "vsu.table_bytes=64"});
    out.insert(out.end(), {shared, joined(few_banks, joined(shared, kStalls))});
  }
  return out;
}

// Groups so small that some saturate.
const Arguments kOrderScene =
    with_settings({"--size", "97x61"}, {"group_width_px=8", "group_height_px=8"});

Arguments scene(const char* machine) {
  return joined({"builtin:object?n=6000", "--config", machine}, kOrderScene);
}

TEST_CASE("process order: small frames") {
  for (const char* machine : {"exact", "paper_no_vq", "gscore"}) {
    INFO(machine);
    check_orders(joined({"builtin:object?n=500", "--size", "48x32", "--config", machine}, kStalls));
  }
}

TEST_CASE("process order: exact order", "[nightly]") {
  for (const Arguments& variant : variants("exact")) {
    INFO((variant.empty() ? "plain" : variant.back()));
    check_orders_with_drops(joined(scene("exact"), variant));
  }
}

TEST_CASE("process order: paper order", "[nightly]") {
  const Arguments raw = joined(scene("paper"), settings({"storage.encoding=raw"}));
  for (const Arguments& variant : variants("paper")) {
    INFO((variant.empty() ? "plain" : variant.back()));
    check_orders_with_drops(joined(raw, variant));
  }
}

TEST_CASE("process order: FIFOs of one entry, and what does not fit goes to DRAM", "[nightly]") {
  const Arguments both = settings({"hfu.candidate_fifo_entries=1", "rendering.input_fifo_entries=1",
                                   "hfu.second_half_slots=1", "hfu.input_slots=2"});
  const Arguments exact =
      settings({"merge.input_fifo_entries=1", "merge.output_fifo_entries=1", "merge.entries=32",
                "merge.spill_block_entries=2", "vsu.queue_entries=9", "vsu.node_queue_entries=9"});
  const Arguments paper = settings({"sorting.input_fifo_entries=1", "sorting.buffer_entries=16",
                                    "vsu.visit_gaussians=0", "storage.encoding=raw"});
  for (const Arguments& stalls : {Arguments{}, kStalls}) {
    INFO(stalls.size());
    check_orders_with_drops(joined(joined(joined(scene("exact"), both), exact), stalls));
    check_orders_with_drops(joined(joined(joined(scene("paper"), both), paper), stalls));
  }
}

TEST_CASE("process order: a real scene", "[nightly]") {
  const Arguments truck = {shared_scene("truck"), "--cameras", shared_path("cameras/truck.json"),
                           "--size", "160x90"};
  check_orders(joined(truck, kStalls));
  check_orders(joined(truck, {"--config", "paper_no_vq", "--stalls", "0.2"}));
}

}  // namespace
}  // namespace sgs::test
