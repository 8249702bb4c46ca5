// Frames back to back, of one eye or two: each picture is the golden one and that of the path,
// whatever the machine, the stalls and the order of processes; what the stream takes is accounted
// for to the last joule.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "testbench/cost/technology.h"
#include "tests/support/shared_inputs.h"
#include "tests/system/frame_checks.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

constexpr int kFrames = 5;

Arguments path_of(const Arguments& machine) {
  return joined({"builtin:object?n=2000", "--size", "97x61", "--path", "builtin:path", "--frames",
                 std::to_string(kFrames), "--cache", "off"},
                machine);
}

class PathRun {
 public:
  explicit PathRun(const Arguments& arguments) {
    const Outcome done =
        run_streaminggs(joined(joined({"simulate"}, arguments), {"--out", out_.path("out")}));
    INFO(done.out << done.err);
    REQUIRE(done.status == 0);
    CHECK(done.err.find("Warning") == std::string::npos);
    report = Json::parse(bytes_of(out_.path("out/report.json")));
    const Json& drawn = report.contains("stream") ? stream()["frames"] : report["views"];
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const std::string number = std::to_string(i);
      const std::string frame =
          out_.path("out/frames/" + std::string(4 - number.size(), '0') + number);
      frames.push_back(bytes_of(frame + ".png"));
      if (report["config"].value("eyes", 1) > 1) frames.push_back(bytes_of(frame + "_right.png"));
    }
    table = bytes_of(out_.path("out/path.csv"));
  }
  const Json& stream() const { return report["stream"]; }
  // Machine and memory over all frames, as the report of a view.
  Json all() const {
    Json view = stream()["all"];
    view["config"] = report["config"];
    view["schema_version"] = report["schema_version"];
    view["view"] = 0;
    view["image"] = {{"equals_streaming_renderer", true}};
    return view;
  }

  Json report;
  std::vector<std::string> frames;  // [frame, eye] PNG
  std::string table;

 private:
  ScratchFolder out_;
};

PathRun stream_of(const Arguments& machine, const std::string& rate = "0") {
  return PathRun(joined(path_of(machine), {"--stream", "--frame-rate", rate}));
}

double number(const Json& value) { return value.get<double>(); }

// What holds of any stream.
void check_stream(const PathRun& run) {
  const Json& stream = run.stream();
  REQUIRE(stream["frames"].size() == kFrames);
  std::uint64_t missed = 0;
  double before_s = 0;
  for (const Json& frame : stream["frames"]) {
    CHECK(frame["equals_streaming_renderer"] == true);
    CHECK(number(frame["pose_s"]) <= number(frame["begun_s"]) + 1e-12);
    CHECK(number(frame["begun_s"]) < number(frame["drawn_s"]));
    CHECK(number(frame["drawn_s"]) <= number(frame["shown_s"]));
    CHECK(before_s < number(frame["drawn_s"]));
    before_s = number(frame["drawn_s"]);
    CHECK(number(frame["buffer_wait_s"]) >= 0);
    CHECK(number(frame["buffer_wait_s"]) < number(frame["time_s"]));
    if (stream["frame_rate"] == 0) CHECK(frame["buffer_wait_s"] == 0);
    missed += frame["held"] == true ? 0 : 1;
  }
  CHECK(stream["missed_frames"] == missed);
  CHECK(stream["worst_frame"] < kFrames);
  const Json view = run.all();
  if (view["config"]["machine"] == "gscore") {
    check_any_machine(view);
    check_halves(view);
  } else {
    check_streaming_machine(view);
  }
  const Json& scene = view["scene"];
  CHECK(scene["gaussians"] == 2000);
  constexpr std::uint64_t kPictureBytes = 3 * 97 * 61;
  const std::vector<std::string> eyes = run.frames.size() > kFrames
                                            ? std::vector<std::string>{"", "right_"}
                                            : std::vector<std::string>{""};
  for (const std::string& eye : eyes) {
    const std::string first = eye + "frame_buffer", second = "second_" + first;
    CHECK(region_bytes(view, first, "write") + region_bytes(view, second, "write") ==
          kFrames * kPictureBytes);
    CHECK(asked_bytes(view, first, "display", "read") +
              asked_bytes(view, second, "display", "read") ==
          stream["pictures"].get<std::uint64_t>() * kPictureBytes);
  }
}

