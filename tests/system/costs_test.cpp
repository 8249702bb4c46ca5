// Joules and savings of a report, counted a second time from its counters.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/ply_writer.h"
#include "modules/datapath/filter_flows.h"
#include "modules/datapath/lane_steps.h"
#include "testbench/cost/technology.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

double sum_of(const Json& view, const char* name) { return static_cast<double>(total(view, name)); }

// A use of on-chip memory as the report describes it.
Json use_of(const Json& view, const std::string& name) {
  for (const Json& use : view["sram"]["uses"]) {
    if (use["name"] == name) return use;
  }
  FAIL("no use " << name);
  return {};
}

// A unit's area is that of its parts and of on-chip memory; all owners make up the die.
void check_owners(const Json& area) {
  double sum = 0;
  for (const auto& [owner, mm2] : area["by_owner"].items()) sum += mm2.get<double>();
  CHECK(area["with_memory_interface"]["middle"] == Approx(sum));
  const double interface = area["by_owner"]["memory_interface"].get<double>();
  CHECK(area["without_memory_interface"]["middle"] == Approx(sum - interface));
  const auto kind = [&](const char* name) { return area[name].get<double>(); };
  CHECK(area["by_owner"]["memory_path"] == Approx(kind("memory_path")));
  CHECK(area["by_owner"]["vsu"] > kind("vsu"));
  CHECK(area["by_owner"]["sorting"] > kind("sorting"));
  CHECK(area["by_owner"]["hfu"] > kind("coarse") + kind("fine"));
}

