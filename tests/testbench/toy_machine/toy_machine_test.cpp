// A third machine, brought by one line of a factory: what the command says of it comes from its
// data sheets alone.
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "algorithm/scene/camera.h"
#include "testbench/builtin/builtin_scene.h"
#include "testbench/cost/technology.h"
#include "tests/support/scratch_folder.h"
#include "tests/system/frame_checks.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;
using Json = nlohmann::json;

Outcome run_toy(const Arguments& arguments) { return run_program(SGS_STREAMINGGS_TOY, arguments); }

// A simulation of the toy machine with configuration, waveform and what it printed.
class Toy {
 public:
  explicit Toy(const Arguments& options = {}) {
    folder_.write("toy.json",
                  R"({"machine": "toy", "group_px": 16, "fetch": {"buffer_blocks": 3}})");
    printed = run_toy(joined(
        {"simulate", "builtin:object?n=1000", "--size", "70x50", "--config",
         folder_.path("toy.json"), "--out", folder_.path("out"), "--vcd", folder_.path("wave.vcd")},
        options));
    INFO(printed.out << printed.err);
    REQUIRE(printed.status == 0);
    view = views_of_report(folder_.path("out/report.json"))[0];
  }
  std::string file(const std::string& name) const { return bytes_of(folder_.path(name)); }

  Outcome printed;
  Json view;

 private:
  ScratchFolder folder_;
};

constexpr int kGroups = 5 * 4, kPixels = 70 * 50, kGaussians = kGroups * 8;

TEST_CASE("toy machine: frame and counts") {
  const Toy toy;
  check_any_machine(toy.view);
  CHECK(toy.view["config"]["machine"] == "toy");
  CHECK(toy.view["config"]["fetch"]["buffer_blocks"] == 3);
  CHECK(toy.view["config"]["fetch"]["block_gaussians"] == 8);
  CHECK(toy.view["config"]["dram"]["channels"] == 4);
  CHECK(toy.view["units"].size() == 2);
  CHECK(counter(toy.view, "fetch", "gaussians") == kGaussians);
  CHECK(counter(toy.view, "write", "pixels") == kPixels);
  CHECK(toy.view["limit"]["contributing_gaussians"] == kGaussians);
  CHECK(toy.view["image"]["empty"] == false);
  CHECK(cycles(toy.view, "fetch", "ask") == kGroups);
  CHECK(cycles(toy.view, "fetch", "add") == kGaussians);
  CHECK(cycles(toy.view, "write", "write") == 50 * (4 * 4 + 2));  // 16 and 6 px at 4 a cycle
  CHECK(asked_bytes(toy.view, "first_halves", "fetch", "read") == 16 * kGaussians);
  CHECK(asked_bytes(toy.view, "frame_buffer", "write", "write") == 3 * kPixels);
  CHECK(toy.view["dram"]["bytes"] == 16 * kGaussians + 3 * kPixels);
  CHECK(left_out(toy.view, "second_halves") == toy.view["scene"]["gaussians"]);
  CHECK(toy.view["chosen"].size() == 1);
  CHECK(toy.view["chosen"][0]["key"] == "toy.blocks");
  CHECK(toy.view["scene"]["stored_by"] == "file");
}