const std::vector<Arguments>& machines() {
  static const std::vector<Arguments> all = {
      with_settings({"--config", "exact"}, {"group_width_px=32", "group_height_px=32"}),
      {"--config", "exact_fp16"},
      with_settings({"--config", "paper_no_vq"}, {"group_width_px=32", "group_height_px=32"}),
      with_settings({"--config", "paper_no_vq"},
                    {"fetch=shared", "vsu.sample_step_voxels=0.5", "sram.shared_bytes=0"}),
      {"--config", "gscore_lossless"},
      with_settings({"--config", "gscore_lossless"}, {"lists.sets=2"}),
      with_settings({"--config", "gscore_lossless_boxes"}, {"lists.sets=2", "lists.tiles=9"}),
      with_settings({"--stereo", "ipd=0.1", "--config", "exact"},
                    {"group_width_px=32", "group_height_px=32"}),
      {"--stereo", "ipd=0.1", "--config", "gscore_lossless"},
      with_settings({"--stereo", "ipd=0.1", "--config", "gscore_lossless_boxes"},
                    {"lists.sets=2", "lists.tiles=9"})};
  return all;
}

// So many pictures a second that frames wait for their buffer, or miss their picture.
const char* const kTight = "40000";

TEST_CASE("stream: every frame is that of the path, with and without a display, with stalls") {
  for (const Arguments& machine : machines()) {
    INFO(machine[1] << " " << machine.back());
    const PathRun path(path_of(machine));
    CHECK(path.frames.size() == (machine[0] == "--stereo" ? 2 : 1) * kFrames);
    for (const char* rate : {"0", kTight}) {
      INFO(rate);
      const PathRun plain = stream_of(machine, rate);
      check_stream(plain);
      CHECK(plain.frames == path.frames);
      const PathRun stalled = stream_of(joined(machine, {"--stalls", "0.2", "--seed", "3"}), rate);
      check_stream(stalled);
      CHECK(stalled.frames == path.frames);
    }
  }
}

TEST_CASE("stream: no order of processes changes a number") {
  for (const Arguments& machine : machines()) {
    INFO(machine[1] << " " << machine.back());
    const Arguments stalled = joined(machine, {"--stalls", "0.2"});
    const auto said = [&](const char* order) {
      PathRun run = stream_of(joined(stalled, {"--process-order", order}), kTight);
      run.report["stream"]["all"] = without_host(run.all());
      return run.report["stream"];
    };
    const Json first = said("0");
    CHECK(said("1") == first);
    CHECK(said("2") == first);
  }
}

TEST_CASE("stream: the next frame begins while this one is drawn, where a machine can") {
  const auto overlaps = [](const Arguments& machine) {
    const PathRun run = stream_of(machine);
    const Json& frames = run.stream()["frames"];
    int early = 0;
    for (std::size_t i = 1; i < kFrames; ++i) {
      early += number(frames[i]["begun_s"]) < number(frames[i - 1]["drawn_s"]) ? 1 : 0;
    }
    return std::pair(early, number(run.stream()["frames_per_s"]));
  };
  for (const char* config : {"exact", "paper_no_vq"}) {
    INFO(config);
    CHECK(overlaps({"--config", config}).first == kFrames - 1);
  }
  for (const Arguments& gscore :
       {Arguments{"--config", "gscore_lossless"},
        Arguments{"--config", "gscore_lossless", "--stereo", "ipd=0.1"}}) {
    INFO(gscore.back());
    const auto [one_early, one] = overlaps(gscore);
    const auto [two_early, two] = overlaps(with_settings(gscore, {"lists.sets=2"}));
    CHECK(one_early == 0);
    CHECK(two_early == kFrames - 1);
    CHECK(two > one);
  }
}

