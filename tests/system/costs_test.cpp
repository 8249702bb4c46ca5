// What a report advises to have more of.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

double sum_of(const Json& view, const char* name) { return static_cast<double>(total(view, name)); }

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

}  // namespace
}  // namespace sgs::test
