// A timeline, decoded: its slices nest, and add up to what the report says of every activity, to
// the cycle.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/support/trace_decoder.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

const Arguments kTimelineScene = {"builtin:object?n=2000", "--size", "96x54"};

bool is_item(const TraceSlice& slice) {
  return slice.name.rfind("group ", 0) == 0 || slice.name.rfind("tile ", 0) == 0 ||
         slice.name.rfind("visit ", 0) == 0;
}

const TraceTrack* track_named(const DecodedTrace& trace, const std::string& name) {
  for (const auto& [uuid, track] : trace.tracks) {
    if (track.name == name) return &track;
  }
  return nullptr;
}

void check_nesting(const TraceTrack& track, std::uint64_t frame_cycles) {
  std::vector<const TraceSlice*> open;
  for (const TraceSlice& slice : track.slices) {
    CHECK(slice.begin < slice.end);
    CHECK(slice.end <= frame_cycles);
    REQUIRE(slice.depth <= open.size());
    if (open.size() > slice.depth) CHECK(open[slice.depth]->end <= slice.begin);
    open.resize(slice.depth);
    if (!open.empty()) {
      CHECK(is_item(*open.back()));  // nothing lies within work or waiting
      CHECK(open.back()->begin <= slice.begin);
      CHECK(slice.end <= open.back()->end);
    }
    open.push_back(&slice);
  }
}

// "waits for room: visits_to_hfu0", of a wait of the report.
std::string name_of(const Json& wait) {
  const std::string name = "waits for " + wait["for"].get<std::string>();
  return wait.contains("on") ? name + ": " + wait["on"].get<std::string>() : name;
}

void check_activity(const TraceTrack& track, const Json& activity, std::uint64_t frame_cycles) {
  INFO(track.name);
  check_nesting(track, frame_cycles);
  std::map<std::string, std::uint64_t> cycles, expected;
  for (const TraceSlice& slice : track.slices) {
    if (!is_item(slice)) cycles[slice.name] += slice.end - slice.begin;
  }
  if (activity["busy_cycles"] > 0) expected["busy"] = activity["busy_cycles"];
  for (const Json& wait : activity["waits"]) {
    if (wait["for"] != "idle") expected[name_of(wait)] += wait["cycles"].get<std::uint64_t>();
  }
  CHECK(cycles == expected);
}

void check_levels(const DecodedTrace& trace, const Json& view) {
  std::size_t queues = 0, ports = 0;
  for (const auto& [uuid, track] : trace.tracks) {
    if (!track.counter) continue;
    INFO(track.name);
    const std::size_t of = track.name.find(" (of ");
    queues += of != std::string::npos ? 1 : 0;
    ports += track.unit == "B outstanding" ? 1 : 0;
    const double most = of == std::string::npos ? 1e9 : std::stod(track.name.substr(of + 5));
    for (const auto& [time, value] : track.values) {
      CHECK(value >= 0);
      CHECK(value <= most);
    }
    // Drained.
    if (!track.values.empty() && (of != std::string::npos || track.unit == "B outstanding")) {
      const bool credits = track.name.find("free") != std::string::npos;
      if (!credits) CHECK(track.values.back().second == 0);
    }
  }
  CHECK(queues > 5);
  CHECK(ports > 2);
  const TraceTrack* bus = track_named(trace, "data buses");
  REQUIRE(bus != nullptr);
  double bytes = 0;
  const double step_ns = 256 / view["config"]["clock_mhz"].get<double>() * 1e3;
  const auto& values = bus->values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double peak = view["dram"]["peak_gb_s"];
    CHECK(values[i].second <= peak * 1.05);  // a burst counts in the step in which it begins
    const std::uint64_t until = i + 1 < values.size() ? values[i + 1].first : values[i].first + 256;
    bytes += values[i].second * step_ns * static_cast<double>((until - values[i].first) / 256);
  }
  CHECK(bytes == Approx(view["dram"]["bus_bytes"].get<double>()));
}

