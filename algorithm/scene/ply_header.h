// The header of a PLY file (Turk 1994: format, elements, properties), the kind of scene that it
// tells, and the scalars of a binary body.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "algorithm/files/input_file.h"

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

  bool has(std::string_view property) const;
  bool has_lists() const;
  // Bytes of one binary record; of a list only its count, so a lower bound where there are lists.
  std::uint64_t record_bytes() const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;    // without the word itself
  std::uint64_t body_offset_bytes = 0;  // first byte after end_header
  std::uint64_t line_count = 0;         // lines of the header, end_header included

  const PlyElement* element(std::string_view name) const;  // null where there is none
};

// Reads and checks the header of `file`; lines may end in LF or CR LF. Throws InputError that names
// the line when it is not a PLY header, ends early, repeats a property or promises more records
// than the rest of the file can hold.
PlyHeader read_ply_header(const InputFile& file);

// Some files look like trained scenes but are drawn by rules of their own.

// True for the packed form of SuperSplat and splat-transform.
bool is_compressed_ply(const PlyHeader& header);

// Of a header with an element vertex. Throws InputError where the file is a point cloud, or where
// its pictures are not those of plain 3D Gaussians: 2DGS, Scaffold-GS, spherical Gaussians, other
// kernels, Gaussians that move.
void refuse_other_kinds(const std::string& path, const PlyHeader& header);

// read: of each element that is read its properties. A sentence on what is skipped, on a property
// that changes others, and on a comment that asks for another rasteriser.
std::vector<std::string> notes_on_ply(const PlyHeader& header,
                                      const std::map<std::string, std::set<std::string>>& read);

// Of a scene trained with the 2D filter of Mip-Splatting (Yu et al. 2024), which widens by a
// variance of 0.1 px^2 and dims as much; the original widens by 0.3 px^2 and dims nothing.
constexpr const char* kAntialiasedNote =
    "it was trained for an anti-aliased rasteriser with a 2D Mip filter; the original one, used "
    "here, draws splats below a pixel wider and brighter";

// Numbers in the body of a binary PLY file.

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "values are loaded in this byte order");

namespace ply_detail {

template <typename T>
T load_in_host_order(const char* bytes, PlyScalar type) {
  const auto load = [bytes](auto value) {
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<T>(value);
  };
  switch (type) {
    case PlyScalar::kInt8:
      return load(std::int8_t{});
    case PlyScalar::kUint8:
      return load(std::uint8_t{});
    case PlyScalar::kInt16:
      return load(std::int16_t{});
    case PlyScalar::kUint16:
      return load(std::uint16_t{});
    case PlyScalar::kInt32:
      return load(std::int32_t{});
    case PlyScalar::kUint32:
      return load(std::uint32_t{});
    case PlyScalar::kFloat32:
      return load(float{});
    case PlyScalar::kFloat64:
      break;
  }
  return load(double{});
}

}  // namespace ply_detail

// The scalar at `bytes` of a binary body, converted to T.
template <typename T>
T load_ply_scalar(PlyFormat format, const char* bytes, PlyScalar type) {
  std::array<char, 8> ordered{};
  const std::size_t size = size_bytes(type);
  std::copy_n(bytes, size, ordered.begin());
  if (format == PlyFormat::kBinaryBigEndian) std::reverse(ordered.begin(), ordered.begin() + size);
  return ply_detail::load_in_host_order<T>(ordered.data(), type);
}

}  // namespace sgs
