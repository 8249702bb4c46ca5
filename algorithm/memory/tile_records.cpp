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
  const float centre[2] = {s.x, s.y};
  std::memcpy(out, centre, sizeof centre);
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

// Opacities are the floats from 2^-8, which is below what can be seen, to 1: counted from there,
// from 1 on.
constexpr std::uint32_t kLeastOpacityBits = 0x3b800000, kOpacityInRecord = 5;

std::uint32_t number_of_opacity(float opacity) {
  const auto bits = __builtin_bit_cast(std::uint32_t, opacity);
  return opacity < 0x1p-8F ? 0 : bits - kLeastOpacityBits + 1;
}
float opacity_of(std::uint32_t number) {
  return number == 0 ? 0 : __builtin_bit_cast(float, number + kLeastOpacityBits - 1);
}

// A, C, R, G, B among the record's floats: their signs, from the lowest bit of the opacity on.
constexpr std::size_t kUnsigned[kOpacityInRecord] = {2, 4, 5, 6, 7};
constexpr std::uint32_t kSign = 0x80000000;

void encode_singles(const Splat& s, std::byte* out) {
  const float values[8] = {s.x, s.y, s.conic_a, s.conic_b, s.conic_c, s.rgb.x, s.rgb.y, s.rgb.z};
  std::uint32_t words[8];
  static_assert(sizeof words == record_bytes(NumberFormat::kSingle));
  std::memcpy(words, values, sizeof words);
  std::uint32_t opacity = number_of_opacity(s.opacity);
  for (const std::size_t at : kUnsigned) {
    words[at] = (words[at] & ~kSign) | ((opacity & 1U) != 0 ? kSign : 0);
    opacity >>= 1;
  }
  std::memcpy(out, words, sizeof words);
}

Splat decode_singles(const std::byte* bytes, std::uint32_t listed_opacity) {
  std::uint32_t words[8];
  std::memcpy(words, bytes, sizeof words);
  std::uint32_t opacity = listed_opacity << kOpacityInRecord;
  for (std::size_t k = 0; k < kOpacityInRecord; ++k) {
    opacity |= words[kUnsigned[k]] >> 31 << k;
    words[kUnsigned[k]] &= ~kSign;
  }
  float values[8];
  std::memcpy(values, words, sizeof values);
  Splat s{};
  s.x = values[0];
  s.y = values[1];
  s.conic_a = values[2];
  s.conic_b = values[3];
  s.conic_c = values[4];
  s.opacity = opacity_of(opacity);
  s.rgb = {values[5], values[6], values[7]};
  return s;
}

}  // namespace

void encode_projected(NumberFormat format, const Splat& s, std::byte* out) {
  if (format == NumberFormat::kHalf) {
    encode_halves(s, out);
  } else {
    encode_singles(s, out);
  }
}

std::uint32_t listed_opacity(NumberFormat format, float opacity) {
  return format == NumberFormat::kHalf ? 0 : number_of_opacity(opacity) >> kOpacityInRecord;
}

Splat decode_projected(NumberFormat format, const std::byte* bytes, std::uint32_t listed_opacity) {
  if (format == NumberFormat::kHalf) return with_terms(decode_halves(bytes));
  return decode_singles(bytes, listed_opacity);
}

SquareSplat decode_square(NumberFormat format, const std::byte* bytes,
                          std::uint32_t listed_opacity) {
  if (format == NumberFormat::kHalf) return decode_halves(bytes);
  return square_splat(decode_singles(bytes, listed_opacity));
}

std::uint32_t depth_key(NumberFormat format, float depth) {
  if (format == NumberFormat::kHalf) return nearest_half(depth);
  return __builtin_bit_cast(std::uint32_t, depth);
}

void encode_entry(const EntryFormat& format, const TileEntry& entry, std::byte* out) {
  const std::uint32_t number_bits = format.number_bits();
  const std::uint64_t record = entry.record, number = record & ((1ULL << number_bits) - 1);
  const auto key =
      static_cast<std::uint32_t>(entry.key | record >> number_bits << (8 * format.key_bytes() - 1));
  std::memcpy(out, &key, format.key_bytes());
  out += format.key_bytes();
  const std::uint64_t bitmap = format.wide() ? 0 : entry.bitmap, opacity = entry.opacity;
  const std::uint64_t word =
      number | bitmap << number_bits | opacity << (number_bits + format.bitmap_bits());
  std::memcpy(out, &word, format.word_bytes());
  if (format.wide()) std::memcpy(out + format.word_bytes(), &entry.bitmap, 2);
}

TileEntry decode_entry(const EntryFormat& format, const std::byte* bytes) {
  const std::uint32_t number_bits = format.number_bits(), key_bits = 8 * format.key_bytes() - 1;
  TileEntry entry;
  std::memcpy(&entry.key, bytes, format.key_bytes());
  bytes += format.key_bytes();
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, format.word_bytes());
  const std::uint64_t highest = entry.key >> key_bits;
  entry.key &= (1U << key_bits) - 1;
  const auto take = [&](std::uint32_t bits) {
    const std::uint64_t low = word & ((1ULL << bits) - 1);
    word >>= bits;
    return static_cast<std::uint32_t>(low);
  };
  entry.record = static_cast<std::uint32_t>(take(number_bits) | highest << number_bits);
  entry.bitmap = take(format.bitmap_bits());
  entry.opacity = take(format.opacity_bits());
  if (format.wide()) std::memcpy(&entry.bitmap, bytes + format.word_bytes(), 2);
  return entry;
}

}  // namespace sgs