TEST_CASE("timeline: slices are the report's cycles, on every machine") {
  struct Row {
    std::vector<std::string> machine;
    const char* item;   // of which the last activity's slices are
    const char* track;  // that has one for each of them
    std::size_t items;
  };
  for (const Row& row : std::vector<Row>{
           {{"--config", "exact", "--set", "group_width_px=32", "--set", "group_height_px=32"},
            "group",
            "rendering.blend",
            6},
           {{"--config", "exact", "--set", "clock_mhz=700"}, "group", "rendering.drain", 1},
           {{"--config", "exact", "--stalls", "0.05"}, "group", "rendering.blend", 1},
           {{"--config", "exact_vq", "--set", "storage.vq.iterations=1", "--set",
             "sram.codebook_bytes=256000"},
            "group",
            "hfu0.fine.decode",
            1},
           {{"--config", "paper_no_vq"}, "group", "vsu.emit", 2},
           {{"--config", "gscore"}, "tile", "", 0}}) {
    INFO(row.machine[1] << " " << row.machine.back());
    const ScratchFolder scratch;
    const std::string file = scratch.path("t.pftrace");
    const Simulation run(joined(kTimelineScene, joined(row.machine, {"--timeline", file})));
    const Json& view = run.views()[0];
    const DecodedTrace trace = decode_trace(bytes_of(file));
    std::size_t activities = 0;
    for (const auto& [unit, of_unit] : view["units"].items()) {
      for (const auto& [name, activity] : of_unit["activities"].items()) {
        const TraceTrack* track = track_named(trace, unit + "." + name);
        REQUIRE(track != nullptr);
        CHECK(trace.tracks.at(track->parent).name == unit);
        check_activity(*track, activity, frame_cycles(view));
        ++activities;
      }
    }
    CHECK(activities > 10);
    check_levels(trace, view);
    if (row.items == 0) continue;
    const TraceTrack* track = track_named(trace, row.track);
    REQUIRE(track != nullptr);
    std::size_t items = 0;
    for (const TraceSlice& slice : track->slices) {
      items += slice.depth == 0 && slice.name == row.item + (" " + std::to_string(items)) ? 1 : 0;
    }
    CHECK(items == row.items);
  }
}

TEST_CASE("timeline: visits and keys of exact order") {
  const ScratchFolder scratch;
  const std::string file = scratch.path("t.pftrace");
  const Simulation run(joined(kTimelineScene, {"--config", "exact", "--timeline", file}));
  const Json& view = run.views()[0];
  const DecodedTrace trace = decode_trace(bytes_of(file));
  // Of every visit each HFU's coarse filter has one slice or none.
  std::uint64_t visits = 0;
  for (const char* hfu : {"hfu0", "hfu1"}) {
    const TraceTrack* track = track_named(trace, hfu + std::string(".coarse.filter"));
    REQUIRE(track != nullptr);
    for (const TraceSlice& slice : track->slices) visits += slice.name.rfind("visit ", 0) == 0;
  }
  const std::uint64_t shares = total(view, "shares");
  CHECK(visits <= shares);
  CHECK(visits > shares * 9 / 10);
  const TraceTrack* pending = track_named(trace, "merge.pending");
  REQUIRE(pending != nullptr);
  CHECK(pending->unit == "keys");
  double most = 0;
  for (const auto& [time, value] : pending->values) most = std::max(most, value);
  CHECK(most > 0);
  CHECK(most <= view["units"]["merge"]["counters"]["pending_keys_max"].get<double>());
}

TEST_CASE("timeline: bound to groups") {
  const ScratchFolder scratch;
  const std::string all = scratch.path("all"), some = scratch.path("some");
  const Arguments machine = {"--config",          "exact", "--set",
                             "group_width_px=32", "--set", "group_height_px=32"};
  const Simulation of_all(joined(kTimelineScene, joined(machine, {"--timeline", all})));
  const Simulation of_some(
      joined(kTimelineScene, joined(machine, {"--timeline", some, "--timeline-groups", "2-3"})));
  CHECK(std::filesystem::file_size(some) < std::filesystem::file_size(all) * 2 / 3);
  const DecodedTrace whole = decode_trace(bytes_of(all)), part = decode_trace(bytes_of(some));
  // What is shown of a group is what all of the frame shows of it.
  const auto slices_of = [](const TraceTrack& track, const std::string& group) {
    std::vector<std::string> found;
    bool within = false;
    for (const TraceSlice& slice : track.slices) {
      if (slice.depth == 0) within = slice.name == group;
      if (within) {
        found.push_back(slice.name + " " + std::to_string(slice.begin) + " " +
                        std::to_string(slice.end));
      }
    }
    return found;
  };
  for (const auto& [uuid, track] : part.tracks) {
    if (track.counter) continue;
    for (const TraceSlice& slice : track.slices) {
      if (slice.depth == 0) CHECK((slice.name == "group 2" || slice.name == "group 3"));
    }
    for (const char* group : {"group 2", "group 3"}) {
      CHECK(slices_of(track, group) == slices_of(whole.tracks.at(uuid), group));
    }
  }
  CHECK_FALSE(slices_of(*track_named(part, "rendering.blend"), "group 3").empty());
}

TEST_CASE("timeline: it changes nothing") {
  const ScratchFolder scratch;
  for (const char* machine : {"exact", "paper_no_vq", "gscore"}) {
    const Arguments plain = joined(kTimelineScene, {"--config", machine});
    const Simulation a(plain);
    const Simulation b(
        joined(plain, {"--timeline", scratch.path("t"), "--vcd", scratch.path("v")}));
    for (const char* section : {"frame", "units", "dram", "energy"}) {
      CHECK(a.views()[0][section] == b.views()[0][section]);
    }
  }
}

}  // namespace
}  // namespace sgs::test
