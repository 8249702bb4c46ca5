// Encoding and decoding of splats.
#include "algorithm/memory/splat_record.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "algorithm/memory/tile_records.h"

namespace sgs {
namespace {

constexpr std::uint32_t kHalvesBytes = record_bytes(NumberFormat::kHalf);
static_assert(splat_entry_bytes(NumberFormat::kHalf) == kHalvesBytes + 12);

void write_singles(const Splat& s, std::byte* out) {
  const float words[10] = {s.x,       s.y,     s.conic_a, s.conic_b, s.conic_c,
                           s.opacity, s.depth, s.rgb.x,   s.rgb.y,   s.rgb.z};
  std::memcpy(out, words, sizeof words);
  std::memcpy(out + sizeof words, &s.index, sizeof s.index);
}

Splat read_singles(const std::byte* bytes) {
  float words[10];
  std::memcpy(words, bytes, sizeof words);
  Splat s{};
  s.x = words[0];
  s.y = words[1];
  s.conic_a = words[2];
  s.conic_b = words[3];
  s.conic_c = words[4];
  s.opacity = words[5];
  s.depth = words[6];
  s.rgb = {words[7], words[8], words[9]};
  std::memcpy(&s.index, bytes + sizeof words, sizeof s.index);
  return s;
}

void write_halves(const Splat& s, std::byte* out) {
  encode_projected(NumberFormat::kHalf, s, out);
  std::memcpy(out + kHalvesBytes, &s.depth, sizeof s.depth);
  std::memcpy(out + kHalvesBytes + sizeof s.depth, &s.index, sizeof s.index);
}

Splat read_halves(const std::byte* bytes) {
  Splat s = decode_projected(NumberFormat::kHalf, bytes, 0);
  std::memcpy(&s.depth, bytes + kHalvesBytes, sizeof s.depth);
  std::memcpy(&s.index, bytes + kHalvesBytes + sizeof s.depth, sizeof s.index);
  return s;
}

// The last bytes of an entry.
constexpr std::uint32_t kFootprintBytes = 4;

}  // namespace

void encode_splat(NumberFormat format, const Splat& s, const SubtileRect& group, std::byte* out) {
  if (format == NumberFormat::kHalf) {
    write_halves(s, out);
  } else {
    write_singles(s, out);
  }
  const auto cut = [](int at, int low, int high) {
    return static_cast<std::byte>(std::clamp(at, low, high) - low);
  };
  std::byte* const footprint = out + splat_entry_bytes(format) - kFootprintBytes;
  footprint[0] = cut(s.footprint.x0, group.x0, group.x1);
  footprint[1] = cut(s.footprint.y0, group.y0, group.y1);
  footprint[2] = cut(s.footprint.x1, group.x0, group.x1);
  footprint[3] = cut(s.footprint.y1, group.y0, group.y1);
}

Splat decode_splat(NumberFormat format, const std::byte* bytes, const SubtileRect& group) {
  Splat s = format == NumberFormat::kHalf ? read_halves(bytes) : read_singles(bytes);
  const std::byte* const footprint = bytes + splat_entry_bytes(format) - kFootprintBytes;
  const auto at = [&](int byte, int low) {
    return static_cast<std::uint16_t>(low + std::to_integer<int>(footprint[byte]));
  };
  s.footprint = {at(0, group.x0), at(1, group.y0), at(2, group.x0), at(3, group.y0)};
  return s;
}

Splat rounded_splat(NumberFormat format, const Splat& splat) {
  if (format == NumberFormat::kSingle) return splat;
  std::byte bytes[splat_entry_bytes(NumberFormat::kHalf)];
  write_halves(splat, bytes);
  Splat out = read_halves(bytes);
  out.footprint = splat.footprint;
  return out;
}

}  // namespace sgs
