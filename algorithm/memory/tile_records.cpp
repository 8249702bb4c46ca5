// Encoding and decoding of projected Gaussians and of lists' entries.
#include "algorithm/memory/tile_records.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace sgs {
namespace {

constexpr float kGreatestHalf = 65504;

std::uint16_t nearest_half(float value) {
  return Imath::half(std::clamp(value, -kGreatestHalf, kGreatestHalf)).bits();
}

float float_of(std::uint16_t bits) {
  Imath::half value;
  value.setBits(bits);
  return value;
}

}  // namespace

void encode_projected(NumberFormat format, const Splat& s, std::byte* out) {
  const float rest[7] = {s.conic_a, s.conic_b, s.conic_c, s.opacity, s.rgb.x, s.rgb.y, s.rgb.z};
  const float centre[2] = {s.x, s.y};
  std::memcpy(out, centre, sizeof centre);
  if (format == NumberFormat::kSingle) {
    std::memcpy(out + 8, rest, sizeof rest);
    return;
  }
  int exponent = 0;
  std::frexp(std::max(s.conic_a, s.conic_c), &exponent);
  exponent = std::clamp(exponent, -128, 127);
  for (int k = 0; k < 7; ++k) {
    const std::uint16_t bits = nearest_half(k < 3 ? std::ldexp(rest[k], -exponent) : rest[k]);
    std::memcpy(out + 8 + 2 * k, &bits, sizeof bits);
  }
  out[22] = static_cast<std::byte>(exponent + 128);
  out[23] = std::byte{0};
}

Splat decode_projected(NumberFormat format, const std::byte* bytes) {
  float centre[2], rest[7];
  std::memcpy(centre, bytes, sizeof centre);
  if (format == NumberFormat::kSingle) {
    std::memcpy(rest, bytes + 8, sizeof rest);
  } else {
    const int exponent = std::to_integer<int>(bytes[22]) - 128;
    for (int k = 0; k < 7; ++k) {
      std::uint16_t bits;
      std::memcpy(&bits, bytes + 8 + 2 * k, sizeof bits);
      rest[k] = k < 3 ? std::ldexp(float_of(bits), exponent) : float_of(bits);
    }
  }
  Splat s{};
  s.x = centre[0];
  s.y = centre[1];
  s.conic_a = rest[0];
  s.conic_b = rest[1];
  s.conic_c = rest[2];
  s.opacity = rest[3];
  s.rgb = {rest[4], rest[5], rest[6]};
  return s;
}

std::uint32_t depth_key(NumberFormat format, float depth) {
  if (format == NumberFormat::kHalf) return nearest_half(depth);
  return __builtin_bit_cast(std::uint32_t, depth);
}

void encode_entry(const EntryFormat& format, const TileEntry& entry, std::byte* out) {
  std::memcpy(out, &entry.key, format.key_bytes());
  out += format.key_bytes();
  const bool wide = format.subtiles_across > 2;
  const std::uint32_t word = wide ? entry.record : entry.record | entry.bitmap << 28;
  std::memcpy(out, &word, sizeof word);
  if (wide) std::memcpy(out + sizeof word, &entry.bitmap, 2);
}

TileEntry decode_entry(const EntryFormat& format, const std::byte* bytes) {
  TileEntry entry;
  std::memcpy(&entry.key, bytes, format.key_bytes());
  bytes += format.key_bytes();
  std::uint32_t word;
  std::memcpy(&word, bytes, sizeof word);
  if (format.subtiles_across > 2) {
    entry.record = word;
    std::memcpy(&entry.bitmap, bytes + sizeof word, 2);
  } else {
    entry.record = word & 0x0fffffffU;
    entry.bitmap = word >> 28;
  }
  return entry;
}

}  // namespace sgs
