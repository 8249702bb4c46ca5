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

// What the encoding of second halves spares, beyond its being smaller. add: as in left_out().
template <class Add>
void add_encoding(const SecondHalfFormat& format, std::uint32_t gaussians,
                  const AcceleratorConfig& config, Add&& add) {
  SecondHalfFormat full{format.encoding, kMaxDegree, {}};
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    full.entries[id] = format.quantised() ? config.vq.entries(static_cast<Codebook>(id)) : 0;
  }
  SecondHalfFormat of_degree = full;
  of_degree.sh_degree = format.sh_degree;
  if (format.sh_degree == 0) of_degree.entries[static_cast<std::size_t>(Codebook::kSh)] = 0;
  const std::string degree = fmt::format("the scene has SH degree {}", format.sh_degree);
  if (format.sh_degree < kMaxDegree) {
    add("sh_bands", degree, gaussians,
        fmt::format("{} B a second half", full.bytes() - of_degree.bytes()));
  }
  if (!format.quantised()) {
    add("codebooks", "second halves are not quantised", config.sram.codebook_bytes > 0 ? 1 : 0,
        fmt::format("{} B of SRAM stay empty", config.sram.codebook_bytes));
    return;
  }
  if (format.sh_degree < kMaxDegree) {
    add("codebook_words", degree, 1,
        fmt::format("{} B of DRAM, of the load and of SRAM",
                    full.codebook_bytes() - of_degree.codebook_bytes()));
  }
  std::uint32_t fewer = 0;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    fewer += of_degree.entries[id] - format.entries[id];
  }
  add("codebook_entries", "the scene has no more distinct values", fewer,
      fmt::format("{} B of DRAM, of the load and of SRAM, {} B a second half",
                  of_degree.codebook_bytes() - format.codebook_bytes(),
                  of_degree.bytes() - format.bytes()));
  add("codebook_load", "an earlier frame left them in the buffer",
      config.codebook.preloaded ? 1 : 0, fmt::format("{} B of traffic", format.codebook_bytes()));
}

}  // namespace

Json left_out(const ViewFacts& facts, const AcceleratorConfig& config, const Json& measured) {
  Json list = Json::array();
  const auto add = [&](const char* what, const std::string& why, std::uint64_t count,
                       const std::string& saves) {
    if (count > 0)
      list.push_back({{"what", what}, {"why", why}, {"count", count}, {"saves", saves}});
  };
  const Json& units = measured["units"];
  const MemoryLayout& layout = facts.layout;
  const std::uint32_t second_bytes = layout.second_half_bytes();

  add_encoding(layout.second_half, layout.gaussian_count, config, add);
  add("invisible_gaussians", "opacity below 1/255: no view can show them",
      facts.gaussians - layout.gaussian_count,
      fmt::format("{} B of DRAM",
                  (facts.gaussians - layout.gaussian_count) * (kFirstHalfBytes + second_bytes)));
  const bool paper = config.ordering == Ordering::kPaper;
  add(paper ? "voxels_not_needed" : "chunks_not_needed",
      paper ? "no ray of any group crosses them" : "they cannot touch any group",
      (paper ? layout.voxel_count : layout.chunk_count) - facts.golden.stats.blocks_visited,
      "their Gaussians are never fetched");
  add("empty_groups", "no block of Gaussians can touch them", sum_over_units(units, "groups_empty"),
      "no visit, no blending");
  if (paper) {
    const double side = layout.voxel_frame.side_cells();
    const double cells = side * side * side;
    add("empty_cells", "only occupied cells exist in the voxel tree",
        static_cast<std::uint64_t>(cells - layout.voxel_count),
        fmt::format("a dense table would take {:.3g} B", cells * sizeof(VoxelRecord)));
    add("saturated_visits", "every pixel of the group was finished",
        sum_over_units(units, "visits_saturated"), "their Gaussians are not streamed");
  } else {
    add("saturated_groups", "every pixel was finished before the walk ended",
        sum_over_units(units, "groups_saturated"), "the rest of the tree is not walked");
    add("index_lookups", "no other key has the same depth",
        units["merge"]["keys"].get<std::uint64_t>() -
            std::min(units["merge"]["keys"].get<std::uint64_t>(),
                     units["merge"]["ties_looked_up"].get<std::uint64_t>()),
        fmt::format("{} B of DRAM traffic each", sizeof(std::uint32_t)));
  }
  add("saturated_gaussians", "the group finished while its visits were under way",
      sum_over_units(units, "dropped_saturated"), "filtering and second halves");
  add("trivial_sorts", "a visit with one splat or none", sum_over_units(units, "visits_trivial"),
      config.sorting.skip_trivial ? "a pass of the sorting network each" : "nothing: switched off");
  add("idle_activities", "never fed in this frame", units_never_busy(units),
      "their area, if every frame is like this one");
  return list;
}

}  // namespace sgs