void check_joules(const Json& view) {
  const Technology technology = load_technology(SGS_TECHNOLOGY);
  const auto pj = [&](const char* kind) { return technology.part(kind).pj.middle * 1e-12; };
  // Of a test: multiply-accumulates as charged, what comparators do as counted, bits written
  // and selected between the lanes as scheduled.
  const auto test = [&](const char* filter) {
    const Json& counts = view["datapath"][filter]["counts"];
    const auto between = [&](const char* kind) {
      return view["datapath"][filter]["beside"][kind]["operations"].get<double>() * pj(kind);
    };
    return view["datapath"][filter]["used"]["macs"].get<double>() * pj("fp32_lane") +
           (counts["comparisons"].get<double>() +
            kRoundingComparisons * counts["roundings"].get<double>() +
            kConversionComparisons * counts["conversions"].get<double>() +
            counts["index_adds"].get<double>() +
            kLogarithmComparisons * counts["logarithms"].get<double>()) *
               pj("comparator") +
           between("register_bit") + between("select_bit") +
           (counts["divisors"].get<double>() + counts["square_roots"].get<double>() +
            counts["logarithms"].get<double>() + counts["look_ups"].get<double>()) *
               pj("small_table");
  };
  std::map<std::string, double> expected;
  expected["coarse"] = sum_of(view, "coarse_tests") * test("coarse");
  expected["fine"] = sum_of(view, "fine_tests") * test("fine");
  // Keys of two times 32 bits; with them the place in the sorting unit's memory.
  constexpr double kKeyBytes = 8, kBanks = 16;
  const double entries = use_of(view, "compared keys")["bytes"].get<double>() /
                         view["config"]["sorting_units"].get<double>() / kKeyBytes;
  const double bits = 64 + std::ceil(std::log2(entries));
  expected["sorting"] =
      sum_of(view, "compare_exchanges") * (2 * pj("comparator") + bits * pj("exchange_bit"));
  // Keys of longer lists come from any bank.
  if (entries > kBanks) {
    expected["sorting"] += sum_of(view, "moves") * std::log2(kBanks) * bits * pj("select_bit");
  }
  for (const auto& [component, joules] : expected) {
    INFO(component);
    CHECK(joules > 0);
    CHECK(view["energy"][component + "_j"].get<double>() == Approx(joules));
  }
  const Json& energy = view["energy"];
  double sum = 0;
  for (const auto& [component, band] : energy["bands"].items()) {
    INFO(component);
    CHECK(band["middle"] == energy[component]);
    CHECK(band["low"].get<double>() <= band["middle"].get<double>());
    CHECK(band["middle"].get<double>() <= band["high"].get<double>());
    if (component != "total_j") sum += band["middle"].get<double>();
  }
  CHECK(energy["total_j"].get<double>() == Approx(sum));
  // The uses' own joules and square millimetres are those of the sections.
  double mm2 = 0;
  for (const Json& use : view["sram"]["uses"]) {
    std::string component = use["name"];
    for (char& c : component) {
      c = c == ' ' || c == '-' ? '_'
                               : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    CHECK(energy[component + "_j"].get<double>() == Approx(use["energy_j"].get<double>()));
    mm2 += use["mm2"].get<double>();
  }
  CHECK(view["area_mm2"]["sram"].get<double>() == Approx(mm2));
  check_owners(view["area_mm2"]);
  CHECK(use_of(view, "input")["writes"] == total(view, "first_halves"));
  CHECK(use_of(view, "pixel state")["reads"].get<std::uint64_t>() >= total(view, "subtile_blends"));
  double by_region = 0;
  for (const Json& joules : energy["dram_by_region_j"]) by_region += joules.get<double>();
  CHECK(by_region == Approx(energy["dram_j"].get<double>()));
  CHECK(energy["mean_power_w"].get<double>() ==
        Approx(sum / view["frame"]["time_s"].get<double>()));
}

TEST_CASE("costs: joules are counters times prices") {
  for (const char* machine : {"exact", "paper"}) {
    for (const char* encoding : {"raw", "vq_packed"}) {
      INFO(machine << " " << encoding);
      const bool raw = std::string(encoding) == "raw";
      const Simulation simulation(joined(
          with_settings({"builtin:object?n=3000", "--size", "96x54", "--config", machine},
                        {std::string("storage.encoding=") + encoding, "group_width_px=32",
                         "group_height_px=32", "sram.codebook_bytes=256000"}),
          raw ? Arguments{} : Arguments{"--set", "storage.vq.iterations=2", "--weigh-by", "0"}));
      simulation.check();
      check_joules(simulation.views()[0]);
    }
  }
}

// The busiest resource and the one after it, worked out again from the cycles.
void check_binding(const Json& view) {
  std::map<std::string, std::uint64_t> busiest;
  for (const Json& unit : view["units"]) {
    for (const Json& activity : unit["activities"]) {
      std::uint64_t& busy = busiest[activity["resource"]];
      busy = std::max(busy, activity["busy_cycles"].get<std::uint64_t>());
    }
  }
  const auto frame = static_cast<double>(frame_cycles(view));
  const Json& binding = view["binding"];
  const double first = binding["utilisation"], next = binding["next_utilisation"];
  CHECK(first >= next);
  for (const char* which : {"unit", "next"}) {
    const std::string name = binding[which];
    if (name == "dram") continue;
    CHECK(static_cast<double>(busiest.at(name)) / frame ==
          Approx(std::string(which) == "unit" ? first : next));
  }
  for (const auto& [name, busy] : busiest) {
    INFO(name);
    const double share = static_cast<double>(busy) / frame;
    if (name != binding["unit"]) CHECK(share <= Approx(next));
  }
}

TEST_CASE("costs: the rays' remedy is more of what they share and wait for, else more rays") {
  struct Row {
    const char *ray_lanes, *step_lanes, *table_bytes, *key;
  };
  for (const auto& [ray_lanes, step_lanes, table_bytes, key] :
       {Row{"63", "24", "4096", "vsu.rays_in_flight"}, Row{"63", "2", "4096", "vsu.step_lanes"},
        Row{"1", "24", "4096", "vsu.ray_lanes"}, Row{"63", "24", "16", "vsu.table_bytes"}}) {
    CAPTURE(key);
    const Simulation simulation(
        with_settings({"builtin:object?n=3000", "--size", "96x54", "--config", "paper"},
                      {"storage.encoding=raw", std::string("vsu.ray_lanes=") + ray_lanes,
                       std::string("vsu.step_lanes=") + step_lanes,
                       std::string("vsu.table_bytes=") + table_bytes}));
    CHECK(simulation.views()[0]["units"]["vsu"]["activities"]["traverse"]["key"] == key);
  }
}

// Cycles that a splat's beginning, its rows and its sub-tiles took rendering's lanes, counted
// again; rows of span_lanes that are too few for two at a time.
std::map<std::string, double> taken_by_rendering(const Json& view) {
  const Json& config = view["config"]["rendering"];
  const auto interval = [&](const char* datapath, const char* lanes) {
    const double macs = view["datapath"][datapath]["used"]["macs"];
    return std::ceil(macs / config[lanes].get<double>());
  };
  const double hazards = sum_of(view, "hazard_cycles");
  return {{"rendering.begin_lanes",
           sum_of(view, "splats_spanned") * interval("spans_begin", "begin_lanes")},
          {"rendering.span_lanes", sum_of(view, "spans") * interval("row_span", "span_lanes")},
          {"rendering.clusters",
           (sum_of(view, "subtile_blends") * interval("subtile_blend", "cluster_lanes") + hazards) /
               config["clusters"].get<double>()}};
}

TEST_CASE("costs: rendering's remedy is more of the lanes that were taken longest") {
  for (const char* machine : {"exact", "paper_no_vq"}) {
    std::set<std::string> named;
    for (const Arguments& lanes : {Arguments{"begin_lanes=11", "span_lanes=4", "clusters=4"},
                                   {"begin_lanes=5", "span_lanes=10", "clusters=4"},
                                   {"begin_lanes=11", "span_lanes=10", "clusters=4"},
                                   {"begin_lanes=5", "span_lanes=4", "clusters=3"},
                                   {"begin_lanes=73", "span_lanes=20", "clusters=1"}}) {
      Arguments keys = {"hfus=1", "sram.shared_bytes=0", "sram.input_bytes=0"};
      for (const std::string& each : lanes) keys.push_back("rendering." + each);
      const Simulation simulation(
          with_settings({"builtin:object?n=3000", "--size", "96x54", "--config", machine}, keys));
      const Json& view = simulation.views()[0];
      const std::map<std::string, double> taken = taken_by_rendering(view);
      for (const auto& [key, cycles] : taken) UNSCOPED_INFO(key << ' ' << cycles);
      const auto longest =
          std::max_element(taken.begin(), taken.end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
      const std::string key = view["units"]["rendering"]["activities"]["blend"]["key"];
      CHECK(key == longest->first);
      named.insert(key);
    }
    CHECK(named.size() == 3);
  }
}

TEST_CASE("costs: the binding resource is the busiest") {
  for (const char* machine : {"exact", "paper"}) {
    for (const char* slow :
         {"rendering.clusters=1", "hfu.ffu_lanes=1", "hfu.cfu_lanes=1", "dram.channels=1"}) {
      INFO(machine << " " << slow);
      const Simulation simulation(
          {"builtin:object?n=2000", "--size", "96x54", "--config", machine, "--set",
           "storage.encoding=raw", "--set", slow,
           // HFUs that share a fetch have a cluster each
           "--set", std::string(slow) == "rendering.clusters=1" ? "hfus=1" : "hfus=4"});
      check_binding(simulation.views()[0]);
      if (std::string(slow) == "hfu.ffu_lanes=1") {
        CHECK(simulation.views()[0]["binding"]["unit"] == "fine");
      }
    }
  }
}

// The left half of a frame of 4 x 4 groups behind many opaque layers, nothing in the right half.
struct HalfEmpty {
  HalfEmpty() {
    GaussianCloud cloud;
    for (int layer = 0; layer < 300; ++layer) {
      for (const float y : {-1.5F, -0.5F, 0.5F, 1.5F}) {
        cloud.means.emplace_back(-1.5F, y, 4 + 0.01F * static_cast<float>(layer));
        cloud.log_scales.emplace_back(-0.7F);
        cloud.quats.push_back({1, 0, 0, 0});
        cloud.opacity_logits.push_back(6);
        cloud.sh_coeffs.emplace_back(1, 0.5F, 0);
      }
    }
    Camera camera;
    camera.width = camera.height = 64;
    camera.focal_x = camera.focal_y = 64;
    write_ply(folder.path("scene.ply"), cloud);
    write_cameras(folder.path("cameras.json"), {camera});
  }
  Arguments arguments(const char* machine, const char* feedback) const {
    return with_settings(
        {folder.path("scene.ply"), "--cameras", folder.path("cameras.json"), "--config", machine},
        {"group_width_px=16", "group_height_px=16", "storage.encoding=raw",
         std::string("rendering.saturation_feedback=") + feedback});
  }
  ScratchFolder folder;
};

TEST_CASE("costs: what was left out: empty groups are empty, saturated ones saturated") {
  const HalfEmpty scene;
  constexpr std::uint64_t kGroups = 16;
  for (const char* machine : {"exact", "paper"}) {
    INFO(machine);
    const Simulation with(scene.arguments(machine, "true")),
        without(scene.arguments(machine, "false"));
    const Json &view = with.views()[0], &plain = without.views()[0];
    const std::uint64_t empty = left_out(view, "empty_groups");
    // Nothing reaches the rightmost column of groups; every one of the leftmost is drawn on.
    CHECK(empty >= kGroups / 4);
    CHECK(empty <= kGroups * 3 / 4);
    CHECK(left_out(plain, "empty_groups") == empty);
    const std::uint64_t finished = counter_of_all(view, "rendering", "groups_saturated");
    CHECK(finished > 0);
    // In paper order each HFU has its part of every group.
    const std::uint64_t parts = std::string(machine) == "paper" ? 4 : 1;
    CHECK(finished + parts * empty <= parts * kGroups);
    for (const char* what :
         {"saturated_groups", "saturated_visits", "saturated_gaussians", "saturated_tests"}) {
      CHECK(left_out(plain, what) == 0);  // nobody was told
    }
    CHECK(left_out(view, "saturated_gaussians") > 0);
    // Some were dropped with their second half, which was not spared.
    CHECK(left_out(view, "saturated_tests") > 0);
    const std::uint64_t untested = total(view, "second_halves_taken") - total(view, "fine_tests");
    CHECK(left_out(view, "saturated_tests") >= untested);
    if (parts == 1) CHECK(left_out(view, "saturated_tests") == untested);
    CHECK(left_out(view, "saturated_gaussians") + left_out(view, "saturated_tests") ==
          total(view, "dropped_saturated"));
    if (std::string(machine) == "exact") {
      CHECK(left_out(view, "saturated_groups") > 0);
      CHECK(left_out(view, "saturated_groups") <= finished);
    } else {
      CHECK(left_out(view, "saturated_visits") == counter(view, "vsu", "visits_saturated"));
    }
  }
}

TEST_CASE("costs: a path to memory without stages has no registers") {
  for (const int stages : {0, 1}) {
    const Simulation simulation(
        with_settings({"builtin:object?n=50", "--size", "32x18"},
                      {"memory_port.path_cycles=" + std::to_string(stages)}));
    std::set<std::string> path;
    for (const Json& line : simulation.views()[0]["ledger"]["lines"]) {
      const std::string what = line["what"];
      if (what.rfind("memory_path", 0) == 0) path.insert(what);
    }
    std::set<std::string> wanted = {"memory_path: crossbar_bit"};
    if (stages > 0) wanted.insert("memory_path: register_bit");
    CHECK(path == wanted);
  }
}

}  // namespace
}  // namespace sgs::test