// What a second set, two poses and the display are made of stands in the report.
TEST_CASE("stream: two frames at a time are paid for") {
  const auto area = [](const Json& view, const char* owner) {
    return number(view["area_mm2"]["by_owner"][owner]);
  };
  const Simulation alone(
      {"builtin:object?n=2000", "--size", "97x61", "--config", "gscore_lossless"});
  const PathRun one = stream_of({"--config", "gscore_lossless"}, "1000");
  const PathRun two = stream_of(
      with_settings({"--config", "gscore_lossless"}, {"lists.sets=2", "sram.buffer_bytes=0"}),
      "1000");
  CHECK(alone.views()[0]["area_mm2"].contains("poses") == false);
  for (const PathRun* run : {&one, &two}) {
    const Json view = run->all();
    CHECK(number(view["area_mm2"]["poses"]) > 0);
    CHECK(area(view, "display") > 0);
    CHECK(area(view, "memory_path") > area(alone.views()[0], "memory_path"));
  }
  // The display's port has 256 bits each way, a register each and the multiplexers of four
  // channels; each channel has four entries of 64 bits for its reads.
  const Technology technology = load_technology(SGS_TECHNOLOGY);
  const auto mm2 = [&](const char* kind) { return technology.mm2(kind).middle; };
  const double port = 2 * 256 * (mm2("register_bit") + 4 * mm2("crossbar_bit"));
  const double entries = 4 * 4 * 64 * (mm2("register_bit") + mm2("select_bit"));
  const PathRun unshown = stream_of({"--config", "gscore_lossless"});
  CHECK(area(one.all(), "memory_path") - area(unshown.all(), "memory_path") ==
        Approx(port + entries));
  const auto bytes_of_use = [](const PathRun& run, const std::string& name) {
    std::uint64_t bytes = 0;
    const Json view = run.all();
    for (const Json& use : view["sram"]["uses"]) {
      if (use["name"] == name) bytes += use["bytes"].get<std::uint64_t>();
    }
    return bytes;
  };
  CHECK(bytes_of_use(one, "ends of lists") > 0);
  CHECK(bytes_of_use(two, "ends of lists") == 2 * bytes_of_use(one, "ends of lists"));
  CHECK(bytes_of_use(one, "projected passes") == 0);
  CHECK(bytes_of_use(two, "projected passes") > 0);
  CHECK(bytes_of_use(one, "rows shown") == 2 * 3 * 97);
  const PathRun eyes =
      stream_of({"--config", "gscore_lossless", "--stereo", "ipd=0.1", "--fit-memories"}, "1000");
  CHECK(bytes_of_use(eyes, "rows shown") == 2 * 2 * 3 * 97);
  CHECK(number(eyes.all()["area_mm2"]["poses"]) > number(one.all()["area_mm2"]["poses"]));
}

// Joules of parts, states and commands add up; the machine's clock and the memory stand while no
// frame is under way.
TEST_CASE("stream: its joules close, and rest costs less than work") {
  struct Told {
    double power_w, clock_j, leakage_w, self_refresh, power_down;
  };
  const auto told = [](const Arguments& machine, const char* rate) {
    const PathRun run = stream_of(machine, rate);
    INFO(rate);
    check_stream(run);
    const Json& flow = run.stream()["flow"];
    const Json& energy = flow["energy"];
    double sum = 0;
    for (const auto& [key, joules] : energy.items()) {
      if (key != "bands" && key != "total_j") sum += number(joules);
    }
    CHECK(sum == Approx(number(energy["total_j"])));
    double of_memory = 0, states_s = 0;
    for (const auto& [key, value] : flow["memory"].items()) {
      of_memory += number(value.is_object() ? value["energy_j"] : value);
      states_s += value.is_object() ? number(value["time_s"]) : 0;
    }
    CHECK(of_memory == Approx(number(energy["dram_j"])));
    const double time_s = number(flow["time_s"]);
    CHECK(states_s == Approx(time_s).epsilon(1e-4));
    CHECK(number(flow["power_w"]["middle"]) == Approx(number(energy["total_j"]) / time_s));
    CHECK(number(flow["without_memory_interface_w"]["high"]) ==
          Approx(number(flow["power_w"]["high"])));
    CHECK(number(flow["with_memory_interface_w"]["low"]) > number(flow["power_w"]["low"]));
    if (run.stream()["missed_frames"] == 0 && run.stream()["frame_rate"] > 0) {
      CHECK(time_s == Approx((kFrames - 1) / number(run.stream()["frame_rate"])));
      CHECK(flow["frames"] == kFrames - 1);
    }
    const Json& memory = flow["memory"];
    return Told{number(flow["power_w"]["middle"]),
                number(energy["clock_j"]) / flow["frames"].get<int>(),
                (number(energy["logic_leakage_j"]) + number(energy["sram_leakage_j"])) / time_s,
                number(memory["self_refresh"]["time_s"]) / time_s,
                number(memory["power_down"]["time_s"]) / time_s};
  };
  for (const char* config : {"exact", "gscore_lossless"}) {
    INFO(config);
    const Arguments machine = {"--config", config};
    const Told busy = told(machine, "0"), fast = told(machine, "240"), slow = told(machine, "60");
    CHECK(busy.power_w > fast.power_w);
    CHECK(fast.power_w > slow.power_w);
    CHECK(slow.power_w > slow.leakage_w);
    CHECK(fast.leakage_w == Approx(slow.leakage_w));
    // Of a frame, at whatever rate.
    CHECK(slow.clock_j == Approx(fast.clock_j).epsilon(0.02));
    CHECK(busy.self_refresh < 0.01);
    CHECK(slow.self_refresh > fast.self_refresh);
    CHECK(fast.self_refresh > 0.8);
    const Told down = told(with_settings(machine, {"dram.between_frames=power_down"}), "60");
    CHECK(down.power_down > 0.8);  // left for each refresh
    CHECK(down.self_refresh == 0);
    const Told up = told(with_settings(machine, {"dram.between_frames=by_idle_cycles"}), "60");
    CHECK(up.power_down + up.self_refresh == 0);
    CHECK(up.power_w > down.power_w);
    CHECK(up.power_w > slow.power_w);
  }
}

