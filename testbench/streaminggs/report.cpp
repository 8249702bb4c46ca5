// Assembly of the report, and the terminal's table made from it.
#include "testbench/streaminggs/report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "algorithm/image/quality.h"
#include "testbench/streaminggs/datapath.h"
#include "testbench/streaminggs/left_out.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity: equal pictures report null and say so by max_abs_error 0.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json image_of(const ViewFacts& facts) {
  const StreamingStats& s = facts.golden.stats;
  return {{"psnr_db", finite(psnr_db(facts.frame, facts.reference))},
          {"ssim", ssim(facts.frame, facts.reference)},
          {"max_abs_error", max_abs_error(facts.frame, facts.reference)},
          {"decoded_psnr_db", finite(psnr_db(facts.frame, facts.decoded_reference))},
          {"encoding_psnr_db", finite(psnr_db(facts.decoded_reference, facts.reference))},
          {"equals_streaming_renderer", facts.equals_golden},
          {"missed", s.missed},
          {"misordered", s.misordered},
          {"blends", s.contributors}};
}

Json codebooks_of(const SecondHalfFormat& format) {
  Json out = Json::object();
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (format.entries[id] == 0) continue;
    const auto codebook = static_cast<Codebook>(id);
    out[kCodebookNames[id]] = {{"entries", format.entries[id]},
                               {"words", codebook_words(codebook, format.sh_degree)},
                               {"bytes", format.entries[id] * format.entry_bytes(codebook)}};
  }
  return out;
}

// Each Gaussian that contributes to the frame read once, and the pixels written once.
Json limit_of(const ViewFacts& facts, std::uint64_t moved_bytes) {
  const std::uint64_t once =
      facts.golden.stats.contributing * (kFirstHalfBytes + facts.layout.second_half_bytes()) +
      facts.layout[Region::kFrameBuffer].bytes;
  return {{"contributing_gaussians", facts.golden.stats.contributing},
          {"bytes_read_once", once},
          {"ratio", static_cast<double>(moved_bytes) / static_cast<double>(once)}};
}

}  // namespace

Json view_report(const ViewFacts& facts, const AcceleratorConfig& config) {
  const Json measured = Json::parse(facts.run.measurements_json);
  Json report;
  report["schema_version"] = 1;
  report["scene"] = {{"name", facts.scene},
                     {"gaussians", facts.gaussians},
                     {"sh_degree", facts.layout.sh_degree()},
                     {"dropped_invalid", facts.dropped_invalid},
                     {"voxel_size", facts.layout.voxel_frame.voxel_size},
                     {"voxels", facts.layout.voxel_count},
                     {"chunks", facts.layout.chunk_count},
                     {"second_half_bytes", facts.layout.second_half_bytes()},
                     {"codebooks", codebooks_of(facts.layout.second_half)},
                     {"stored_bytes", facts.layout[Region::kSpill].base}};
  report["view"] = facts.view;
  report["image"] = image_of(facts);
  for (const auto& [key, value] : measured.items()) report[key] = value;
  report["datapath"] = datapath_of(config.hfu, facts.layout.sh_degree());
  report["limit"] = limit_of(facts, measured["dram"]["bytes"].get<std::uint64_t>());
  report["left_out"] = left_out(facts, config, measured);
  report["host"] = {{"simulation_wall_s", facts.run.wall_s}};
  return report;
}

void print_table_head() {
  fmt::print("{:>4} {:>9} {:>8} {:>7} {:>12} {:>8} {:>10} {:>6} {:>9} {:>5} {:>8}\n", "view",
             "PSNR dB", "SSIM", "= model", "cycles", "fps", "DRAM MB", "x once", "binding", "busy",
             "wall s");
}

void print_table_line(const Json& r) {
  const Json& psnr = r["image"]["psnr_db"];
  fmt::print(
      "{:>4} {:>9} {:>8.5f} {:>7} {:>12} {:>8.1f} {:>10.2f} {:>6.2f} {:>9} {:>4.0f}% {:>8.2f}\n",
      r["view"].get<int>(), psnr.is_null() ? "equal" : fmt::format("{:.2f}", psnr.get<double>()),
      r["image"]["ssim"].get<double>(),
      r["image"]["equals_streaming_renderer"].get<bool>() ? "yes" : "NO",
      r["frame"]["cycles"].get<std::uint64_t>(), r["frame"]["fps"].get<double>(),
      r["dram"]["bytes"].get<double>() / 1e6, r["limit"]["ratio"].get<double>(),
      r["binding"]["unit"].get<std::string>(), 100 * r["binding"]["utilisation"].get<double>(),
      r["host"]["simulation_wall_s"].get<double>());
}

void print_details(const Json& r) {
  fmt::print("\nview {}: {}\n", r["view"].get<int>(),
             r["binding"]["explanation"].get<std::string>());
  fmt::print("  {:<14} {:>14} {:>14}\n", "DRAM region", "B asked for", "B on the bus");
  for (const auto& [region, bus_bytes] : r["dram"]["bus_bytes_by_region"].items()) {
    std::uint64_t asked = 0;
    if (r["dram"]["bytes_by_region"].contains(region)) {
      for (const auto& requester : r["dram"]["bytes_by_region"][region]) {
        for (const auto& bytes : requester) asked += bytes.get<std::uint64_t>();
      }
    }
    fmt::print("  {:<14} {:>14} {:>14}\n", region, asked, bus_bytes.get<std::uint64_t>());
  }
  print_datapath(r);
}

}  // namespace sgs
