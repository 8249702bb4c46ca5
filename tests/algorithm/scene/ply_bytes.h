// PLY files put together byte by byte, independently of the writer under test.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace sgs::test {

struct PlyColumn {
  std::string name;
  std::string type;  // as in the header: float, double, uchar, ...
};

struct PlyTable {
  std::string format = "binary_little_endian";
  std::string line_end = "\n";
  std::vector<PlyColumn> columns;
  std::vector<std::vector<double>> rows;  // [vertex][column]
  // Lines and bytes of other elements; the bytes must suit the format.
  std::string header_before, header_after, body_before, body_after;
};

// The columns of the original's files, all float: x y z nx ny nz f_dc f_rest opacity scale rot.
std::vector<PlyColumn> inria_columns(int rest_count);

// Rows for inria_columns: 1000 * vertex + column, but for the scales, which are logarithms:
// 10, 11, 12 - 1000 * vertex.
std::vector<std::vector<double>> counting_rows(std::size_t vertices, std::size_t columns);

// Both together.
PlyTable counting_table(std::size_t vertices, int rest_count = 0);

// One value as text or in the byte order of `format`.
std::string encoded(const std::string& format, const std::string& type, double value);

std::string header_of(const PlyTable& table);
std::string bytes_of(const PlyTable& table);

}  // namespace sgs::test
