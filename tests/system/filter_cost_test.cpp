// hfu.cost: what a test costs, in cycles and energy, by the paper or as counted.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/ply_writer.h"
#include "testbench/builtin/builtin_scene.h"
#include "testbench/cost/technology.h"
#include "tests/support/scratch_folder.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

const Arguments kObject = with_settings({"builtin:object?n=3000", "--size", "96x54"},
                                        {"group_width_px=32", "group_height_px=32"});

Arguments with(Arguments arguments, const std::string& setting) {
  arguments.insert(arguments.end(), {"--set", setting});
  return arguments;
}

std::uint64_t fine_busy(const Json& view) {
  std::uint64_t sum = 0;
  for (const auto& [name, unit] : view["units"].items()) {
    if (name.find(".fine") != std::string::npos) sum += cycles(view, name, "filter");
  }
  return sum;
}

// The fine filters are busy for as long as the report says that their tests take, a cycle for the
// mark of each group and, before a test, until its turn at the lanes.
void check_charged(const Json& view, const char* whose) {
  const Json& fine = view["datapath"]["fine"];
  const Json& coarse = view["datapath"]["coarse"];
  CHECK(fine["used"] == fine[whose]);
  CHECK(coarse["used"] == coarse[whose]);
  const Json& hfu = view["config"]["hfu"];
  CHECK(hfu["ffu_macs"] == fine[whose]["macs"]);
  CHECK(hfu["cfu_macs"] == coarse[whose]["macs"]);
  const auto tests = total(view, "fine_tests");
  const auto interval = fine[whose]["interval_cycles"].get<std::uint64_t>();
  const std::uint64_t least = tests * interval + total(view, "groups");
  CHECK(fine_busy(view) >= least);
  CHECK(fine_busy(view) <= least + tests * (interval - 1));
}

// What comparators did beside the lanes is the same whatever the lanes are charged.
double joules_a_mac(const Json& view, const char* filter, const char* counter) {
  const Technology technology = load_technology(SGS_TECHNOLOGY);
  const Json& path = view["datapath"][filter];
  const double joules = view["energy"][std::string(filter) + "_j"].get<double>() /
                        static_cast<double>(total(view, counter));
  double beside = 0;
  for (const auto& [kind, part] : path["beside"].items()) {
    beside += part["operations"].get<double>() * technology.part(kind).pj.middle * 1e-12;
  }
  return (joules - beside) / path["used"]["macs"].get<double>();
}

TEST_CASE(
    "filter cost: counted is exact order's default, the paper's changes time and energy, no "
    "pixel") {
  const Simulation paper(with(kObject, "hfu.cost=paper")), counted(kObject);
  paper.check();
  counted.check();
  CHECK(counted.frame(0) == paper.frame(0));
  const Json &p = paper.views()[0], &c = counted.views()[0];
  check_charged(p, "paper");
  check_charged(c, "counted");
  CHECK(p["datapath"]["fine"]["paper"]["macs"] == 427);
  CHECK(p["datapath"]["coarse"]["paper"]["macs"] == 55);
  CHECK(p["datapath"]["fine"]["counted"] == c["datapath"]["fine"]["counted"]);
  CHECK(joules_a_mac(p, "fine", "fine_tests") ==
        Approx(joules_a_mac(c, "fine", "fine_tests")).epsilon(1e-12));
  CHECK(joules_a_mac(p, "coarse", "coarse_tests") ==
        Approx(joules_a_mac(c, "coarse", "coarse_tests")).epsilon(1e-12));
  CHECK(p["chosen"].size() + 2 == c["chosen"].size());
}

TEST_CASE("filter cost: counted, a scene of degree 0 pays for no SH bands") {
  BuiltinScene scene = make_builtin_scene(kObject[0]);
  std::vector<glm::vec3> constant_terms;
  for (std::size_t i = 0; i < scene.cloud.size(); ++i) {
    constant_terms.push_back(scene.cloud.sh_coeffs[16 * i]);
  }
  scene.cloud.sh_degree = 0;
  scene.cloud.sh_coeffs = constant_terms;
  const ScratchFolder scratch;
  write_ply(scratch.path("scene.ply"), scene.cloud);
  write_cameras(scratch.path("cameras.json"), scene.cameras);
  Arguments flat = with(kObject, "hfu.cost=counted");
  flat[0] = scratch.path("scene.ply");
  flat.insert(flat.end(), {"--cameras", scratch.path("cameras.json")});
  const Simulation degree_0(flat), degree_3(with(kObject, "hfu.cost=counted"));
  degree_0.check();
  const Json &low = degree_0.views()[0], &high = degree_3.views()[0];
  check_charged(low, "counted");
  CHECK(low["datapath"]["fine"]["paper"] == high["datapath"]["fine"]["paper"]);
  CHECK(low["datapath"]["fine"]["counted"]["interval_cycles"] <
        high["datapath"]["fine"]["counted"]["interval_cycles"]);
  CHECK(low["datapath"]["coarse"] == high["datapath"]["coarse"]);
  CHECK(low["energy"]["fine_j"].get<double>() / static_cast<double>(total(low, "fine_tests")) <
        high["energy"]["fine_j"].get<double>() / static_cast<double>(total(high, "fine_tests")));
}

Outcome print_config(const Arguments& settings) {
  Arguments arguments = {"simulate"};
  arguments.insert(arguments.end(), kObject.begin(), kObject.end());
  for (const std::string& setting : settings) {
    arguments.insert(arguments.end(), {"--set", setting});
  }
  arguments.emplace_back("--print-config");
  return run_streaminggs(arguments);
}

TEST_CASE("filter cost: unknown names, and numbers beside those that are counted, are refused") {
  struct Row {
    Arguments settings;
    const char* expected;
  };
  for (const auto& [settings, expected] : std::vector<Row>{
           {{"hfu.cost=free"}, "hfu.cost: got \"free\""},
           {{"hfu.cfu_macs=80"}, "hfu.cfu_macs: got 80 with hfu.cost counted, expected 0 or the "},
           {{"hfu.ffu_macs=1"}, "hfu.ffu_macs: got 1 with hfu.cost counted, expected 0 or the "}}) {
    const Outcome refused = print_config(settings);
    CAPTURE(refused.err);
    CHECK(refused.status == 2);
    CHECK(refused.err.find(expected) != std::string::npos);
    CHECK(std::count(refused.err.begin(), refused.err.end(), '\n') == 1);
  }
}

TEST_CASE("filter cost: with paper a number that is given is charged, else the paper's") {
  const auto macs = [](const Arguments& settings) {
    const Simulation simulation(with_settings(kObject, settings));
    const Json& hfu = simulation.views()[0]["config"]["hfu"];
    return std::pair(hfu["cfu_macs"].get<int>(), hfu["ffu_macs"].get<int>());
  };
  CHECK(macs({"hfu.cost=paper"}) == std::pair(55, 427));
  CHECK(macs({"hfu.cost=paper", "hfu.cfu_macs=80"}) == std::pair(80, 427));
}

}  // namespace
}  // namespace sgs::test
