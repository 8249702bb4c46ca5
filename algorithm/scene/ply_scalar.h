// Numbers in the body of a binary PLY file.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "algorithm/scene/ply_header.h"

namespace sgs {

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
