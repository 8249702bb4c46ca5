// Encoding and decoding of projected Gaussians and of lists' entries.
#include "algorithm/memory/tile_records.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

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

std::int8_t exponent_of(float power_of_two) {
  return static_cast<std::int8_t>(std::ilogb(power_of_two));
}

constexpr std::size_t kCentreBytes = 8, kUnitsAt = 22;

void encode_halves(const Splat& s, std::byte* out) {
  const SquareConic<float> in_px = square_conic(s.conic_a, s.conic_b, s.conic_c);
  const AxisUnits units = axis_units(in_px);
  const SquareConic<float> conic = in_units(in_px, units);
  const float rest[7] = {conic.a, conic.lean, conic.rest, s.opacity, s.rgb.x, s.rgb.y, s.rgb.z};
  for (std::size_t k = 0; k < std::size(rest); ++k) {
    const std::uint16_t bits = nearest_half(rest[k]);
    std::memcpy(out + kCentreBytes + k * sizeof bits, &bits, sizeof bits);
  }
  const std::int8_t exponents[2] = {exponent_of(units.x), exponent_of(units.y)};
  std::memcpy(out + kUnitsAt, exponents, sizeof exponents);
}

SquareSplat decode_halves(const std::byte* bytes) {
  float centre[2], rest[7];
  std::memcpy(centre, bytes, sizeof centre);
  for (std::size_t k = 0; k < std::size(rest); ++k) {
    std::uint16_t bits;
    std::memcpy(&bits, bytes + kCentreBytes + k * sizeof bits, sizeof bits);
    rest[k] = float_of(bits);
  }
  std::int8_t exponents[2];
  std::memcpy(exponents, bytes + kUnitsAt, sizeof exponents);
  const AxisUnits units = {std::ldexp(1.0F, exponents[0]), std::ldexp(1.0F, exponents[1])};
  SquareSplat s{};
  s.x = centre[0];
  s.y = centre[1];
  s.conic = in_px(SquareConic<float>{rest[0], rest[1], rest[2]}, units);
  s.opacity = rest[3];
  s.rgb = {rest[4], rest[5], rest[6]};
  return s;
}

// The terms come back from the completed square.
Splat with_terms(const SquareSplat& square) {
  const ConicTerms<float> conic = conic_terms(square.conic);
  Splat s{};
  s.x = square.x;
  s.y = square.y;
  s.conic_a = conic.a;
  s.conic_b = conic.b;
  s.conic_c = conic.c;
  s.opacity = square.opacity;
  s.rgb = square.rgb;
  return s;
}

}  // namespace

void encode_projected(NumberFormat format, const Splat& s, std::byte* out) {
  const float centre[2] = {s.x, s.y};
  std::memcpy(out, centre, sizeof centre);
  if (format == NumberFormat::kHalf) {
    encode_halves(s, out);
    return;
  }
  const float rest[7] = {s.conic_a, s.conic_b, s.conic_c, s.opacity, s.rgb.x, s.rgb.y, s.rgb.z};
  std::memcpy(out + kCentreBytes, rest, sizeof rest);
}

Splat decode_projected(NumberFormat format, const std::byte* bytes) {
  if (format == NumberFormat::kHalf) return with_terms(decode_halves(bytes));
  float centre[2], rest[7];
  std::memcpy(centre, bytes, sizeof centre);
  std::memcpy(rest, bytes + kCentreBytes, sizeof rest);
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

SquareSplat decode_square(NumberFormat format, const std::byte* bytes) {
  if (format == NumberFormat::kHalf) return decode_halves(bytes);
  return square_splat(decode_projected(format, bytes));
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
