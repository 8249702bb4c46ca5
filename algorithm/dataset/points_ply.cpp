// Both bodies of the points' PLY file (layout.h).
#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "algorithm/dataset/layout.h"
#include "algorithm/dataset/text_fields.h"
#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/scene/ply_header.h"

namespace sgs {
namespace {

constexpr std::array<const char*, 6> kNames = {"x", "y", "z", "red", "green", "blue"};
constexpr std::size_t kFirstColour = 3;

struct Column {
  std::size_t property = 0;
  std::uint64_t offset_bytes = 0;
};
using Columns = std::array<Column, kNames.size()>;
using Values = std::array<double, kNames.size()>;

Columns columns_of(const std::string& path, const PlyHeader& header) {
  if (header.elements.empty() || header.elements[0].name != "vertex") {
    throw InputError(fmt::format("{}: got the element {} first, expected vertex", path,
                                 header.elements.empty() ? "none" : header.elements[0].name));
  }
  const PlyElement& vertex = header.elements[0];
  if (vertex.has_lists()) {
    throw InputError(path + ": element vertex: got a list, expected numbers alone");
  }
  Columns columns;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    Column& column = columns[i];
    while (column.property < vertex.properties.size() &&
           vertex.properties[column.property].name != kNames[i]) {
      column.offset_bytes += size_bytes(vertex.properties[column.property++].type);
    }
    const bool there = column.property < vertex.properties.size();
    if (!there ||
        (i >= kFirstColour && vertex.properties[column.property].type != PlyScalar::kUint8)) {
      throw InputError(fmt::format("{}: element vertex: {}: got {}, expected a property{}", path,
                                   kNames[i], there ? "another type" : "nothing",
                                   i >= kFirstColour ? " of uchar" : ""));
    }
  }
  return columns;
}

SfmPoint point_of(const Values& values, const std::string& where) {
  glm::u8vec3 colour;
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = values[kFirstColour + i];
    if (!(value >= 0 && value <= 255)) {
      throw InputError(
          fmt::format("{}: {}: got {}, expected 0 to 255", where, kNames[kFirstColour + i], value));
    }
    colour[static_cast<int>(i)] = static_cast<std::uint8_t>(value);
  }
  return sfm_point({values[0], values[1], values[2]}, colour, where);
}

}  // namespace

std::vector<SfmPoint> read_points_ply(const std::string& path) {
  const InputFile file(path);
  const PlyHeader header = read_ply_header(file);
  const Columns columns = columns_of(path, header);
  const PlyElement& vertex = header.elements[0];
  const std::string body = file.text_from(header.body_offset_bytes, file.size_bytes());
  const bool in_text = header.format == PlyFormat::kAscii;
  TextFields fields(in_text ? std::string_view(body) : std::string_view(), path);
  std::vector<double> record(vertex.properties.size());
  std::vector<SfmPoint> points;
  for (std::uint64_t i = 0; i < vertex.count; ++i) {
    Values values;
    if (in_text) {
      for (std::size_t at = 0; at < record.size(); ++at) {
        record[at] = fields.number(vertex.properties[at].name.c_str());
      }
      for (std::size_t at = 0; at < values.size(); ++at) values[at] = record[columns[at].property];
    } else {
      // The header's count fits the file.
      const char* bytes = body.data() + i * vertex.record_bytes();
      for (std::size_t at = 0; at < values.size(); ++at) {
        const Column& column = columns[at];
        values[at] = load_ply_scalar<double>(header.format, bytes + column.offset_bytes,
                                             vertex.properties[column.property].type);
      }
    }
    points.push_back(point_of(values, fmt::format("{}: vertex {}", path, i)));
  }
  return points;
}

std::optional<std::string> points_file_in(const std::string& folder) {
  for (const char* name : {"points3D.ply", "points3d.ply"}) {
    const std::filesystem::path path = std::filesystem::path(folder) / name;
    std::error_code unknown;
    if (std::filesystem::exists(path, unknown)) return path.string();
  }
  return {};
}

}  // namespace sgs
