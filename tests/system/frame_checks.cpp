// Accounts, bytes, flow and bounds of a view.
#include "tests/system/frame_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "algorithm/image/image_io.h"
#include "algorithm/image/quality.h"
#include "tests/system/report_values.h"

namespace sgs::test {
namespace {

using Json = nlohmann::json;

std::uint64_t count(const Json& value) { return value.get<std::uint64_t>(); }

std::uint64_t ceil_div(std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; }

// 0 where the unit has no such counter.
std::uint64_t of(const Json& unit, const char* name) {
  return unit["counters"].value(name, std::uint64_t{0});
}

// Where a key is stated, the configuration has it.
void check_key(const Json& view, const Json& stated) {
  if (!stated.contains("key")) return;
  std::string path = "/" + stated["key"].get<std::string>();
  std::replace(path.begin(), path.end(), '.', '/');
  INFO(path);
  CHECK(view["config"].contains(Json::json_pointer(path)));
}

void check_accounts(const Json& view) {
  std::size_t activities = 0;
  for (const auto& [name, unit] : view["units"].items()) {
    for (const auto& [activity, spent] : unit["activities"].items()) {
      INFO(name << " " << activity);
      ++activities;
      std::uint64_t waited = 0, by_place = 0;
      for (const Json& cycles : spent["waited_cycles"]) waited += count(cycles);
      for (const Json& wait : spent["waits"]) {
        by_place += count(wait["cycles"]);
        CHECK(wait.contains("on") == (wait["for"] != "idle" && wait["for"] != "phase"));
        check_key(view, wait);
      }
      CHECK(count(spent["busy_cycles"]) + waited == frame_cycles(view));
      CHECK(by_place == waited);
      CHECK(count(spent["busy_cycles"]) <= frame_cycles(view));
      CHECK_FALSE(spent["resource"].get<std::string>().empty());
      check_key(view, spent);
    }
  }
  CHECK(activities > 0);
  const Json& binding = view["binding"];
  CHECK_FALSE(binding["holds"].get<std::string>().empty());
  check_key(view, binding);
}

void check_memory(const Json& view) {
  std::uint64_t sum = 0;
  for (const Json& region : view["dram"]["bytes_by_region"]) {
    for (const Json& requester : region) {
      for (const Json& bytes : requester) sum += count(bytes);
    }
  }
  CHECK(sum == count(view["dram"]["bytes"]));
  std::uint64_t on_bus = 0;
  for (const Json& bytes : view["dram"]["bus_bytes_by_region"]) on_bus += count(bytes);
  CHECK(on_bus == count(view["dram"]["bus_bytes"]));
  const double bytes_a_cycle =
      view["dram"]["peak_gb_s"].get<double>() * 1e3 / view["config"]["clock_mhz"].get<double>();
  CHECK(static_cast<double>(on_bus) <= bytes_a_cycle * static_cast<double>(frame_cycles(view) + 1));
}

bool quantised(const Json& view) {
  const std::string encoding = view["config"]["storage"]["encoding"];
  return encoding == "vq" || encoding == "vq_packed";
}

// Of one second half as encoded, from the configuration and the codebooks' entries.
std::uint64_t encoded_bytes(const Json& view) {
  const auto degree = view["scene"]["sh_degree"].get<std::uint64_t>();
  const std::uint64_t raw = 4 * (7 + 3 * (degree + 1) * (degree + 1));
  const std::string encoding = view["config"]["storage"]["encoding"];
  if (encoding == "raw") return raw;
  if (encoding == "half") return raw / 2;
  std::uint64_t indices = 0, bits = 0;
  for (const Json& codebook : view["scene"]["codebooks"]) {
    indices += count(codebook["entries"]) > 1 ? 1 : 0;
    for (std::uint64_t told_apart = 1; told_apart < count(codebook["entries"]); told_apart *= 2) {
      ++bits;
    }
  }
  if (encoding == "vq") return 4 * indices + 1;
  std::uint64_t bytes = 1;
  while (8 * bytes < 8 + bits) bytes *= 2;
  return bytes;
}

struct HalfBytes {
  std::uint64_t first, second;
};

// By voxels as published; by chunks with the largest scale, in whole bursts; by file so where the
// first half stays as short (algorithm/memory).
HalfBytes half_bytes(const Json& view) {
  const std::uint64_t encoded = encoded_bytes(view);
  if (view["scene"]["stored_by"] == "voxels") return {16, encoded};
  const auto degree = view["scene"]["sh_degree"].get<std::size_t>();
  const bool by_file = view["scene"]["stored_by"] == "file";
  constexpr HalfBytes kRaw[] = {{24, 32}, {16, 80}, {24, 128}, {16, 224}};
  constexpr std::uint64_t kHalf[] = {32, 48, 72, 128};
  const std::string encoding = view["config"]["storage"]["encoding"];
  if (encoding == "raw" && by_file && degree % 2 == 0) return {16, encoded};
  if (encoding == "raw") return kRaw[degree];
  if (encoding == "half") return {16, kHalf[degree]};
  std::uint64_t bytes = 1;
  while (bytes < encoded + 4) bytes *= 2;
  return {16, bytes};
}

// HFUs behind one fetch, each with its part of the groups.
std::uint64_t parts_of(const Json& config) {
  return config["machine"] == "paper" && config["fetch"] == "shared" ? count(config["hfus"]) : 1;
}

// Eyes of an exact machine, each with FFUs and a rendering unit of its own.
std::uint64_t eyes_of(const Json& config) {
  return config["machine"] == "exact" ? count(config["eyes"]) : 1;
}

// Codebooks come once, decoding is for what was fetched.
void check_codebooks(const Json& view) {
  std::uint64_t bytes = 0;
  for (const Json& codebook : view["scene"]["codebooks"]) {
    bytes += 4 * count(codebook["entries"]) * count(codebook["words"]);
  }
  const bool preloaded = view["config"]["codebook"]["preloaded"];
  CHECK(region_bytes(view, "codebooks", "read") == (preloaded ? 0 : bytes));
  CHECK(total(view, "bytes_loaded") == (preloaded ? 0 : bytes));
  // Few entries in many banks are registers, which are no bytes of the memory.
  std::uint64_t held = 0, of_memory = 0;
  for (const Json& use : view["sram"]["uses"]) {
    if (use["memory"] != "codebook") continue;
    held += count(use["bytes"]);
    of_memory += use["built_as"] == "sram" ? count(use["bytes"]) : 0;
  }
  CHECK(held == bytes);
  CHECK(count(view["sram"]["codebook_bytes"]) == of_memory);
  CHECK(bytes <= count(view["config"]["sram"]["codebook_bytes"]));
  CHECK(view["units"].contains("codebooks") == quantised(view));
  if (!quantised(view)) return;
  // Where several HFUs share a fetch each decodes what it takes of it.
  CHECK(total(view, "records_decoded") <= total(view, "second_halves_taken"));
  CHECK(total(view, "records_decoded") >= total(view, "fine_tests"));
  if (view["config"]["rendering"]["saturation_feedback"] == false) {
    CHECK(total(view, "dropped_saturated") == 0);
    CHECK(total(view, "records_decoded") == total(view, "second_halves_taken"));
  }
  // An HFU reads a line a cycle; what is dropped passes in a cycle, and so does a mark: in exact
  // order that of a group and what stands for a Gaussian that was not fetched, in paper order that
  // of each HFU's share of a visit.
  const std::uint64_t dropped = total(view, "second_halves_taken") - total(view, "records_decoded");
  std::uint64_t marks = total(view, "shares") * parts_of(view["config"]);
  if (view["config"]["machine"] == "exact") {
    marks = counter_of_all(view, "rendering", "groups");
    for (const auto& [name, unit] : view["units"].items()) {
      const Json& counters = unit["counters"];
      if (!counters.contains("fine_tests")) continue;
      marks += count(counters["dropped_saturated"]) - count(counters["dropped_fetched"]);
    }
  }
  CHECK(total_busy(view, "decode") ==
        total(view, "lines_read") + total(view, "bank_conflict_cycles") + dropped + marks);
}

// Bytes asked for against counters of the units that asked.
void check_bytes(const Json& view) {
  check_halves(view);
  const auto [first_half, second_half] = half_bytes(view);
  for (const auto& [name, unit] : view["units"].items()) {
    INFO(name);
    CHECK(asked_bytes(view, "first_halves", name, "read") == first_half * of(unit, "first_halves"));
    CHECK(asked_bytes(view, "second_halves", name, "read") ==
          second_half * of(unit, "second_halves"));
  }
  if (view["config"]["machine"] == "paper") {
    const std::uint64_t splat = view["config"]["splats"] == "fp16" ? 36 : 48;
    constexpr std::uint64_t kLine = 32;
    CHECK(region_bytes(view, "spill", "write") == splat * total(view, "entries_spilled"));
    if (total(view, "splats_saturated") == 0) {
      CHECK(region_bytes(view, "spill", "read") == region_bytes(view, "spill", "write"));
    }
    CHECK(asked_bytes(view, "voxel_table", "vsu.node_memory", "read") <=
          kLine * of(view["units"]["vsu"], "node_cache_misses"));  // none where rays are sampled
    CHECK(asked_bytes(view, "voxel_table", "vsu.record_memory", "read") <=
          kLine * (counter(view, "vsu", "record_cache_misses") +
                   counter(view, "vsu", "cut_cache_misses")));
  } else {
    constexpr std::uint64_t kKey = 32, kWalkEntry = 16;
    CHECK(asked_bytes(view, "spill", "merge", "write") ==
          kKey * counter(view, "merge", "keys_spilled"));
    CHECK(asked_bytes(view, "spill", "vsu", "write") ==
          kWalkEntry * counter(view, "vsu", "queue_entries_put_aside"));
  }
}

// No unit does more than the frame has time for.
void check_bounds(const Json& view) {
  const Json& config = view["config"];
  const std::uint64_t frame = frame_cycles(view);
  const Json& hfu = config["hfu"];
  // In paper order without the filter there are no CFUs.
  const Json& datapath = view["datapath"];
  const std::uint64_t coarse_interval =
      datapath.contains("coarse")
          ? ceil_div(count(datapath["coarse"]["used"]["macs"]), count(hfu["cfu_lanes"]))
          : 1;
  const std::uint64_t fine_interval = ceil_div(count(hfu["ffu_macs"]), count(hfu["ffu_lanes"]));
  const std::uint64_t parts = parts_of(config);
  const std::uint64_t clusters = count(config["rendering"]["clusters"]) / parts;
  for (const Json& unit : view["units"]) {
    CHECK(ceil_div(of(unit, "coarse_tests"), parts * count(hfu["cfus"])) * coarse_interval <=
          frame);
    CHECK(ceil_div(of(unit, "fine_tests"), count(hfu["ffus"])) * fine_interval <=
          parts * eyes_of(config) * frame);
    CHECK(ceil_div(of(unit, "subtile_blends"), clusters) <= frame);
    if (of(unit, "inserts") > 0) {
      CHECK((of(unit, "inserts") + of(unit, "delete_mins") + of(unit, "delete_maxs")) *
                count(config["merge"]["cycles_per_operation"]) <=
            frame);
    }
    if (of(unit, "samples") > 0) {
      const Json& vsu = config["vsu"];
      CHECK(ceil_div(of(unit, "samples"), count(vsu["samples_per_cycle"])) <= frame);
      CHECK(of(unit, "cells_looked_up") <= frame);
      CHECK(of(unit, "rays") * count(datapath["sampled_ray"]["used"]["macs"]) /
                count(vsu["ray_lanes"]) <=
            frame);
    } else if (of(unit, "steps") > 0) {
      const Json& vsu = config["vsu"];
      const std::uint64_t rays = of(unit, "rays"), steps = of(unit, "steps") - rays;
      CHECK(steps * count(view["datapath"]["ray_step"]["used"]["macs"]) /
                count(vsu["step_lanes"]) <=
            frame);
      CHECK(rays * count(view["datapath"]["pixel_ray"]["used"]["macs"]) / count(vsu["ray_lanes"]) <=
            frame);
      // Each waits for its own steps.
      CHECK((steps * count(vsu["cell_step_depth_cycles"]) + rays * count(vsu["ray_depth_cycles"])) /
                count(vsu["rays_in_flight"]) <=
            frame);
    }
  }
}

// What one unit hands on the next receives.
void check_flow(const Json& view) {
  const std::uint64_t blended = counter_of_all(view, "rendering", "splats");
  const std::uint64_t late = counter_of_all(view, "rendering", "splats_saturated");
  const std::uint64_t parts = parts_of(view["config"]);
  const std::uint64_t eyes = eyes_of(view["config"]);
  const std::uint64_t groups = counter_of_all(view, "rendering", "groups") / (parts * eyes);
  std::uint64_t fine_splats = 0, fine_dropped = 0, sorted = 0, sorting_dropped = 0;
  for (const auto& [name, unit] : view["units"].items()) {
    if (unit["counters"].contains("fine_tests")) {
      fine_splats += of(unit, "splats");
      fine_dropped += of(unit, "dropped_saturated");
    }
    if (name.rfind("sorting", 0) == 0) {
      sorted += of(unit, "splats") + of(unit, "keys");
      sorting_dropped += of(unit, "splats_saturated");
    }
  }
  // A visit, or a group's end: of one HFU in exact order, of all in paper order.
  const std::uint64_t visits = counter(view, "vsu", "visits") + groups;
  const std::uint64_t tested_or_dropped = total(view, "fine_tests") + fine_dropped;
  if (view["config"]["machine"] == "paper") {
    CHECK(total(view, "shares") == count(view["config"]["hfus"]) / parts * visits);
    CHECK(total(view, "second_halves") <= total(view, "coarse_candidates"));
    CHECK(total(view, "coarse_passed") == tested_or_dropped);
    CHECK(fine_splats == sorted);
    CHECK(blended + late <= sorted - sorting_dropped);
    // A visit, or a group's end, takes a number of one sorting unit of each part.
    CHECK(counter_of_all(view, "sorting", "visits") == parts * visits);
  } else {
    CHECK(total(view, "shares") == visits);
    CHECK(total(view, "coarse_candidates") == sorted);
    CHECK(total(view, "coarse_passed") >= sorted);
    CHECK(total(view, "coarse_passed") <= eyes * sorted);
    CHECK(sorted == counter(view, "merge", "keys"));
    CHECK(counter(view, "merge", "keys") == counter(view, "merge", "released") +
                                                counter(view, "merge", "dropped_hidden") +
                                                counter(view, "merge", "dropped_saturated"));
    CHECK(counter(view, "merge", "released") <= tested_or_dropped);
    CHECK(eyes * counter(view, "merge", "released") >= tested_or_dropped);
    // What went into the heap came out at one end or the other, or was dropped with its group.
    const std::uint64_t inserts = counter(view, "merge", "inserts"),
                        deletes = counter(view, "merge", "delete_mins") +
                                  counter(view, "merge", "delete_maxs");
    CHECK(inserts <= counter(view, "merge", "keys"));
    CHECK(deletes <= inserts);
    if (counter(view, "merge", "dropped_saturated") == 0) CHECK(deletes == inserts);
    CHECK(blended + late <= fine_splats);
    CHECK(total(view, "visits") == 2 * counter(view, "vsu", "visits") + groups);
  }
}

}  // namespace

void check_halves(const Json& view) {
  const auto [first_half, second_half] = half_bytes(view);
  CHECK(count(view["scene"]["second_half_bytes"]) == second_half);
  CHECK(region_bytes(view, "first_halves", "read") == first_half * total(view, "first_halves"));
  CHECK(region_bytes(view, "second_halves", "read") == second_half * total(view, "second_halves"));
}

void check_any_machine(const Json& view) {
  INFO("view " << view["view"] << " of " << view["scene"]["name"]);
  CHECK(view["schema_version"] == 2);
  CHECK(view["image"]["equals_streaming_renderer"] == true);
  CHECK(view["frame"]["drained"] == true);
  INFO(view["ledger"]["faults"].dump(2));
  CHECK(view["ledger"]["faults"].empty());
  check_accounts(view);
  check_memory(view);
}

void check_streaming_machine(const Json& view) {
  INFO("view " << view["view"] << " of " << view["scene"]["name"]);
  if (view["config"]["machine"] == "exact") {
    const Json& config = view["config"];
    // The picture of the whole scene.
    const bool raw =
        config["storage"]["encoding"] == "raw" && left_out(view, "sh_bands_below_tolerance") == 0;
    if (config["framebuffer"] == "rgb32f" && config["rendering"]["precision"] == "fp32" &&
        config["merge"]["on_overflow"] == "spill") {
      CHECK(view["image"]["decoded_psnr_db"].is_null());
      if (raw) CHECK(view["image"]["max_abs_error"] == 0.0);
    }
  }
  check_any_machine(view);
  check_bytes(view);
  check_codebooks(view);
  check_bounds(view);
  check_flow(view);
}

void check_reference(const Json& view, const std::string& folder, const Image& reference) {
  const Image held_against =
      read_image(fmt::format("{}/view_{}/reference.exr", folder, view["view"].get<int>()));
  const Json& in_file = view["image"]["file_order"];
  CHECK(differing_pixels(held_against, reference) == in_file["pixels"]);
  CHECK(max_abs_error(held_against, reference) == in_file["max_abs_error"]);
}

}  // namespace sgs::test
