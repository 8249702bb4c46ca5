// The header of a PLY file: format, elements, properties.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "algorithm/input_file.h"

namespace sgs {

enum class PlyFormat { kAscii, kBinaryLittleEndian, kBinaryBigEndian };

enum class PlyScalar { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

std::size_t size_bytes(PlyScalar type);

struct PlyProperty {
  std::string name;
  PlyScalar type = PlyScalar::kFloat32;
  bool is_list = false;
  PlyScalar list_count_type = PlyScalar::kUint8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  bool has_lists() const;
  // Bytes of one binary record; of a list only its count, so a lower bound where there are lists.
  std::uint64_t record_bytes() const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  std::uint64_t body_offset_bytes = 0;  // of the first byte after end_header
  std::uint64_t line_count = 0;         // lines of the header, end_header included
};

// Reads and checks the header of `file`; lines may end in LF or CR LF. Throws InputError that names
// the line when it is not a PLY header, ends early, repeats a property or promises more records
// than the rest of the file can hold.
PlyHeader read_ply_header(const InputFile& file);

}  // namespace sgs