TEST_CASE("toy machine: binding, energy, area and SRAM follow from its data sheets") {
  const Toy toy;
  const Json& view = toy.view;
  const double frame = static_cast<double>(frame_cycles(view));
  CHECK(view["binding"]["unit"] == "writing");
  CHECK(view["binding"]["utilisation"] ==
        Approx(static_cast<double>(cycles(view, "write", "write")) / frame));

  const Technology technology = load_technology(SGS_TECHNOLOGY);
  const auto pj = [&](const char* kind) { return technology.part(kind).pj.middle * 1e-12; };
  const auto mm2 = [&](const char* kind) { return technology.mm2(kind).middle; };
  const Json& energy = view["energy"];
  CHECK(energy["adder_j"] == Approx(3 * kGaussians * pj("fp32_lane")));
  CHECK(energy["writer_j"] == Approx(kPixels * pj("comparator")));
  const SramUse blocks =
      sram_use("blocks", "scratch", {{3, ""}, {8, ""}, {16, ""}}, {128}, kOneOfEach);
  CHECK(energy["blocks_j"] ==
        Approx(kGaussians * 1e-12 *
               (technology.sram.read_pj(blocks).middle + technology.sram.write_pj(blocks).middle)));
  // Two ports of 256 bits each way, a register each and the multiplexers of four channels.
  const double path = 2 * 2 * 256 * (mm2("register_bit") + 4 * mm2("crossbar_bit"));
  const double logic = 3 * mm2("fp32_lane") + 4 * mm2("comparator") + path;
  // What the queues hold of blocks, writes and colours are registers, and clocked too.
  const double of_lane = technology.part("fp32_lane").register_bits;
  double register_bits = 2 * 2 * 256 + 3 * of_lane, bits_written = 3 * kGaussians * of_lane;
  std::set<std::string> in_registers;
  for (const Json& use : view["sram"]["uses"]) {
    if (use["built_as"] != "registers") continue;
    register_bits += 8 * use["bytes"].get<double>();
    bits_written += use["writes"].get<double>() * use["width_bits"].get<double>();
    in_registers.insert(use["name"]);
  }
  CHECK(in_registers == std::set<std::string>{"fetched", "pixels", "colours"});
  // Beside these what passes the way to the memory is clocked, and gates are in each cycle.
  const double on_the_way =
      view["energy"]["memory_path_j"].get<double>() / (pj("register_bit") + pj("crossbar_bit"));
  CHECK(energy["clock_j"] == Approx((bits_written + on_the_way) * pj(kRegisterClock) +
                                    frame * register_bits / kGatedBits * pj(kClockGate)));
  CHECK(energy["bands"]["clock_j"]["high"] == Approx(frame * register_bits * pj(kRegisterClock)));
  double sum = 0;
  for (const auto& [part, joules] : energy.items()) {
    if (part == "total_j" || part == "bands" || part.find("_j") != part.size() - 2) continue;
    if (joules.is_object()) continue;
    CHECK(joules.get<double>() > 0);
    sum += joules.get<double>();
    CHECK(energy["bands"][part]["low"].get<double>() <= joules.get<double>());
    CHECK(energy["bands"][part]["high"].get<double>() >= joules.get<double>());
  }
  CHECK(energy["total_j"] == Approx(sum));

  const Json& area = view["area_mm2"];
  CHECK(area["adder"] == Approx(3 * mm2("fp32_lane")));
  CHECK(area["writer"] == Approx(4 * mm2("comparator")));
  CHECK(area["total"] == Approx(logic + area["sram"].get<double>()));
  CHECK(area["memory_path"] == Approx(path));
  CHECK(area.size() == 9);  // with bands, by_owner and two totals more
  // Owners are the units, the queue between them, the memory path, and the memory's interface.
  CHECK(area["by_owner"].size() == 5);
  double owned = 0;
  for (const auto& [owner, squares] : area["by_owner"].items()) owned += squares.get<double>();
  CHECK(area["without_memory_interface"]["middle"] == area["total"]);
  CHECK(area["with_memory_interface"]["middle"] == Approx(owned));
  CHECK(owned - area["by_owner"]["memory_interface"].get<double>() == Approx(area["total"]));
  constexpr int kPortTables = 2 * 16 * 8;
  CHECK(left_out(view, "unused_sram_scratch") == 4096 - (3 * 8 * 16 + kPortTables));

  // Blocks, and what ports keep of transactions.
  CHECK(view["sram"]["scratch_bytes"] == 3 * 8 * 16 + kPortTables);
  CHECK(view["sram"]["scratch_available_bytes"] == 4096);
  const auto arithmetic_of = [&](const char* name) {
    for (const Json& use : view["sram"]["uses"]) {
      if (use["name"] == name) return use["arithmetic"].get<std::string>();
    }
    return std::string();
  };
  CHECK(arithmetic_of("blocks") == "3 blocks x 8 Gaussians x 16 B");
  // Of both ports.
  CHECK(arithmetic_of("outstanding transactions") == "2 x 16 transactions x 8 B");
}

TEST_CASE("toy machine: waveform and terminal") {
  const Toy toy({"--verbose"});
  const std::string wave = toy.file("wave.vcd");
  for (const char* scope :
       {"accelerator", "fetch", "ask", "add", "write", "fetched", "colours", "memory"}) {
    INFO(scope);
    CHECK_THAT(wave, Contains("$scope module " + std::string(scope) + " $end"));
  }
  for (const char* signal : {"busy", "waits_for", "fill", "bytes_outstanding", "group"}) {
    INFO(signal);
    CHECK_THAT(wave, Contains("  " + std::string(signal) + " "));
  }
  CHECK_THAT(toy.printed.out, Contains("writing"));       // binding
  CHECK_THAT(toy.printed.out, Contains("first_halves"));  // bytes by region
  CHECK_THAT(toy.printed.out, Contains("adder 0.02"));    // area
  CHECK_THAT(toy.printed.out, Contains("toy.blocks 3"));  // chosen
}

TEST_CASE("toy machine: stalls and orders of processes change no pixel, orders no number") {
  const Toy plain;
  const Arguments stalls = {"--stalls", "0.3"};
  const Toy stalled(stalls);
  check_any_machine(stalled.view);
  CHECK(stalled.file("out/view_0/frame.png") == plain.file("out/view_0/frame.png"));
  CHECK(frame_cycles(stalled.view) > frame_cycles(plain.view));
  for (const char* order : {"1", "2", "3", "4"}) {
    INFO(order);
    CHECK(without_host(Toy({"--process-order", order}).view) == without_host(plain.view));
    const Toy other(joined(stalls, {"--process-order", order}));
    CHECK(without_host(other.view) == without_host(stalled.view));
  }
}