TEST_CASE("stream: its rate is told as held or missed, and late poses gain what a frame waited") {
  const PathRun held = stream_of({"--config", "exact"}, "1000");
  CHECK(held.stream()["missed_frames"] == 0);
  CHECK(held.stream()["repeated_pictures"] == 0);
  CHECK(number(held.stream()["frames_per_s"]) == Approx(1000).epsilon(0.01));
  CHECK(number(held.stream()["latency"]["worst_s"]) == Approx(1.5e-3));
  const PathRun missed = stream_of({"--config", "exact"}, kTight);
  const Json& stream = missed.stream();
  CHECK(stream["missed_frames"] > 0);
  CHECK(stream["pictures"] == kFrames + stream["repeated_pictures"].get<int>());
  CHECK(number(stream["frames_per_s"]) < std::stod(kTight));
  CHECK(number(stream["latched_late"]["worst_s"]) <= number(stream["latency"]["worst_s"]));
  CHECK(stream["flow"]["frames"] == kFrames);
  for (const PathRun* run : {&held, &missed}) {
    const double rate = number(run->stream()["frame_rate"]);
    for (const Json& frame : run->stream()["frames"]) {
      const double pose_s = number(frame["frame"]) / rate;
      CHECK(number(frame["pose_s"]) == Approx(pose_s).margin(1e-12));
      CHECK(number(frame["latency_s"]) == Approx(number(frame["shown_s"]) - pose_s + 0.5 / rate));
    }
  }
  CHECK(held.table.rfind("frame,pose_s,begun_s,drawn_s,shown_s,time_s,buffer_wait_s,held,", 0) ==
        0);
  CHECK(std::count(held.table.begin(), held.table.end(), '\n') == kFrames + 1);
}

TEST_CASE(
    "stream: rows come to the display in time, though the machine asks for all of a channel") {
  for (const char* config : {"exact", "gscore_lossless", "paper_no_vq"}) {
    INFO(config);
    const PathRun run = stream_of(with_settings({"--config", config}, {"dram.channels=1"}), kTight);
    check_stream(run);
    CHECK(run.stream()["missed_frames"] == kFrames);
    CHECK(run.stream()["rows_late"] == 0);
  }
}

TEST_CASE("stream: gscore blends ahead, and waits for its buffer as it drains") {
  // A frame takes a little longer than a picture.
  const PathRun run = stream_of({"--config", "gscore_lossless"}, "24000");
  CHECK(run.stream()["missed_frames"] > 0);
  double drains = 0, others = 0;
  const Json view = run.all();
  for (const auto& [unit, of_unit] : view["units"].items()) {
    for (const auto& [name, activity] : of_unit["activities"].items()) {
      for (const Json& wait : activity["waits"]) {
        if (wait["for"] != "room" || wait.value("on", "") != unit + ".host") continue;
        (name == "drain" ? drains : others) += number(wait["cycles"]);
      }
    }
  }
  CHECK(drains > 0);
  CHECK(others == 0);
  double waits_s = 0;
  for (const Json& frame : run.stream()["frames"]) waits_s += number(frame["buffer_wait_s"]);
  CHECK(waits_s > 0);
}

