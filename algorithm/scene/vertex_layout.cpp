// The search of vertex_layout.h.
#include "algorithm/scene/vertex_layout.h"

#include <fmt/format.h>

#include <array>
#include <map>

#include "algorithm/input_error.h"

namespace sgs {
namespace {

constexpr std::array<const char*, kRestSlot> kNames = {
    "x",       "y",       "z",       "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
    "scale_0", "scale_1", "scale_2", "rot_0",  "rot_1",  "rot_2",  "rot_3"};

// SH degree of a file with `rest` coefficients beside f_dc, or -1.
int degree_of_rest_count(std::size_t rest) {
  constexpr std::array<std::size_t, 4> kRestCounts = {0, 9, 24, 45};
  for (int degree = 0; degree < 4; ++degree) {
    if (kRestCounts[degree] == rest) return degree;
  }
  return -1;
}

}  // namespace

std::string slot_name(int slot) {
  if (slot < kRestSlot) return kNames[slot];
  return fmt::format("f_rest_{}", slot - kRestSlot);
}

VertexLayout layout_of_vertex(const std::string& path, const PlyElement& vertex) {
  std::map<std::string, VertexLayout::Column> by_name;
  std::uint64_t offset_bytes = 0;
  std::size_t rest_count = 0;
  for (std::size_t i = 0; i < vertex.properties.size(); ++i) {
    const PlyProperty& property = vertex.properties[i];
    if (property.is_list) {
      throw InputError(
          fmt::format("{}: element vertex, property {}: got a list, expected scalars only", path,
                      property.name));
    }
    by_name[property.name] = {i, static_cast<std::uint32_t>(offset_bytes), property.type};
    offset_bytes += size_bytes(property.type);
    if (property.name.rfind("f_rest_", 0) == 0) ++rest_count;
  }

  VertexLayout layout;
  layout.record_bytes = offset_bytes;
  layout.sh_degree = degree_of_rest_count(rest_count);
  if (layout.sh_degree < 0) {
    throw InputError(
        fmt::format("{}: element vertex: got {} properties f_rest_*, expected 0, 9, 24 or 45 (SH "
                    "degree 0 to 3)",
                    path, rest_count));
  }
  for (int slot = 0; slot < kRestSlot + static_cast<int>(rest_count); ++slot) {
    const auto found = by_name.find(slot_name(slot));
    if (found == by_name.end()) {
      throw InputError(
          fmt::format("{}: element vertex: got no property {}, expected x y z f_dc_0..2 opacity "
                      "scale_0..2 rot_0..3",
                      path, slot_name(slot)));
    }
    layout.columns.push_back(found->second);
  }
  return layout;
}

}  // namespace sgs