TEST_CASE("toy machine: more SRAM than it has is refused before time begins") {
  const ScratchFolder scratch;
  const Outcome refused = run_toy({"simulate", "builtin:object?n=200", "--size", "20x20", "--out",
                                   scratch.path("out"), "--vcd", scratch.path("wave.vcd"),
                                   "--config", scratch.write("large.json", R"({"machine": "toy",
      "fetch": {"buffer_blocks": 64, "block_gaussians": 1024}})")});
  CHECK(refused.status == 2);
  CHECK_THAT(refused.err, Contains("on-chip memory scratch: 4096 bytes are there, 1049600 are "
                                   "needed: blocks 1048576 (64 blocks x 1024 Gaussians x 16 B)"));
  CHECK(std::count(refused.err.begin(), refused.err.end(), '\n') == 1);
  CHECK(scratch.file_count() == 1);  // its configuration
}

TEST_CASE("toy machine: it stands beside the others") {
  const ScratchFolder scratch;
  // Its keys are its own.
  const Arguments scene = {"simulate", "builtin:object?n=200", "--size", "20x20",
                           "--out",    scratch.path("out")};
  const Outcome unknown = run_toy(joined(scene, {"--set", "fetch.block_gaussians=4"}));
  CHECK(unknown.status == 2);
  CHECK_THAT(unknown.err, Contains("fetch: unknown key"));
  const Outcome refused = run_toy(joined(scene, {"--config", scratch.write("odd.json", R"({
      "machine": "toy", "fetch": {"block_gaussians": 5}})")}));
  CHECK(refused.status == 2);
  CHECK_THAT(refused.err, Contains("fetch.block_gaussians: got 5"));
  // The other machines are there, and a command without it does not know it.
  CHECK(run_toy(scene).status == 0);
  const Outcome stranger = run_streaminggs(joined(scene, {"--set", "machine=toy"}));
  CHECK(stranger.status == 2);
  CHECK_THAT(stranger.err, Contains("machine"));
}

TEST_CASE("toy machine: its golden picture, and a scene packed for it") {
  const ScratchFolder scratch;
  const Arguments scene = {"builtin:object?n=1000", "--size", "70x50"};
  REQUIRE(run_toy(joined(joined({"render"}, scene),
                         {"--ordering", "toy", "--out", scratch.path("toy.png")}))
              .status == 0);
  const Toy toy;
  CHECK(toy.file("out/view_0/frame.png") == bytes_of(scratch.path("toy.png")));

  // By file, packed and read again.
  const std::string file = scratch.path("toy.sgs"), cameras = scratch.path("cameras.json");
  const std::string config = scratch.write("toy.json", R"({"machine": "toy"})");
  write_cameras(cameras, make_builtin_scene("builtin:object?n=1000").cameras);
  REQUIRE(run_toy({"pack", "builtin:object?n=1000", "--out", file, "--config", config}).status ==
          0);
  CHECK_THAT(run_toy({"info", file}).out, Contains("by file, for machine gscore or toy: no table"));
  CHECK_THAT(run_streaminggs({"info", file}).out,
             Contains("by file, for machine gscore: no table"));
  const Arguments view = {file,    "--cameras",        cameras, "--size", "70x50",
                          "--out", scratch.path("out")};
  const Outcome again = run_toy(joined(joined({"simulate"}, view), {"--config", config}));
  INFO(again.out << again.err);
  REQUIRE(again.status == 0);
  CHECK_THAT(again.out, Contains("storage from toy.sgs: raw, neighbours together"));
  const Json packed = views_of_report(scratch.path("out/report.json"))[0];
  CHECK(packed["scene"]["stored_by"] == "file");
  CHECK(packed["scene"] == toy.view["scene"]);
  CHECK(packed["provenance"]["memory_image_xxh64"] == toy.view["provenance"]["memory_image_xxh64"]);
  CHECK(bytes_of(scratch.path("out/view_0/frame.png")) == bytes_of(scratch.path("toy.png")));
  const Outcome stranger = run_streaminggs(joined({"simulate"}, view));
  CHECK(stranger.status == 2);
  CHECK_THAT(stranger.err, Contains("stored by file; machine exact reads scenes stored by chunks: "
                                    "take --config gscore, or pack the scene again"));
  // An order without sizes has no keys for them.
  for (const char* key : {"storage.voxel_size=1", "storage.chunk_gaussians=8"}) {
    const Outcome unknown =
        run_toy(joined(joined({"simulate"}, scene),
                       {"--config", config, "--set", key, "--out", scratch.path("no")}));
    CHECK(unknown.status == 2);
    CHECK_THAT(unknown.err, Contains("unknown key"));
  }
}

}  // namespace
}  // namespace sgs::test