// A moment late in a stream has more digits than a double.
TEST_CASE("stream: its frames may be minutes apart") {
  for (const char* config : {"exact", "gscore_lossless"}) {
    const PathRun run = stream_of(with_settings({"--config", config}, {"clock_mhz=700"}), "0.001");
    CHECK(run.stream()["missed_frames"] == 0);
    CHECK(number(run.stream()["latency"]["worst_s"]) == Approx(1500));
  }
}

TEST_CASE("stream: an independent checker accepts the commands of a memory that rests") {
  for (const char* where : {"self_refresh", "power_down"}) {
    INFO(where);
    const ScratchFolder scratch;
    stream_of(
        joined(with_settings({"--config", "exact"}, {std::string("dram.between_frames=") + where}),
               {"--dram-trace", scratch.path("trace")}),
        "500");
    const std::string trace = bytes_of(scratch.path("trace"));
    CHECK(trace.find(where == std::string("power_down") ? " PDE" : " SRE") != std::string::npos);
    const Outcome checked =
        run_program(std::string(SGS_BIN) + "/tb_dram", {"--check", scratch.path("trace")});
    INFO(checked.out << checked.err);
    CHECK(checked.status == 0);
  }
}

// A path of 24 frames of two eyes, as fast as it goes, and shown so fast that rows are read while
// frames are drawn, with stalls and processes in another order: each picture is its reference's, to
// the last bit of a float.
void check_two_eyes_of(const std::string& scene, const std::string& path) {
  constexpr std::size_t kPairs = 24;
  for (const char* machine : {"exact", "gscore_lossless"}) {
    INFO(machine);
    const Arguments common = with_settings(
        {scene, "--path", path, "--frames", std::to_string(kPairs), "--size", "96x54", "--config",
         machine, "--stream", "--stereo", "ipd=0.064", "--fit-memories", "--cache", "off"},
        {"framebuffer=rgb32f"});
    const auto check_equal = [&](const Arguments& more) {
      const PathRun run(joined(common, more));
      CHECK(run.frames.size() == 2 * kPairs);
      CHECK(run.stream()["frames"].size() == kPairs);
      for (const Json& frame : run.stream()["frames"]) {
        CHECK(frame["equals_streaming_renderer"] == true);
        CHECK(frame["empty"] == false);
        CHECK(frame["psnr_db"].is_null());
        CHECK(frame["right_psnr_db"].is_null());
      }
      return run.frames;
    };
    CHECK(check_equal({}) ==
          check_equal({"--frame-rate", "500", "--stalls", "0.1", "--process-order", "1"}));
  }
}
void check_two_eyes_of_shared(const std::string& name) {
  check_two_eyes_of(shared_scene(name), shared_path("cameras/" + name + ".json"));
}
TEST_CASE("stream: two eyes, 24 frames of truck", "[nightly]") {
  check_two_eyes_of_shared("truck");
}
TEST_CASE("stream: two eyes, 24 frames of playbot", "[nightly]") {
  check_two_eyes_of_shared("playbot");
}
TEST_CASE("stream: two eyes, 24 frames of platform", "[nightly]") {
  check_two_eyes_of_shared("platform");
}
TEST_CASE("stream: two eyes, 24 frames of yard", "[nightly]") { check_two_eyes_of_shared("yard"); }
TEST_CASE("stream: two eyes, 24 frames of park", "[nightly]") { check_two_eyes_of_shared("park"); }
TEST_CASE("stream: two eyes, 24 frames of garden", "[nightly]") {
  check_two_eyes_of_shared("garden");
}
TEST_CASE("stream: two eyes, 24 frames of made scenes", "[nightly]") {
  for (const char* scene :
       {"builtin:object?n=60000", "builtin:outdoor?n=100000", "builtin:capture?n=100000"}) {
    INFO(scene);
    check_two_eyes_of(scene, "builtin:path");
  }
}

}  // namespace
}  // namespace sgs::test
