// Savings, each with its count and what it is worth.
#include "testbench/streaminggs/left_out.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMaxDegree = 3;

std::uint64_t sum_over_units(const Json& units, const char* key) {
  std::uint64_t sum = 0;
  for (const auto& unit : units) {
    if (unit.contains(key)) sum += unit[key].get<std::uint64_t>();
  }
  return sum;
}

std::uint64_t units_never_busy(const Json& units) {
  std::uint64_t count = 0;
  for (const auto& unit : units) count += unit["busy_cycles"] == 0 ? 1 : 0;
  return count;
}

}  // namespace

Json left_out(const ViewFacts& facts, const AcceleratorConfig& config, const Json& measured) {
  Json list = Json::array();
  const auto add = [&](const char* what, const std::string& why, std::uint64_t count,
                       const std::string& saves) {
    if (count > 0) list.push_back({{"what", what}, {"why", why}, {"count", count}, {"saves", saves}});
  };
  const Json& units = measured["units"];
  const MemoryLayout& layout = facts.layout;
  const std::uint32_t second_bytes = layout.second_half_bytes();

  add("sh_bands", fmt::format("the scene has SH degree {}", layout.sh_degree),
      layout.sh_degree < kMaxDegree ? layout.gaussian_count : 0,
      fmt::format("{} B a second half", raw_second_half_bytes(kMaxDegree) - second_bytes));
  add("codebooks", "second halves are raw", config.sram.codebook_bytes > 0 ? 1 : 0,
      fmt::format("{} B of SRAM stay empty", config.sram.codebook_bytes));
  add("invisible_gaussians", "opacity below 1/255: no view can show them",
      facts.gaussians - layout.gaussian_count,
      fmt::format("{} B of DRAM", (facts.gaussians - layout.gaussian_count) *
                                      (kFirstHalfBytes + second_bytes)));
  add("voxels_not_needed", "no ray of any group crosses them",
      layout.voxel_count - facts.golden.stats.blocks_visited, "their Gaussians are never fetched");
  const double side = layout.voxel_frame.side_cells();
  const double cells = side * side * side;
  add("empty_cells", "only occupied cells exist in the voxel tree",
      static_cast<std::uint64_t>(cells - layout.voxel_count),
      fmt::format("a dense table would take {:.3g} B", cells * sizeof(VoxelRecord)));
  const Json& vsu = units["vsu.traverse"];
  add("empty_groups", "no occupied voxel on any ray", vsu["groups_empty"].get<std::uint64_t>(),
      "no visit, no blending");
  add("saturated_visits", "every pixel of the group was finished",
      vsu["visits_saturated"].get<std::uint64_t>(), "their Gaussians are not streamed");
  add("saturated_gaussians", "the group finished while its visits were under way",
      sum_over_units(units, "dropped_saturated"), "filtering and second halves");
  add("trivial_sorts", "a visit with one splat or none", sum_over_units(units, "visits_trivial"),
      config.sorting.skip_trivial ? "a pass of the sorting network each" : "nothing: switched off");
  add("idle_activities", "never fed in this frame", units_never_busy(units),
      "their area, if every frame is like this one");
  return list;
}

}  // namespace sgs
