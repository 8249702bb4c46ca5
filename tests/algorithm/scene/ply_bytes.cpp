// Encoding for ply_bytes.h.
#include "tests/algorithm/scene/ply_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace sgs::test {
namespace {

template <typename T>
std::string raw(double value) {
  const T typed = static_cast<T>(value);
  std::string bytes(sizeof typed, '\0');
  std::memcpy(bytes.data(), &typed, sizeof typed);
  return bytes;
}

std::string little_endian(const std::string& type, double value) {
  if (type == "char" || type == "int8") return raw<std::int8_t>(value);
  if (type == "uchar" || type == "uint8") return raw<std::uint8_t>(value);
  if (type == "short" || type == "int16") return raw<std::int16_t>(value);
  if (type == "ushort" || type == "uint16") return raw<std::uint16_t>(value);
  if (type == "int" || type == "int32") return raw<std::int32_t>(value);
  if (type == "uint" || type == "uint32") return raw<std::uint32_t>(value);
  if (type == "float" || type == "float32") return raw<float>(value);
  if (type == "double" || type == "float64") return raw<double>(value);
  throw std::logic_error("no PLY type " + type);
}

}  // namespace

std::vector<PlyColumn> inria_columns(int rest_count) {
  std::vector<PlyColumn> columns;
  const auto add = [&columns](const std::string& name) { columns.push_back({name, "float"}); };
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) add(name);
  for (int i = 0; i < 3; ++i) add(fmt::format("f_dc_{}", i));
  for (int i = 0; i < rest_count; ++i) add(fmt::format("f_rest_{}", i));
  add("opacity");
  for (int i = 0; i < 3; ++i) add(fmt::format("scale_{}", i));
  for (int i = 0; i < 4; ++i) add(fmt::format("rot_{}", i));
  return columns;
}

std::vector<std::vector<double>> counting_rows(std::size_t vertices, std::size_t columns) {
  std::vector<std::vector<double>> rows(vertices, std::vector<double>(columns));
  for (std::size_t v = 0; v < vertices; ++v) {
    const double base = 1000.0 * static_cast<double>(v);
    for (std::size_t c = 0; c < columns; ++c) rows[v][c] = base + static_cast<double>(c);
    for (std::size_t k = 0; k < 3; ++k)
      rows[v][columns - 7 + k] = 10.0 + static_cast<double>(k) - base;
  }
  return rows;
}

PlyTable counting_table(std::size_t vertices, int rest_count) {
  PlyTable table;
  table.columns = inria_columns(rest_count);
  table.rows = counting_rows(vertices, table.columns.size());
  return table;
}

std::string encoded(const std::string& format, const std::string& type, double value) {
  if (format == "ascii") return fmt::format("{} ", value);
  std::string bytes = little_endian(type, value);
  if (format == "binary_big_endian") std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::string header_of(const PlyTable& table) {
  std::string header = fmt::format("ply\nformat {} 1.0\n{}element vertex {}\n", table.format,
                                   table.header_before, table.rows.size());
  for (const PlyColumn& column : table.columns) {
    header += fmt::format("property {} {}\n", column.type, column.name);
  }
  header += table.header_after + "end_header\n";
  std::string out;
  for (const char c : header) out += c == '\n' ? table.line_end : std::string(1, c);
  return out;
}

std::string bytes_of(const PlyTable& table) {
  std::string bytes = header_of(table) + table.body_before;
  for (const std::vector<double>& row : table.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      bytes += encoded(table.format, table.columns[c].type, row[c]);
    }
    if (table.format == "ascii") bytes += table.line_end;
  }
  return bytes + table.body_after;
}

}  // namespace sgs::test
