// Processes, reports, and the checks that every frame must pass.
#include "tests/system/streaminggs_run.h"

#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>

namespace sgs::test {
namespace {

using Json = nlohmann::json;

std::string quoted(const std::string& argument) {
  std::string out = "'";
  for (const char c : argument) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::uint64_t count(const Json& value) { return value.get<std::uint64_t>(); }

void check_accounts(const Json& view) {
  const std::uint64_t frame = count(view["frame"]["cycles"]);
  for (const auto& [name, unit] : view["units"].items()) {
    INFO(name);
    CHECK(count(unit["busy_cycles"]) + count(unit["starved_cycles"]) +
              count(unit["blocked_cycles"]) ==
          frame);
    CHECK(count(unit["busy_cycles"]) <= frame);
  }
}

// Of one second half, from the configuration and the codebooks' entries.
std::uint64_t second_half_bytes(const Json& view) {
  const auto degree = view["scene"]["sh_degree"].get<std::uint64_t>();
  const std::uint64_t raw = 4 * (7 + 3 * (degree + 1) * (degree + 1));
  const std::string encoding = view["config"]["encoding"];
  if (encoding == "raw") return raw;
  if (encoding == "half") return raw / 2;
  std::uint64_t indices = 0, bits = 0;
  for (const auto& codebook : view["scene"]["codebooks"]) {
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

// Codebooks come once, decoding is for what was fetched.
void check_codebooks(const Json& view) {
  std::uint64_t bytes = 0;
  for (const auto& codebook : view["scene"]["codebooks"]) {
    bytes += 4 * count(codebook["entries"]) * count(codebook["words"]);
  }
  const bool preloaded = view["config"]["codebook"]["preloaded"];
  CHECK(region_bytes(view, "codebooks", "read") == (preloaded ? 0 : bytes));
  CHECK(total(view, "bytes_loaded") == (preloaded ? 0 : bytes));
  CHECK(count(view["sram"]["codebook_bytes"]) == bytes);
  CHECK(bytes <= count(view["config"]["sram"]["codebook_bytes"]));
  const std::string encoding = view["config"]["encoding"];
  const bool quantised = encoding == "vq" || encoding == "vq_packed";
  CHECK(view["units"].contains("codebooks.load") == quantised);
  if (!quantised) return;
  CHECK(total(view, "records_decoded") <= total(view, "second_halves"));
  CHECK(total(view, "records_decoded") >= total(view, "fine_tests"));
  if (view["config"]["rendering"]["saturation_feedback"] == false) {
    CHECK(total(view, "dropped_saturated") == 0);
    CHECK(total(view, "records_decoded") == total(view, "second_halves"));
  }
  // An HFU reads a line a cycle; the rest of the time it decodes nothing.
  std::uint64_t busy = 0;
  for (const auto& [name, unit] : view["units"].items()) {
    if (name.find(".decode") != std::string::npos) busy += count(unit["busy_cycles"]);
  }
  CHECK(busy == total(view, "lines_read") + total(view, "bank_conflict_cycles"));
}

// Bytes asked for against counters of the units that asked.
void check_bytes(const Json& view) {
  const Json& config = view["config"];
  const std::uint64_t second_half = second_half_bytes(view);
  CHECK(count(view["scene"]["second_half_bytes"]) == second_half);
  CHECK(region_bytes(view, "first_halves", "read") == 16 * total(view, "first_halves"));
  CHECK(region_bytes(view, "second_halves", "read") == second_half * total(view, "second_halves"));
  for (const auto& [name, unit] : view["units"].items()) {
    if (!unit.contains("first_halves")) continue;
    const std::string hfu = name.substr(0, name.find('.'));
    const Json& by_region = view["dram"]["bytes_by_region"];
    if (count(unit["first_halves"]) > 0) {
      CHECK(count(by_region["first_halves"][hfu]["read"]) == 16 * count(unit["first_halves"]));
    }
    if (count(unit["second_halves"]) > 0) {
      CHECK(count(by_region["second_halves"][hfu]["read"]) ==
            second_half * count(unit["second_halves"]));
    }
  }
  if (config["ordering"] == "paper") {
    constexpr std::uint64_t kSplat = 48, kLine = 64;
    CHECK(region_bytes(view, "spill", "write") == kSplat * total(view, "entries_spilled"));
    if (total(view, "splats_saturated") == 0) {
      CHECK(region_bytes(view, "spill", "read") == region_bytes(view, "spill", "write"));
    }
    CHECK(region_bytes(view, "voxel_table", "read") <=
          kLine * (total(view, "node_cache_misses") + total(view, "record_cache_misses")));
  }
  std::uint64_t sum = 0;
  for (const auto& region : view["dram"]["bytes_by_region"]) {
    for (const auto& requester : region) {
      for (const auto& bytes : requester) sum += count(bytes);
    }
  }
  CHECK(sum == count(view["dram"]["bytes"]));
  std::uint64_t on_bus = 0;
  for (const auto& bytes : view["dram"]["bus_bytes_by_region"]) on_bus += count(bytes);
  CHECK(on_bus == count(view["dram"]["bus_bytes"]));
}

// No resource does more than the frame has time for.
void check_bounds(const Json& view) {
  const Json& config = view["config"];
  const std::uint64_t frame = count(view["frame"]["cycles"]);
  const double bytes_a_cycle =
      view["dram"]["peak_gb_s"].get<double>() * 1e3 / config["clock_mhz"].get<double>();
  CHECK(static_cast<double>(count(view["dram"]["bus_bytes"])) <=
        bytes_a_cycle * static_cast<double>(frame + 1));
  const auto ceil_div = [](std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; };
  const Json& hfu = config["hfu"];
  const std::uint64_t coarse_interval = ceil_div(count(hfu["cfu_macs"]), count(hfu["cfu_lanes"]));
  const std::uint64_t fine_interval = ceil_div(count(hfu["ffu_macs"]), count(hfu["ffu_lanes"]));
  for (const auto& unit : view["units"]) {
    if (unit.contains("coarse_tests")) {
      CHECK(ceil_div(count(unit["coarse_tests"]), count(hfu["cfus"])) * coarse_interval <= frame);
      CHECK(count(unit["fine_tests"]) * fine_interval <= frame);
    }
    if (unit.contains("subtile_blends")) {
      CHECK(ceil_div(count(unit["subtile_blends"]), count(config["rendering"]["clusters"])) <=
            frame);
    }
    if (unit.contains("steps")) {
      CHECK(count(unit["steps"]) / count(config["vsu"]["steps_per_cycle"]) <= frame);
    }
  }
}

// What one unit hands on the next receives.
void check_flow(const Json& view) {
  if (view["config"]["ordering"] != "paper") return;
  std::uint64_t sent = 0, received = 0, dropped = 0;
  for (const auto& [name, unit] : view["units"].items()) {
    if (unit.contains("fine_tests")) sent += count(unit["splats"]);
    if (name.rfind("sorting", 0) == 0) {
      received += count(unit["splats"]);
      dropped += count(unit["splats_saturated"]);
    }
  }
  CHECK(sent == received);
  const Json& blend = view["units"]["rendering.blend"];
  CHECK(count(blend["splats"]) + count(blend["splats_saturated"]) <= received - dropped);
  // A visit, or a group's end, takes a number of one sorting unit.
  CHECK(total(view, "visits") ==
        2 * count(view["units"]["vsu.traverse"]["visits"]) + count(blend["groups"]));
}

void check_view(const Json& view) {
  INFO("view " << view["view"] << " of " << view["scene"]["name"]);
  CHECK(view["image"]["equals_streaming_renderer"] == true);
  if (view["config"]["ordering"] == "exact") {
    CHECK(view["image"]["decoded_psnr_db"].is_null());
    if (view["config"]["encoding"] == "raw") CHECK(view["image"]["max_abs_error"] == 0.0);
  }
  CHECK(view["frame"]["drained"] == true);
  check_accounts(view);
  check_bytes(view);
  check_codebooks(view);
  check_bounds(view);
  check_flow(view);
}

}  // namespace

Outcome run_streaminggs(const std::vector<std::string>& arguments) {
  const ScratchFolder scratch;
  std::string command = quoted(SGS_STREAMINGGS);
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  command += " >" + quoted(scratch.path("out")) + " 2>" + quoted(scratch.path("err"));
  const int status = std::system(command.c_str());
  constexpr int kKilled = 128;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : kKilled + WTERMSIG(status),
          bytes_of(scratch.path("out")), bytes_of(scratch.path("err"))};
}

Simulation::Simulation(const std::vector<std::string>& arguments) {
  std::vector<std::string> all = {"simulate"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  all.insert(all.end(), {"--set", "framebuffer=rgb32f", "--out", out_.path("out")});
  const Outcome outcome = run_streaminggs(all);
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.status == 0);
  CHECK(outcome.err.find("Warning") == std::string::npos);  // a SystemC warning is a failure
  const Json report = Json::parse(bytes_of(out_.path("out/report.json")));
  for (Json view : report["views"]) {
    view["config"] = report["config"];
    views_.push_back(std::move(view));
  }
  REQUIRE_FALSE(views_.empty());
}

std::string Simulation::frame(std::size_t view) const {
  return bytes_of(
      out_.path("out/view_" + std::to_string(count(views_[view]["view"])) + "/frame.exr"));
}

void Simulation::check() const {
  for (const Json& view : views_) check_view(view);
}

std::uint64_t total(const Json& view, const std::string& counter) {
  std::uint64_t sum = 0;
  for (const auto& unit : view["units"]) {
    if (unit.contains(counter)) sum += count(unit[counter]);
  }
  return sum;
}

std::uint64_t region_bytes(const Json& view, const std::string& region,
                           const std::string& direction) {
  const Json& regions = view["dram"]["bytes_by_region"];
  std::uint64_t sum = 0;
  if (!regions.contains(region)) return 0;
  for (const auto& requester : regions[region]) {
    if (requester.contains(direction)) sum += count(requester[direction]);
  }
  return sum;
}

}  // namespace sgs::test
